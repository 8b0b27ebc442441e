// The faces of a cube map around a light, in C++ and GLSL: 0…5 = +X, -X, +Y, -Y, +Z, -Z, oriented as in Vulkan and
// OpenGL. A point's face coordinates are (sc, tc, depth): right and down in the face's image, and the distance along
// its axis. Texel (i, j) has its centre at s = (i + 0.5) / resolution * 2 - 1, and t likewise from j.
#ifndef UMBRAGE_VIEWS_CUBE_FACE_SHARED_H
#define UMBRAGE_VIEWS_CUBE_FACE_SHARED_H

#include "core/rounding.shared.h"

UMB_NAMESPACE_BEGIN

UMB_CONST uint CubeFaceCount = 6u;

/// The face that a direction from the light falls on. Ties go to x before y before z, and a zero counts as positive.
UMB_FN uint face_of_direction(vec3 direction) {
  float x = abs(direction.x);
  float y = abs(direction.y);
  float z = abs(direction.z);
  uint axis = y >= z ? 1u : 2u;
  float along = y >= z ? direction.y : direction.z;
  if (x >= y && x >= z) axis = 0u;
  if (x >= y && x >= z) along = direction.x;
  return 2u * axis + (along < 0.0f ? 1u : 0u);
}

/// (sc, tc, axis depth) of a point relative to the light. No divide: s = sc / depth, t = tc / depth where depth > 0.
UMB_FN vec3 face_coordinates(uint face, vec3 relative) {
  float side = (face & 1u) != 0u ? -1.0f : 1.0f;
  bool is_x = face < 2u;
  bool is_y = (face >> 1u) == 1u;
  return vec3(is_x ? -side * relative.z : is_y ? relative.x : side * relative.x, is_y ? side * relative.z : -relative.y,
              side * (is_x ? relative.x : is_y ? relative.y : relative.z));
}

/// The direction of (s, t) on a face; its component along the face's axis is +1 or -1. Inverse of face_coordinates.
UMB_FN vec3 face_direction(uint face, float s, float t) {
  float side = (face & 1u) != 0u ? -1.0f : 1.0f;
  bool is_x = face < 2u;
  bool is_y = (face >> 1u) == 1u;
  return vec3(is_x ? side : is_y ? s : side * s, is_y ? side : -t, is_x ? -side * s : is_y ? side * t : side);
}

/// face_coordinates as a matrix: view_from_world of a light at the origin. Like every frame here it mirrors
/// (determinant -1), because cube maps are left-handed images.
UMB_FN mat3 face_rotation(uint face) {
  return mat3(face_coordinates(face, vec3(1.0f, 0.0f, 0.0f)), face_coordinates(face, vec3(0.0f, 1.0f, 0.0f)),
              face_coordinates(face, vec3(0.0f, 0.0f, 1.0f)));
}

/// A place on the cube map.
struct CubeTap {
  uint face;
  float s;
  float t;
};
UMB_ASSERT_SIZE(CubeTap, 12);

/// Where a tap at (s, t) of a face's plane lies on the cube map: itself while |s|, |t| <= 1, else on the neighbour that
/// its direction meets. The direction of the result is face_direction(tap.face, tap.s, tap.t).
UMB_FN CubeTap cube_tap(uint face, float s, float t) {
  CubeTap tap;
  tap.face = face;
  tap.s = s;
  tap.t = t;
  if (max(abs(s), abs(t)) > 1.0f) {
    vec3 direction = face_direction(face, s, t);
    tap.face = face_of_direction(direction);
    vec3 coordinates = face_coordinates(tap.face, direction);
    tap.s = coordinates.x / coordinates.z;
    tap.t = coordinates.y / coordinates.z;
  }
  return tap;
}

/// The texel that holds s (or t), clamped to the view; a NaN gives texel 0.
UMB_FN uint texel_of(float s, uint resolution) {
  float position = (s * 0.5f + 0.5f) * float(resolution);
  return position > 0.0f ? floor_to_uint(position, resolution - 1u) : 0u;
}

/// s (or t) of a texel's centre.
UMB_FN float texel_centre(uint texel, uint resolution) {
  return (float(texel) + 0.5f) / float(resolution) * 2.0f - 1.0f;
}

UMB_NAMESPACE_END
#endif
