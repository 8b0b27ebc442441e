// The geometry of shadow views besides cube faces, the same in C++ and GLSL: spot and ortho frames, depth keys, bias
// pieces, solid angles. A view's coordinates of a point are (sc, tc, depth): right, down and forward from the light.
#ifndef UMBRAGE_VIEWS_VIEW_MATH_SHARED_H
#define UMBRAGE_VIEWS_VIEW_MATH_SHARED_H

#include "core/shared_math.h"
#include "views/cube_face.shared.h"

UMB_NAMESPACE_BEGIN

UMB_CONST float Pi = 3.14159265358979f;
/// A spot whose outer half-angle is at most this (65 degrees) is one perspective view, a wider one is a cube.
UMB_CONST float OneViewMaxOuterRad = 1.13446401f;

// --- Texels and solid angles ----------------------------------------------------------------------------------------

/// World size of a texel of a perspective view at an axis depth; tangent = 1 on cube faces.
UMB_FN float texel_size_m(float depth_m, float tangent, uint resolution) {
  return 2.0f * tangent * depth_m / float(resolution);
}

/// Solid angle of the texel around (s, t) of a cube face (midpoint rule: within 0.4 % of the exact one at 16 texels a
/// side, and four times nearer with each doubling).
UMB_FN float texel_solid_angle(float s, float t, uint resolution) {
  float side = 2.0f / float(resolution);
  float squared_length = 1.0f + s * s + t * t;
  return side * side / (squared_length * sqrt(squared_length));
}

/// Solid angle of a sphere seen from a distance to its centre; the full sphere from within.
UMB_FN float sphere_solid_angle(float radius, float distance_m) {
  if (distance_m <= radius) return 4.0f * Pi;
  float ratio = radius / distance_m;
  float sine_squared = ratio * ratio;
  return 2.0f * Pi * sine_squared / (1.0f + sqrt(1.0f - sine_squared));
}

// --- Spot and ortho frames ------------------------------------------------------------------------------------------

/// Unit vector of any finite direction, however long or short; (0, 0, -1) for none.
UMB_FN vec3 unit_direction(vec3 direction) {
  float largest = max(abs(direction.x), max(abs(direction.y), abs(direction.z)));
  if (!(largest > 0.0f)) return vec3(0.0f, 0.0f, -1.0f);
  return normalize(direction / largest);
}

/// view_from_world rotation of a view along a direction; its rows are right, down, forward. Right is horizontal (+y is
/// up), hence continuous everywhere but at the poles; there it is x. Agrees with face_rotation along every axis.
UMB_FN mat3 view_rotation(vec3 direction) {
  vec3 forward = unit_direction(direction);
  vec3 right = vec3(1.0f, 0.0f, 0.0f);
  if (abs(forward.x) + abs(forward.z) > 1e-5f) right = normalize(vec3(forward.z, 0.0f, -forward.x));
  vec3 down = normalize(cross(right, forward));
  return transpose(mat3(cross(forward, down), down, forward));
}

UMB_FN bool spot_is_one_view(float outer_cone_rad) { return outer_cone_rad <= OneViewMaxOuterRad; }

/// Tangent of a spot view's half-angle: the cone plus `guard` texels on every side, so that filter taps of a receiver
/// on the cone's rim stay inside. resolution > 2 * guard.
UMB_FN float spot_tangent(float outer_cone_rad, uint resolution, uint guard) {
  return tan(outer_cone_rad) * float(resolution) / float(resolution - 2u * guard);
}

/// An ortho view in the coordinates of view_rotation: texel (i, j) starts at origin + (i, j) * texel_m. The depth range
/// holds the fitted box; depths themselves are absolute (measured from the world's origin).
struct OrthoFit {
  vec2 origin;
  float texel_m;
  float depth_min;
  float depth_max;
};
UMB_ASSERT_SIZE(OrthoFit, 20);

/// Fits a view to a world box with at least `guard` texels around it; resolution > 2 * guard + 1. The origin lies on
/// whole texels and the texel's size is rounded up to four mantissa bits (at most 1/16 larger), so that a box that
/// changes a little moves nothing by a fraction of a texel.
UMB_FN OrthoFit ortho_fit(mat3 rotation, vec3 box_min, vec3 box_max, uint resolution, uint guard) {
  vec3 centre = rotation * ((box_min + box_max) * 0.5f);
  vec3 half_size = (box_max - box_min) * 0.5f;
  vec3 extent = abs(rotation[0]) * half_size.x + abs(rotation[1]) * half_size.y + abs(rotation[2]) * half_size.z;
  // What float rounds away far from the origin must not leave the box.
  float magnitude = max(max(abs(centre.x), abs(centre.y)), abs(centre.z)) + max(max(extent.x, extent.y), extent.z);
  extent = extent + vec3(max(magnitude * 1e-6f, 1e-6f));
  float texel = 2.0f * max(extent.x, extent.y) / float(resolution - 1u - 2u * guard);
  OrthoFit fit;
  fit.texel_m = uintBitsToFloat((floatBitsToUint(texel) + 0x7ffffu) & 0xfff80000u);
  fit.origin = vec2((floor((centre.x - extent.x) / fit.texel_m) - float(guard)) * fit.texel_m,
                    (floor((centre.y - extent.y) / fit.texel_m) - float(guard)) * fit.texel_m);
  fit.depth_min = centre.z - extent.z;
  fit.depth_max = centre.z + extent.z;
  return fit;
}

/// Clip position in a perspective view of coordinates (sc, tc, depth): z / w is near / depth, the reversed infinite
/// depth that depth_key_perspective keeps. Depth clamp draws what is nearer than near_m.
UMB_FN vec4 clip_perspective(vec3 coordinates, float tangent, float near_m) {
  return vec4(coordinates.x / tangent, coordinates.y / tangent, near_m, coordinates.z);
}

/// Clip position in an ortho view; z is 1 at depth_min and 0 at depth_max.
UMB_FN vec4 clip_ortho(vec3 coordinates, OrthoFit fit, uint resolution) {
  float scale = 2.0f / (fit.texel_m * float(resolution));
  return vec4((coordinates.x - fit.origin.x) * scale - 1.0f, (coordinates.y - fit.origin.y) * scale - 1.0f,
              (fit.depth_max - coordinates.z) / (fit.depth_max - fit.depth_min), 1.0f);
}

// --- Depth keys: larger is nearer, 0 is clear -----------------------------------------------------------------------

/// The bits of near / depth; what lies nearer than near_m counts as at near_m. depth_m > 0.
UMB_FN uint depth_key_perspective(float near_m, float depth_m) { return floatBitsToUint(min(near_m / depth_m, 1.0f)); }

/// Axis depth of a key that is not clear.
UMB_FN float depth_of_key_perspective(float near_m, uint key) { return near_m / uintBitsToFloat(key); }

/// Largest step between neighbouring perspective keys at a depth (24 significant bits), whatever the near plane.
UMB_FN float depth_quantum_perspective(float depth_m) { return depth_m * 1.1920929e-7f; }

/// Axis depth at which a direction (axis component 1: face_direction, or (s, t, 1) of a spot in its own frame) meets
/// the receiver's tangent plane: n.p / n.d. Where it meets the plane beyond four times the receiver's depth or not at
/// all (past the plane's horizon) there is nothing to compare with, and its own depth along the direction is taken.
UMB_FN float receiver_plane_depth(vec3 normal, vec3 relative, vec3 direction) {
  float own_depth = dot(relative, direction) / dot(direction, direction);
  float plane_distance = dot(normal, relative);
  float slope = dot(normal, direction);
  bool meets = abs(plane_distance) <= 4.0f * own_depth * abs(slope) && plane_distance * slope > 0.0f;
  return meets ? plane_distance / slope : own_depth;
}

UMB_NAMESPACE_END
#endif
