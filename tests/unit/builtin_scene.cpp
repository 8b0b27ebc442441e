// Scenes by name, kept; hashes, and rays against triangles.
#include "builtin_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <string>

using app::Scene;
using glm::vec3;

namespace {

/// Built-in nodes have no parents and no matrices (Nodes checks it).
glm::mat4 world_from_node(const app::Node& node) {
  return glm::scale(glm::translate(glm::mat4(1), node.translation) * glm::mat4_cast(node.rotation), node.scale);
}

class Hash {
 public:
  template <class T>
  void add(const std::vector<T>& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (size_t i = 0; i < values.size() * sizeof(T); ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3u;
  }
  void add(vec3 v) { add(std::vector<float>{v.x, v.y, v.z}); }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace

const Scene& builtin(std::string_view name) {
  static std::map<std::string, Scene, std::less<>> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  auto result = app::builtin_scene(name);
  EXPECT_TRUE(result.ok());
  return made.emplace(name, std::move(*result)).first->second;
}

size_t mesh_triangles(const app::Mesh& mesh) {
  size_t count = 0;
  for (const app::Primitive& primitive : mesh.primitives) count += primitive.indices.size() / 3;
  return count;
}

size_t drawn_triangles(const Scene& s) {
  size_t count = 0;
  for (const app::Node& node : s.nodes) {
    if (node.mesh >= 0) count += mesh_triangles(s.meshes[static_cast<size_t>(node.mesh)]);
  }
  return count;
}

std::vector<PlacedLight> placed_lights(const Scene& s) {
  std::vector<PlacedLight> lights;
  for (const app::Node& node : s.nodes) {
    if (node.light >= 0) lights.push_back({node.translation, &s.lights[static_cast<size_t>(node.light)]});
  }
  return lights;
}

uint64_t hash_of(const Scene& s) {
  Hash hash;
  for (const app::Image& image : s.images) hash.add(image.rgba);
  for (const app::Mesh& mesh : s.meshes) {
    for (const app::Primitive& p : mesh.primitives) {
      hash.add(p.positions);
      hash.add(p.normals);
      hash.add(p.uv[0]);
      hash.add(p.indices);
      hash.add(std::vector<uint32_t>{p.material});
    }
  }
  for (const app::Light& light : s.lights) {
    hash.add(light.color);
    hash.add(std::vector<float>{light.intensity, light.range, light.inner_cone, light.outer_cone});
    hash.add(std::vector<app::LightKind>{light.kind});
  }
  for (const app::Node& node : s.nodes) {
    hash.add(node.translation);
    hash.add(std::vector<float>{node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w, node.scale.x});
    hash.add(std::vector<int>{node.mesh, node.light, node.camera});
  }
  return hash.value();
}

float hit_distance(vec3 origin, vec3 direction, const Triangle& t) {
  const vec3 ab = t[1] - t[0], ac = t[2] - t[0], p = glm::cross(direction, ac);
  const float determinant = glm::dot(ab, p);
  constexpr float miss = std::numeric_limits<float>::infinity();
  if (std::abs(determinant) < 1e-12f) return miss;
  const vec3 from = origin - t[0], q = glm::cross(from, ab);
  const float u = glm::dot(from, p) / determinant, v = glm::dot(direction, q) / determinant;
  const float distance = glm::dot(ac, q) / determinant;
  return u < 0 || v < 0 || u + v > 1 || distance < 0 ? miss : distance;
}

std::vector<Triangle> triangles_near(const Scene& s, vec3 point, float reach) {
  std::vector<Triangle> near;
  for (const app::Node& node : s.nodes) {
    if (node.mesh < 0) continue;
    const glm::mat4 world = world_from_node(node);
    const vec3 local = vec3(glm::inverse(world) * glm::vec4(point, 1));
    const float local_reach = reach / node.scale.x;
    for (const app::Primitive& p : s.meshes[static_cast<size_t>(node.mesh)].primitives) {
      for (size_t i = 0; i < p.indices.size(); i += 3) {
        const Triangle t{p.positions[p.indices[i]], p.positions[p.indices[i + 1]], p.positions[p.indices[i + 2]]};
        const vec3 low = glm::min(t[0], glm::min(t[1], t[2])), high = glm::max(t[0], glm::max(t[1], t[2]));
        if (glm::any(glm::lessThan(high, local - local_reach)) || glm::any(glm::greaterThan(low, local + local_reach)))
          continue;
        Triangle moved;
        for (size_t k = 0; k < 3; ++k) moved[k] = vec3(world * glm::vec4(t[k], 1));
        near.push_back(moved);
      }
    }
  }
  return near;
}
