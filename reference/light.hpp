// A light as the references see it: world space, every default filled in, and when a pixel must have been evaluated
// for it.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "import/scene.hpp"

namespace reference {

struct Light {
  app::LightKind kind = app::LightKind::point;
  glm::vec3 position{0};          ///< Unused by directional lights.
  glm::vec3 direction{0, 0, -1};  ///< Where it shines, unit length. Unused by point lights.
  glm::vec3 color{1};
  float intensity = 1;       ///< Candela; lux for directional lights.
  float range = 10;          ///< Metres, finite. Unused by directional lights.
  float near = 10.0f / 256;  ///< Axis depth of the near plane of its views, metres. Unused by directional lights.
  float inner_cone = 0, outer_cone = 0.7853982f;  ///< Half-angles, radians, of spots.
  uint32_t faces = 0x3f;                          ///< Bits +x, -x, +y, -y, +z, -z: what a point light shines through.
};

/// The near plane of a light that names none of its own.
inline float default_near(float range) { return range / 256; }

/// Spots with a wider half-angle than this are drawn as cubes: one perspective view would waste its texels.
constexpr float widest_single_view_rad = 1.1344640f;  // 65°

inline bool drawn_as_cube(const Light& light) {
  return light.kind == app::LightKind::point ||
         (light.kind == app::LightKind::spot && light.outer_cone > widest_single_view_rad);
}

enum class Evaluation : uint8_t {
  required,   ///< In range, in the cone and facing the light, all with margin.
  forbidden,  ///< Out of range, out of the cone, beyond a face that is not shone through or facing away, with margin.
  open,       ///< Too close to a border to say, or left to the shading normal.
};

/// Margins within which either answer of the renderer is right.
struct EvaluationMargins {
  /// Required only where N·L is at least this: the shading normal, unknown here, may turn a pixel away from a light
  /// that its geometric normal faces. 0.9 leaves it 64° of freedom; scenes without normal maps and smooth normals can
  /// take 0.01.
  float facing = 0.9f;
  float away = 1e-3f;       ///< Forbidden where N·L is at most minus this.
  float distance = 1e-3f;   ///< Relative, about the range.
  float angle_rad = 1e-3f;  ///< About the outer cone.
};

/// Precondition: position is finite, normal (geometric, towards the viewer) has unit length.
Evaluation expected_evaluation(const Light&, glm::vec3 position, glm::vec3 normal, const EvaluationMargins& = {});

/// Unit vector from position to the light.
glm::vec3 towards(const Light&, glm::vec3 position);

/// Irradiance of a surface without shadow, linear RGB: KHR_lights_punctual's falloff
/// max(min(1 − (d/range)⁴, 1), 0) / d² and its smoothing between the cones, times max(N·L, 0).
glm::vec3 irradiance(const Light&, glm::vec3 position, glm::vec3 normal);

}  // namespace reference
