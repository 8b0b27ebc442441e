#include "ray_answers.hpp"

#include <algorithm>
#include <cmath>

namespace umbrage::test {

std::vector<Triangle> triangles_of(const TestScene& scene) {
  std::vector<Triangle> out;
  for (const TestInstance& instance : scene.instances) {
    const TestMesh& mesh = scene.meshes[instance.mesh];
    const auto at = [&](size_t i) {
      return glm::dvec3(transform(instance.world_from_mesh, mesh.positions[mesh.indices[i]]));
    };
    for (size_t i = 0; i < mesh.indices.size(); i += 3) out.push_back({at(i), at(i + 1), at(i + 2)});
  }
  return out;
}

namespace {
/// Distance along a unit ray to the nearest triangle; infinity: none.
double cast(const std::vector<Triangle>& triangles, const glm::dvec3& origin, const glm::dvec3& ray) {
  double nearest = INFINITY;
  for (const Triangle& triangle : triangles) {
    const glm::dvec3 u = triangle.b - triangle.a, v = triangle.c - triangle.a, normal = glm::cross(ray, v),
                     offset = origin - triangle.a;
    const double determinant = glm::dot(u, normal);
    if (determinant == 0) continue;
    const double s = glm::dot(offset, normal) / determinant;
    if (s < 0 || s > 1) continue;
    const glm::dvec3 across = glm::cross(offset, u);
    const double t = glm::dot(ray, across) / determinant, distance = glm::dot(v, across) / determinant;
    if (t >= 0 && s + t <= 1 && distance > 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}
}  // namespace

Answer answer_of(const std::vector<Triangle>& triangles, const LightDesc& light, const glm::dvec3& p, double texel_m) {
  const bool sun = light.type == LightType::directional;
  const glm::dvec3 origin =
      sun ? p - 60.0 * glm::normalize(glm::dvec3(to_glm(light.direction))) : glm::dvec3(to_glm(light.position));
  const double distance = glm::distance(p, origin);
  const glm::dvec3 forward = (p - origin) / distance;
  const glm::dvec3 u = glm::normalize(
                       glm::cross(forward, std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0))),
                   v = glm::cross(forward, u);
  bool lit = true, dark = true;
  for (int y = -3; y <= 3; ++y) {
    for (int x = -3; x <= 3; ++x) {
      const glm::dvec3 shift = (u * double(x) + v * double(y)) * texel_m;
      const glm::dvec3 ray = sun ? forward : glm::normalize(p + shift - origin);
      const double hit = cast(triangles, sun ? origin + shift : origin, ray);
      lit = lit && hit > distance + 3 * texel_m;
      dark = dark && hit < distance - 3 * texel_m;
      if (!lit && !dark) return Answer::open;
    }
  }
  return lit ? Answer::lit : Answer::dark;
}

}  // namespace umbrage::test
