// Plain values that cross the API: vectors, matrices, ids. No dependency, no behaviour.
#pragma once
#include <cstdint>

namespace umbrage {

struct Vec2 { float x = 0, y = 0; };
struct Vec3 { float x = 0, y = 0, z = 0; };

/// Column-major, as GLSL and glm store it: element (row r, column c) is m[4 * c + r].
struct Mat4 { float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; };

/// Three rows of four, row-major as VkTransformMatrixKHR: p' = (m[0..2]·p + m[3], m[4..6]·p + m[7], m[8..10]·p + m[11]).
struct Affine { float m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}; };

/// Axis-aligned box; empty when any min > max.
struct Aabb { Vec3 min, max; };

// Ids are handed out by a ShadowSystem and never reused within its life; 0 names nothing.
struct MeshId { uint32_t value = 0; };
struct InstanceId { uint32_t value = 0; };
struct LightId { uint32_t value = 0; };
struct MaskId { uint32_t value = 0; };
/// Chosen by the host, so that what is kept between frames finds its camera again.
struct CameraId { uint32_t value = 0; };

}  // namespace umbrage
