#include "reference/light.hpp"

#include <algorithm>
#include <cmath>

namespace reference {
namespace {

float cone_angle(const Light& light, glm::vec3 to_light) {
  return std::acos(std::clamp(glm::dot(-to_light, light.direction), -1.0f, 1.0f));
}

/// Faces of the cube around a light in which `way` may lie, all that are as long along their axis but for a share `margin`.
uint32_t faces_near(const glm::vec3& way, float margin) {
  const glm::vec3 size = glm::abs(way);
  const float longest = std::max({size.x, size.y, size.z});
  uint32_t faces = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] >= longest * (1 - margin)) faces |= 1u << (2 * axis + (way[axis] < 0 ? 1 : 0));
  return faces;
}

float attenuation(const Light& light, glm::vec3 position, glm::vec3 to_light) {
  const float distance = std::max(glm::distance(light.position, position), 1e-6f);
  const float ratio = distance / light.range;
  float result = std::clamp(1 - ratio * ratio * ratio * ratio, 0.0f, 1.0f) / (distance * distance);
  if (light.kind == app::LightKind::spot) {
    const float outer = std::cos(light.outer_cone);
    const float scale = 1 / std::max(0.001f, std::cos(light.inner_cone) - outer);
    const float smooth = std::clamp((glm::dot(-to_light, light.direction) - outer) * scale, 0.0f, 1.0f);
    result *= smooth * smooth;
  }
  return result;
}

}  // namespace

glm::vec3 towards(const Light& light, glm::vec3 position) {
  if (light.kind == app::LightKind::directional) return -light.direction;
  const glm::vec3 offset = light.position - position;
  const float length = glm::length(offset);
  return length > 0 ? offset / length : glm::vec3(0, 0, 1);
}

Evaluation expected_evaluation(const Light& light, glm::vec3 position, glm::vec3 normal,
                               const EvaluationMargins& margins) {
  bool inside = true;
  if (light.kind != app::LightKind::directional) {
    const float ratio = glm::distance(light.position, position) / light.range;
    if (ratio >= 1 + margins.distance) return Evaluation::forbidden;
    inside = ratio <= 1 - margins.distance;
  }
  const glm::vec3 to_light = towards(light, position);
  const float cosine = glm::dot(normal, to_light);
  if (cosine <= -margins.away) return Evaluation::forbidden;
  inside = inside && cosine >= margins.facing;
  if (light.kind == app::LightKind::spot) {
    const float angle = cone_angle(light, to_light);
    if (angle >= light.outer_cone + margins.angle_rad) return Evaluation::forbidden;
    inside = inside && angle <= light.outer_cone - margins.angle_rad;
  }
  if (light.kind == app::LightKind::point) {
    const uint32_t faces = faces_near(position - light.position, 4 * margins.angle_rad);
    if ((faces & light.faces) == 0) return Evaluation::forbidden;
    inside = inside && (faces & ~light.faces) == 0;
  }
  return inside ? Evaluation::required : Evaluation::open;
}

glm::vec3 irradiance(const Light& light, glm::vec3 position, glm::vec3 normal) {
  const glm::vec3 to_light = towards(light, position);
  const float cosine = std::max(glm::dot(normal, to_light), 0.0f);
  const float falloff = light.kind == app::LightKind::directional ? 1.0f : attenuation(light, position, to_light);
  return light.color * (light.intensity * falloff * cosine);
}

}  // namespace reference
