// The posed scene's triangles in the world, walked without keeping them.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "import/scene.hpp"

namespace app {

/// Axis-aligned, world space.
struct Box {
  glm::vec3 min{std::numeric_limits<float>::infinity()}, max{-std::numeric_limits<float>::infinity()};

  bool is_empty() const { return !(min.x <= max.x); }
  glm::vec3 center() const { return is_empty() ? glm::vec3(0) : 0.5f * (min + max); }
  /// 0 when empty.
  float diagonal() const { return is_empty() ? 0.0f : glm::length(max - min); }
  void extend(const glm::vec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
  }
};

/// One primitive of one posed instance; spans are valid during the visit.
struct PosedPrimitive {
  const Primitive* primitive = nullptr;
  std::span<const glm::vec3> positions;  ///< World space.
};

/// In the pose's order, the same every time.
void for_each_primitive(const Scene& scene, const Pose& pose, const std::function<void(const PosedPrimitive&)>& visit);

/// Of all triangles.
Box scene_bounds(const Scene& scene, const Pose& pose);

}  // namespace app
