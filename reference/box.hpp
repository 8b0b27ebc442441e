// An axis-aligned box in world space.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

namespace reference {

/// Empty, and neutral to grow(), as constructed.
struct Box {
  glm::vec3 min{std::numeric_limits<float>::infinity()};
  glm::vec3 max{-std::numeric_limits<float>::infinity()};

  void grow(glm::vec3 point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
  }
  void grow(const Box& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
  bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
  bool holds(glm::vec3 point) const {
    return glm::all(glm::lessThanEqual(min, point)) && glm::all(glm::lessThanEqual(point, max));
  }
  bool holds(const Box& other) const { return holds(other.min) && holds(other.max); }
  glm::vec3 center() const { return 0.5f * (min + max); }
};

/// Squared distance from a point to the nearest point of a box; 0 inside.
inline float squared_distance(const Box& box, glm::vec3 point) {
  const glm::vec3 offset = glm::max(glm::max(box.min - point, point - box.max), glm::vec3(0));
  return glm::dot(offset, offset);
}

}  // namespace reference
