// A sphere of quadrilaterals by latitude and longitude.
#include "host/mirror_ball.hpp"

#include <cmath>

#include <glm/gtc/constants.hpp>

namespace app {

Primitive ball_primitive(const glm::vec3& center, float radius) {
  constexpr uint32_t kAround = 96, kAcross = 48;
  Primitive ball;
  for (uint32_t j = 0; j <= kAcross; ++j)
    for (uint32_t i = 0; i <= kAround; ++i) {
      const float u = glm::two_pi<float>() * static_cast<float>(i) / kAround,
                  v = glm::pi<float>() * static_cast<float>(j) / kAcross;
      const glm::vec3 normal(std::sin(v) * std::cos(u), std::cos(v), std::sin(v) * std::sin(u));
      ball.positions.push_back(center + radius * normal);
      ball.normals.push_back(normal);
      if (i == kAround || j == kAcross) continue;
      const uint32_t a = j * (kAround + 1) + i, b = a + 1, c = a + kAround + 1, d = c + 1;
      ball.indices.insert(ball.indices.end(), {a, b, c, b, d, c});
    }
  return ball;
}

MirrorBall add_mirror_ball(Scene& scene, const glm::vec3& center, float radius) {
  Material silver;
  silver.name = "mirror ball";
  silver.base_color = {0.95f, 0.95f, 0.95f, 1};
  silver.metallic = 1;
  silver.roughness = 0;
  scene.materials.push_back(silver);
  Mesh mesh;
  mesh.name = silver.name;
  mesh.primitives.push_back(ball_primitive(glm::vec3(0), radius));
  mesh.primitives[0].material = static_cast<uint32_t>(scene.materials.size() - 1);
  scene.meshes.push_back(std::move(mesh));
  Node node;
  node.name = silver.name;
  node.translation = center;
  node.mesh = static_cast<int>(scene.meshes.size() - 1);
  scene.nodes.push_back(std::move(node));
  return {center, radius, static_cast<uint32_t>(scene.meshes.size() - 1)};
}

}  // namespace app
