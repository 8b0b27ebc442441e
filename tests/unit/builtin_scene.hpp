// What tests of built-in scenes ask of them.
#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "scenes/builtin.hpp"

/// Made once; fails the test where there is none of that name.
const app::Scene& builtin(std::string_view name);

size_t mesh_triangles(const app::Mesh& mesh);
size_t drawn_triangles(const app::Scene& scene);
/// Over everything that a renderer reads (FNV-1a).
uint64_t hash_of(const app::Scene& scene);

struct PlacedLight {
  glm::vec3 position;
  const app::Light* light;
};
/// In the order of their nodes.
std::vector<PlacedLight> placed_lights(const app::Scene& scene);

using Triangle = std::array<glm::vec3, 3>;
/// Distance to the triangle along a ray, infinite when it misses (Möller and Trumbore).
float hit_distance(glm::vec3 origin, glm::vec3 direction, const Triangle& triangle);
/// World-space triangles that come within `reach` of a point.
std::vector<Triangle> triangles_near(const app::Scene& scene, glm::vec3 point, float reach);
