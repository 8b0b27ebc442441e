// Which lights a frame has.
#include "commands/active_lights.hpp"

#include <algorithm>
#include <cmath>

namespace app {
namespace {

float farthest_corner(const glm::vec3& from, const Box& bounds) {
  return bounds.is_empty() ? 0.0f : glm::length(glm::max(glm::abs(bounds.min - from), glm::abs(bounds.max - from)));
}

float finite_range(const PosedLight& light, double irradiance_threshold, const Box& bounds) {
  if (std::isfinite(light.range) && light.range > 0) return light.range;
  const double brightest = double(light.intensity) * double(std::max({light.color.r, light.color.g, light.color.b}));
  const double reach = std::sqrt(std::max(brightest, 0.0) / irradiance_threshold);
  const double largest = 2.0 * std::max(double(farthest_corner(light.position, bounds)), 1e-3);
  return static_cast<float>(std::clamp(reach, 1e-4 * largest, largest));
}

}  // namespace

ActiveLight activate(const PosedLight& light, double irradiance_threshold, const Box& bounds) {
  return {.name = light.name,
          .kind = light.kind,
          .position = light.position,
          .direction = light.direction,
          .color = light.color,
          .intensity = light.intensity,
          .range = finite_range(light, irradiance_threshold, bounds),
          .inner_cone = light.inner_cone,
          .outer_cone = light.outer_cone,
          .faces = light.faces};
}

std::vector<ActiveLight> active_lights(std::span<const PosedLight> scene_lights, std::span<const PosedLight> added,
                                       double irradiance_threshold, const Box& bounds) {
  std::vector<ActiveLight> lights;
  lights.reserve(scene_lights.size() + added.size());
  for (const auto& list : {scene_lights, added})
    for (const PosedLight& light : list) lights.push_back(activate(light, irradiance_threshold, bounds));
  return lights;
}

}  // namespace app
