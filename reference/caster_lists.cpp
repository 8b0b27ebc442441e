#include "reference/caster_lists.hpp"

#include <algorithm>

#include "reference/light_lists.hpp"

namespace reference {
namespace {

/// Smallest |x| of an interval.
float nearest_to_zero(float low, float high) { return std::max({low, -high, 0.0f}); }

}  // namespace

uint32_t cube_face_mask(glm::vec3 center, float near, const Box& box) {
  const glm::vec3 low = box.min - center, high = box.max - center;
  uint32_t mask = 0;
  for (uint32_t face = 0; face < cube_faces; ++face) {
    const int axis = int(face / 2), u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float farthest = face % 2 == 0 ? high[axis] : -low[axis];
    const float across = std::max(nearest_to_zero(low[u], high[u]), nearest_to_zero(low[v], high[v]));
    if (farthest >= near && farthest >= across) mask |= 1u << face;
  }
  return mask;
}

bool planes_may_meet(std::span<const glm::vec4> planes, const Box& box) {
  return std::all_of(planes.begin(), planes.end(), [&](glm::vec4 plane) {
    const glm::vec3 normal(plane);
    const glm::vec3 farthest = glm::mix(box.min, box.max, glm::greaterThanEqual(normal, glm::vec3(0)));
    return glm::dot(normal, farthest) + plane.w >= 0;
  });
}

std::vector<Caster> list_casters(const Light& light, std::span<const glm::vec4> view_planes,
                                 std::span<const Box> batches) {
  std::vector<Caster> casters;
  for (uint32_t i = 0; i < batches.size(); ++i) {
    if (!range_meets(light, batches[i])) continue;
    const uint32_t views = drawn_as_cube(light) ? cube_face_mask(light.position, light.near, batches[i])
                                                : uint32_t(planes_may_meet(view_planes, batches[i]));
    if (views != 0) casters.push_back({i, views});
  }
  return casters;
}

}  // namespace reference
