#include "reference/light_lists.hpp"

#include <algorithm>
#include <cmath>

namespace reference {
namespace {

bool reaches(const Light& light, glm::vec3 position) {
  if (light.kind == app::LightKind::directional) return true;
  const glm::vec3 offset = position - light.position;
  const float distance = glm::length(offset);
  if (distance > light.range) return false;
  return light.kind == app::LightKind::point ||
         glm::dot(offset, light.direction) >= std::cos(light.outer_cone) * distance;
}

}  // namespace

bool range_meets(const Light& light, const Box& box) {
  return light.kind == app::LightKind::directional ||
         squared_distance(box, light.position) <= light.range * light.range;
}

bool cone_may_meet(const Light& light, const Box& box) {
  if (light.kind != app::LightKind::spot) return true;
  const glm::vec3 offset = box.center() - light.position;
  const float radius = 0.5f * glm::distance(box.min, box.max);
  const float along = glm::dot(offset, light.direction);
  const float aside = std::sqrt(std::max(glm::dot(offset, offset) - along * along, 0.0f));
  // Signed distance of the sphere's centre to the cone's side, outwards; at apex and base the range test decides.
  const float outside = std::cos(light.outer_cone) * aside - std::sin(light.outer_cone) * along;
  return outside <= radius && along >= -radius && along <= light.range + radius;
}

std::vector<std::vector<uint32_t>> assign_lights(std::span<const Box> boxes, std::span<const Light> lights) {
  std::vector<std::vector<uint32_t>> lists(boxes.size());
  for (size_t b = 0; b < boxes.size(); ++b) {
    for (uint32_t i = 0; i < lights.size(); ++i) {
      if (range_meets(lights[i], boxes[b]) && cone_may_meet(lights[i], boxes[b])) lists[b].push_back(i);
    }
  }
  return lists;
}

std::vector<uint32_t> lights_reaching(std::span<const glm::vec3> positions, std::span<const Light> lights) {
  std::vector<uint32_t> result;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (std::any_of(positions.begin(), positions.end(), [&](glm::vec3 p) { return reaches(lights[i], p); })) {
      result.push_back(i);
    }
  }
  return result;
}

}  // namespace reference
