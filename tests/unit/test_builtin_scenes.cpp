// The built-in scenes against what all of them promise: sane meshes, lights free to shine, cameras that see fronts, the
// same bytes every time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "builtin_scene.hpp"

namespace {

using app::Scene;
using glm::vec3;

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, IndicesPointAtSomething) {
  const Scene& s = builtin(GetParam());
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
  const Scene& s = builtin(GetParam());
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
  const Scene& s = builtin(GetParam());
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
  EXPECT_EQ(hash_of(*again), hash_of(builtin(GetParam())));
}

TEST_P(EveryScene, LightsShineFreely) {
  const Scene& s = builtin(GetParam());
  std::mt19937 bits(7);
  const auto around = [&] { return static_cast<float>(bits()) * 0x1p-31f - 1; };
  for (const PlacedLight& light : placed_lights(s)) {
    if (light.light->kind == app::LightKind::directional) continue;
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
    EXPECT_GT(nearest, 1.7321f * light.light->range / 256)
        << "something stands in the near cube of the light at " << where;
  }
}

TEST_P(EveryScene, CamerasStandOutsideOfWalls) {
  const Scene& s = builtin(GetParam());
  ASSERT_EQ(s.cameras.size(), 3u);
  EXPECT_EQ(s.cameras[0].name, "overview");
  for (const app::Node& node : s.nodes) {
    if (node.camera < 0) continue;
    const app::Camera& camera = s.cameras[static_cast<size_t>(node.camera)];
    EXPECT_GE(camera.fov_y, glm::radians(45.0f));
    EXPECT_LE(camera.fov_y, glm::radians(60.0f));
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
      const Triangle t{p.positions[p.indices[i]], p.positions[p.indices[i + 1]], p.positions[p.indices[i + 2]]};
      const float distance = hit_distance(origin, direction, t);
      if (distance >= nearest.distance) continue;
      const app::Material& material = s.materials[p.material];
      const bool front = glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), direction) < 0;
      nearest = {distance, front || material.double_sided, mesh.name + ", " + material.name};
    }
  }
}

TEST_P(EveryScene, WhatCamerasSeeFacesThem) {
  const Scene& s = builtin(GetParam());
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

class EveryPair : public testing::TestWithParam<std::string> {};

TEST_P(EveryPair, LowDetailStandsWhereTheFullOneDoes) {
  const Scene &full = builtin(GetParam()), &low = builtin(GetParam() + "-lod");
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

INSTANTIATE_TEST_SUITE_P(Builtin, EveryScene, testing::Values("houses", "houses-lod", "landscape", "landscape-lod"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

INSTANTIATE_TEST_SUITE_P(Builtin, EveryPair, testing::Values("houses", "landscape"));

TEST(BuiltinScenes, ListedAndRefusedByName) {
  for (const app::BuiltinInfo& info : app::builtin_scenes()) {
    EXPECT_FALSE(info.summary.empty());
    EXPECT_EQ(builtin(info.name).name, info.name);
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
