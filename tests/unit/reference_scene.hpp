// Hand-made scenes of quads for the tests of the references.
#pragma once
#include <glm/gtc/matrix_transform.hpp>

#include "import/scene.hpp"

namespace test {

/// A quad centre ± u ± v facing u × v, texture coordinates 0…1 along u and v.
inline app::Primitive quad(glm::vec3 center, glm::vec3 u, glm::vec3 v, uint32_t material = 0) {
  app::Primitive primitive;
  primitive.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
  primitive.normals.assign(4, glm::normalize(glm::cross(u, v)));
  primitive.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = material;
  return primitive;
}

/// A scene with its pose: every mesh it is given becomes one instance.
struct QuadScene {
  app::Scene scene;
  app::Pose pose;

  QuadScene() { scene.materials.resize(1); }

  void add(app::Primitive primitive, const glm::mat4& world_from_mesh = glm::mat4(1)) {
    scene.meshes.push_back({"quad", {std::move(primitive)}, {}});
    add_instance(uint32_t(scene.meshes.size()) - 1, world_from_mesh);
  }
  void add_instance(uint32_t mesh, const glm::mat4& world_from_mesh) {
    app::PosedInstance instance;
    instance.mesh = mesh;
    instance.world_from_mesh = world_from_mesh;
    pose.instances.push_back(instance);
  }
};

}  // namespace test
