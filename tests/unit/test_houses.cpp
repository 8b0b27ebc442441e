// The built-in scenes against what they promise: counts, sane meshes, lights evenly spread and free to shine, the same
// bytes every time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <string_view>

#include "scenes/builtin.hpp"

namespace {

using app::Scene;
using glm::vec3;

const Scene& scene(std::string_view name) {
  static std::map<std::string, Scene, std::less<>> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  auto result = app::builtin_scene(name);
  EXPECT_TRUE(result.ok());
  return made.emplace(name, std::move(*result)).first->second;
}

/// Built-in nodes have no parents and no matrices (Nodes checks it).
glm::mat4 world_from_node(const app::Node& node) {
  return glm::scale(glm::translate(glm::mat4(1), node.translation) * glm::mat4_cast(node.rotation), node.scale);
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

struct PlacedLight {
  vec3 position;
  float range;
};

std::vector<PlacedLight> placed_lights(const Scene& s) {
  std::vector<PlacedLight> lights;
  for (const app::Node& node : s.nodes) {
    if (node.light >= 0) lights.push_back({node.translation, s.lights[static_cast<size_t>(node.light)].range});
  }
  return lights;
}

/// FNV-1a over everything that a renderer reads.
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
    hash.add(std::vector<float>{light.intensity, light.range});
  }
  for (const app::Node& node : s.nodes) {
    hash.add(node.translation);
    hash.add(std::vector<float>{node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w, node.scale.x});
    hash.add(std::vector<int>{node.mesh, node.light, node.camera});
  }
  return hash.value();
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, IndicesPointAtSomething) {
  const Scene& s = scene(GetParam());
  for (const app::Mesh& mesh : s.meshes) {
    ASSERT_FALSE(mesh.primitives.empty()) << mesh.name;
    for (const app::Primitive& p : mesh.primitives) {
      ASSERT_LT(p.material, s.materials.size()) << mesh.name;
      ASSERT_EQ(p.indices.size() % 3, 0u) << mesh.name;
      ASSERT_FALSE(p.indices.empty()) << mesh.name;
      ASSERT_EQ(p.normals.size(), p.positions.size()) << mesh.name;
      ASSERT_EQ(p.uv[0].size(), p.positions.size()) << mesh.name;
      ASSERT_LT(*std::max_element(p.indices.begin(), p.indices.end()), p.positions.size()) << mesh.name;
    }
  }
  for (const app::Material& material : s.materials) {
    ASSERT_FALSE(material.name.empty());
    for (const app::Texture* texture :
         {&material.base_color_texture, &material.normal_texture, &material.emissive_texture}) {
      ASSERT_LT(texture->image, static_cast<int>(s.images.size())) << material.name;
    }
  }
  size_t image_bytes = 0;
  for (const app::Image& image : s.images) {
    ASSERT_EQ(image.rgba.size(), size_t{4} * image.width * image.height) << image.name;
    image_bytes += image.rgba.size();
  }
  EXPECT_LE(image_bytes, size_t{32} << 20);
}

TEST_P(EveryScene, Nodes) {
  const Scene& s = scene(GetParam());
  std::vector<int> lights(s.lights.size());
  for (const app::Node& node : s.nodes) {
    ASSERT_EQ(node.parent, -1);
    ASSERT_FALSE(node.matrix.has_value());
    ASSERT_EQ(node.scale, vec3(node.scale.x));
    ASSERT_GT(node.scale.x, 0);
    ASSERT_NEAR(glm::length(node.rotation), 1, 1e-4f) << node.name;
    ASSERT_FALSE(glm::any(glm::isnan(node.translation))) << node.name;
    ASSERT_LT(node.mesh, static_cast<int>(s.meshes.size()));
    ASSERT_LT(node.camera, static_cast<int>(s.cameras.size()));
    if (node.light >= 0) ++lights.at(static_cast<size_t>(node.light));
  }
  EXPECT_TRUE(std::all_of(lights.begin(), lights.end(), [](int uses) { return uses == 1; }));
}

TEST_P(EveryScene, TrianglesHaveAreaAndFaceTheirNormals) {
  const Scene& s = scene(GetParam());
  for (const app::Mesh& mesh : s.meshes) {
    for (const app::Primitive& p : mesh.primitives) {
      const std::string where = mesh.name + ", " + s.materials[p.material].name;
      for (size_t i = 0; i < p.positions.size(); ++i) {
        ASSERT_TRUE(std::isfinite(p.positions[i].x + p.positions[i].y + p.positions[i].z)) << where;
        ASSERT_TRUE(std::isfinite(p.uv[0][i].x + p.uv[0][i].y)) << where;
        ASSERT_NEAR(glm::length(p.normals[i]), 1, 1e-3f) << where;
      }
      for (size_t i = 0; i < p.indices.size(); i += 3) {
        const uint32_t a = p.indices[i], b = p.indices[i + 1], c = p.indices[i + 2];
        const vec3 cross = glm::cross(p.positions[b] - p.positions[a], p.positions[c] - p.positions[a]);
        ASSERT_GT(glm::length(cross), 1e-8f) << where << ", triangle " << i / 3;
        const vec3 mean = p.normals[a] + p.normals[b] + p.normals[c];
        ASSERT_GT(glm::dot(cross, mean), 0) << where << ", triangle " << i / 3 << " faces against its normals";
      }
    }
  }
}

TEST_P(EveryScene, SameBytesEveryTime) {
  const auto again = app::builtin_scene(GetParam());
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(hash_of(*again), hash_of(scene(GetParam())));
}

TEST_P(EveryScene, LightsAreOfSimilarSizeAndSpread) {
  const Scene& s = scene(GetParam());
  ASSERT_EQ(s.lights.size(), 256u);
  for (const app::Light& light : s.lights) {
    EXPECT_EQ(light.kind, app::LightKind::point);
    EXPECT_GE(light.range, 9) << light.name;
    EXPECT_LE(light.range, 14) << light.name;
    EXPECT_GE(light.intensity / 9, 2) << light.name << ": too dim at 3 m";
  }
  constexpr float half = 100, cell = 40;
  std::array<std::array<int, 5>, 5> count{};
  for (const PlacedLight& light : placed_lights(s)) {
    ASSERT_LT(std::max(std::abs(light.position.x), std::abs(light.position.z)), half);
    const auto index = [&](float x) { return static_cast<size_t>((x + half) / cell); };
    ++count[index(light.position.z)][index(light.position.x)];
  }
  for (const auto& row : count) {
    for (int lights : row) {
      EXPECT_GE(lights, 5);  // 10.2 on average.
      EXPECT_LE(lights, 20);
    }
  }
}

/// Distance to the triangle along a ray, infinite when it misses (Möller and Trumbore).
float hit_distance(vec3 origin, vec3 direction, const std::array<vec3, 3>& t) {
  const vec3 ab = t[1] - t[0], ac = t[2] - t[0], p = glm::cross(direction, ac);
  const float determinant = glm::dot(ab, p);
  constexpr float miss = std::numeric_limits<float>::infinity();
  if (std::abs(determinant) < 1e-12f) return miss;
  const vec3 from = origin - t[0], q = glm::cross(from, ab);
  const float u = glm::dot(from, p) / determinant, v = glm::dot(direction, q) / determinant;
  const float distance = glm::dot(ac, q) / determinant;
  return u < 0 || v < 0 || u + v > 1 || distance < 0 ? miss : distance;
}

/// World-space triangles that come within `reach` of a point.
std::vector<std::array<vec3, 3>> triangles_near(const Scene& s, vec3 point, float reach) {
  std::vector<std::array<vec3, 3>> near;
  for (const app::Node& node : s.nodes) {
    if (node.mesh < 0) continue;
    const glm::mat4 world = world_from_node(node);
    const vec3 local = vec3(glm::inverse(world) * glm::vec4(point, 1));
    const float local_reach = reach / node.scale.x;
    for (const app::Primitive& p : s.meshes[static_cast<size_t>(node.mesh)].primitives) {
      for (size_t i = 0; i < p.indices.size(); i += 3) {
        const std::array<vec3, 3> t{p.positions[p.indices[i]], p.positions[p.indices[i + 1]],
                                    p.positions[p.indices[i + 2]]};
        const vec3 low = glm::min(t[0], glm::min(t[1], t[2])), high = glm::max(t[0], glm::max(t[1], t[2]));
        if (glm::any(glm::lessThan(high, local - local_reach)) || glm::any(glm::greaterThan(low, local + local_reach)))
          continue;
        std::array<vec3, 3> moved;
        for (size_t k = 0; k < 3; ++k) moved[k] = vec3(world * glm::vec4(t[k], 1));
        near.push_back(moved);
      }
    }
  }
  return near;
}

TEST_P(EveryScene, LightsShineFreely) {
  const Scene& s = scene(GetParam());
  std::mt19937 bits(7);
  const auto around = [&] { return static_cast<float>(bits()) * 0x1p-31f - 1; };
  for (const PlacedLight& light : placed_lights(s)) {
    const auto near = triangles_near(s, light.position, 1);
    int free = 0;
    float nearest = 1;
    constexpr int rays = 64;
    for (int i = 0; i < rays; ++i) {
      const vec3 direction = glm::normalize(vec3(around(), around(), around()) + vec3(0, 1e-4f, 0));
      float distance = std::numeric_limits<float>::infinity();
      for (const auto& t : near) distance = std::min(distance, hit_distance(light.position, direction, t));
      free += distance > 1;
      nearest = std::min(nearest, distance);
    }
    const auto where = testing::Message() << light.position.x << ", " << light.position.y << ", " << light.position.z;
    EXPECT_GE(free, rays / 4) << "the light at " << where << " is shut in";
    // A shadow map starts at range / 256 along an axis, so at most √3 times that along a diagonal.
    EXPECT_GT(nearest, 1.7321f * light.range / 256) << "something stands in the near cube of the light at " << where;
  }
}

TEST_P(EveryScene, CamerasLookAtTheTownFromOutsideOfWalls) {
  const Scene& s = scene(GetParam());
  ASSERT_EQ(s.cameras.size(), 3u);
  EXPECT_EQ(s.cameras[0].name, "overview");
  EXPECT_EQ(s.cameras[1].name, "street");
  EXPECT_EQ(s.cameras[2].name, "square");
  for (const app::Node& node : s.nodes) {
    if (node.camera < 0) continue;
    const app::Camera& camera = s.cameras[static_cast<size_t>(node.camera)];
    EXPECT_GE(camera.fov_y, glm::radians(50.0f));
    EXPECT_LE(camera.fov_y, glm::radians(55.0f));
    EXPECT_FLOAT_EQ(camera.near, 0.1f);
    EXPECT_TRUE(std::isinf(camera.far));
    EXPECT_TRUE(triangles_near(s, node.translation, 0.3f).empty()) << camera.name;
  }
}

struct Hit {
  float distance = std::numeric_limits<float>::infinity();
  bool front = true;
  std::string where;
};

/// The nearest of a primitive's triangles along a ray in the mesh's space.
void intersect(const Scene& s, const app::Mesh& mesh, vec3 origin, vec3 direction, Hit& nearest) {
  for (const app::Primitive& p : mesh.primitives) {
    for (size_t i = 0; i < p.indices.size(); i += 3) {
      const std::array<vec3, 3> t{p.positions[p.indices[i]], p.positions[p.indices[i + 1]],
                                  p.positions[p.indices[i + 2]]};
      const float distance = hit_distance(origin, direction, t);
      if (distance >= nearest.distance) continue;
      const app::Material& material = s.materials[p.material];
      const bool front = glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), direction) < 0;
      nearest = {distance, front || material.double_sided, mesh.name + ", " + material.name};
    }
  }
}

TEST_P(EveryScene, WhatCamerasSeeFacesThem) {
  const Scene& s = scene(GetParam());
  std::vector<std::pair<vec3, float>> spheres;  // Around each mesh, in its space.
  for (const app::Mesh& mesh : s.meshes) {
    vec3 low(1e9f), high(-1e9f);
    for (const app::Primitive& p : mesh.primitives) {
      for (vec3 position : p.positions) low = glm::min(low, position), high = glm::max(high, position);
    }
    spheres.emplace_back((low + high) * 0.5f, glm::distance(low, high) * 0.5f);
  }
  for (const app::Node& eye : s.nodes) {
    if (eye.camera < 0) continue;
    constexpr int columns = 32, rows = 18;
    for (int pixel = 0; pixel < columns * rows; ++pixel) {
      const float x = (static_cast<float>(pixel % columns) + 0.5f) / columns * 2 - 1;
      const float y = (static_cast<float>(pixel / columns) + 0.5f) / rows * 2 - 1;
      const vec3 direction = eye.rotation * glm::normalize(vec3(x * 0.88f, y * 0.5f, -1));
      Hit hit;
      for (const app::Node& node : s.nodes) {
        if (node.mesh < 0) continue;
        const auto& [middle, radius] = spheres[static_cast<size_t>(node.mesh)];
        const glm::quat turn_back = glm::conjugate(node.rotation);
        const vec3 origin = turn_back * (eye.translation - node.translation) / node.scale.x,
                   along = turn_back * direction;
        const vec3 to = middle - origin;
        if (glm::length(to - along * std::max(glm::dot(to, along), 0.0f)) > radius) continue;
        Hit nearer{.distance = hit.distance / node.scale.x, .where = {}};
        intersect(s, s.meshes[static_cast<size_t>(node.mesh)], origin, along, nearer);
        if (!nearer.where.empty()) hit = {nearer.distance * node.scale.x, nearer.front, nearer.where};
      }
      ASSERT_TRUE(std::isfinite(hit.distance)) << eye.name << " looks out of the world at " << x << ", " << y;
      EXPECT_TRUE(hit.front) << eye.name << " sees the back of " << hit.where << " at " << x << ", " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryScene, testing::Values("houses", "houses-lod"), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Houses, TriangleCounts) {
  const size_t full = drawn_triangles(scene("houses")), low = drawn_triangles(scene("houses-lod"));
  EXPECT_GE(full, 960'000u);
  EXPECT_LE(full, 1'060'000u);
  EXPECT_GE(low, full / 20);
  EXPECT_LE(low, full / 10);
}

TEST(Houses, LowDetailHasTheSameTown) {
  const Scene &full = scene("houses"), &low = scene("houses-lod");
  ASSERT_EQ(full.nodes.size(), low.nodes.size());
  for (size_t i = 0; i < full.nodes.size(); ++i) {
    const app::Node &a = full.nodes[i], &b = low.nodes[i];
    ASSERT_EQ(a.name, b.name);
    ASSERT_EQ(a.translation, b.translation) << a.name;
    ASSERT_EQ(a.rotation, b.rotation) << a.name;
    ASSERT_EQ(a.mesh, b.mesh) << a.name;
  }
  for (size_t i = 0; i < full.lights.size(); ++i) {
    EXPECT_EQ(full.lights[i].intensity, low.lights[i].intensity);
    EXPECT_EQ(full.lights[i].range, low.lights[i].range);
    EXPECT_EQ(full.lights[i].color, low.lights[i].color);
  }
  for (size_t i = 0; i < full.meshes.size(); ++i) {
    EXPECT_LT(mesh_triangles(low.meshes[i]), mesh_triangles(full.meshes[i])) << full.meshes[i].name;
  }
}

TEST(Houses, ListedAndRefusedByName) {
  for (const app::BuiltinInfo& info : app::builtin_scenes()) {
    EXPECT_FALSE(info.summary.empty());
    EXPECT_EQ(scene(info.name).name, info.name);
  }
  for (const char* name : {"", "house", "HOUSES", "houses "}) {
    const auto result = app::builtin_scene(name);
    ASSERT_FALSE(result.ok()) << name;
    EXPECT_EQ(result.error().code, umbrage::ErrorCode::invalid_argument);
    for (const app::BuiltinInfo& info : app::builtin_scenes()) {
      EXPECT_NE(result.error().message.find(info.name), std::string::npos) << result.error().message;
    }
  }
}

}  // namespace
