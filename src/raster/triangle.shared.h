// Triangles on a map's texels, in C++ and GLSL: 8 sub-pixel bits, the top-left rule, depth from exact edge functions. Nothing
// here depends on what else is drawn, nor on how a triangle is cut into blocks.
#ifndef UMBRAGE_RASTER_TRIANGLE_SHARED_H
#define UMBRAGE_RASTER_TRIANGLE_SHARED_H
#include "core/rounding.shared.h"
#include "maps/map_types.shared.h"

UMB_NAMESPACE_BEGIN

/// Sub-pixel steps of a texel. Texel centres lie on odd multiples of half of it.
UMB_CONST int SubTexels = 256;
/// Vertices lie within so many texels of the map's middle: edge functions of a block of 32 texels fit 32 bits, and sub-texels
/// round_to_int.
UMB_CONST float GuardTexels = 16000.0f;
/// Triangles up to so many texels wide and high have edge functions of 32 bits everywhere.
UMB_CONST int NarrowTexels = 64;

/// A vertex in clip space with its texture coordinates.
struct ClipVertex {
  vec4 position;
  vec2 uv;
};
UMB_ASSERT_SIZE(ClipVertex, 24);

/// A vertex on the map: sub-texels, depth z / w, 1 / w.
struct PlacedVertex {
  int x, y;
  float z;
  float reciprocal_w;
};
UMB_ASSERT_SIZE(PlacedVertex, 16);

/// A triangle ready to be drawn, in the order in which all edge functions are positive inside.
struct RasterTriangle {
  int x0, y0, x1, y1, x2, y2;
  vec3 z;                    // of the vertices, over twice the area in texels · sub-texels
  float z_min, z_max;
  uint map;
  uint view;                 // of the map
  uint batch;                // with a mask, or NoIndex: opaque
  vec3 q;                    // masked: 1 / w of the vertices, and texture coordinates over w
  vec3 u;
  vec3 v;
};
UMB_ASSERT_SIZE(RasterTriangle, 92);

/// Clip position in view `face` of a map, of a position relative to the origin of the map's first view.
UMB_FN vec4 clip_position(ShadowView view, uint kind, uint face, vec3 relative) {
  if (kind == ViewsCube) {
    vec3 coordinates = face_coordinates(face, relative);
    return vec4(coordinates.x, coordinates.y, view.near_m, coordinates.z);
  }
  return clip_of_relative(view, relative);
}

/// Distance inside of a clip plane: near, far, then the sides of the guard band, which is `guard` times the view.
UMB_FN float clip_distance(vec4 position, uint plane, float guard) {
  if (plane == 0u) return position.w - position.z;
  if (plane == 1u) return position.z;
  if (plane == 2u) return guard * position.w - position.x;
  if (plane == 3u) return guard * position.w + position.x;
  if (plane == 4u) return guard * position.w - position.y;
  return guard * position.w + position.y;
}
UMB_CONST uint ClipPlanes = 6u;
UMB_FN float clip_guard(uint resolution) { return 2.0f * GuardTexels / float(resolution) - 1.0f; }

UMB_FN bool is_inside_guard(vec4 position, float guard) {
  float reach = guard * position.w;
  return position.z >= 0.0f && position.z <= position.w && abs(position.x) <= reach && abs(position.y) <= reach;
}

/// Where an edge from inside to outside of a plane meets it. Always in this direction: triangles that share the edge agree.
UMB_FN ClipVertex clip_edge(ClipVertex inside, ClipVertex outside, float inside_distance, float outside_distance) {
  UMB_PRECISE float t = inside_distance / (inside_distance - outside_distance);
  UMB_PRECISE vec4 position = inside.position + (outside.position - inside.position) * t;
  ClipVertex cut;
  cut.position = position;
  cut.uv = inside.uv + (outside.uv - inside.uv) * t;
  return cut;
}

/// False for what is no number. The position is inside the guard band.
UMB_FN bool place_vertex(vec4 position, uint resolution, UMB_OUT(PlacedVertex) placed) {
  float half_side = float(resolution) * 0.5f;
  UMB_PRECISE float reciprocal = 1.0f / position.w;
  UMB_PRECISE float x = position.x * reciprocal * half_side + half_side;
  UMB_PRECISE float y = position.y * reciprocal * half_side + half_side;
  UMB_PRECISE float z = position.z * reciprocal;
  bool valid = abs(x) <= 2.0f * GuardTexels && abs(y) <= 2.0f * GuardTexels && abs(z) <= 2.0f;
  placed.x = valid ? round_to_int(x * float(SubTexels)) : 0;
  placed.y = valid ? round_to_int(y * float(SubTexels)) : 0;
  placed.z = clamp(z, 0.0f, 1.0f);
  placed.reciprocal_w = reciprocal;
  return valid;
}

/// First and last texel whose centre lies within lo … hi sub-texels.
UMB_FN int first_texel(int lo) { return (lo + SubTexels / 2 - 1) >> 8; }
UMB_FN int last_texel(int hi) { return (hi - SubTexels / 2) >> 8; }

/// An edge function at a block's first texel, in whole texels · sub-texels and rounded down: at least 0 is inside, the
/// top-left rule included. `fraction` is what it lacks of the true one. Steps from texel to texel are whole.
struct EdgeStart {
  int value;
  float fraction;
};
UMB_ASSERT_SIZE(EdgeStart, 8);

/// step_x, step_y: from texel to texel; (dx, dy): from the edge to the texel's centre in sub-texels, at most 2^14.
UMB_FN EdgeStart start_narrow_edge(int step_x, int step_y, int dx, int dy) {
  int function = step_x * dx + step_y * dy;
  int rule = step_x > 0 || (step_x == 0 && step_y > 0) ? 0 : 1;
  EdgeStart start;
  start.value = (function - rule) >> 8;
  start.fraction = float(function - (start.value << 8)) * (1.0f / 256.0f);
  return start;
}

/// The same without limit. Values beyond ±2^30 keep their sign all over a block of 32 texels and go to `fraction`.
UMB_FN EdgeStart start_edge(int step_x, int step_y, int dx, int dy) {
  int64_t function = int64_t(step_x) * int64_t(dx) + int64_t(step_y) * int64_t(dy);
  int64_t rule = step_x > 0 || (step_x == 0 && step_y > 0) ? int64_t(0) : int64_t(1);
  int64_t value = (function - rule) >> 8;
  int64_t limit = int64_t(1) << 30;
  value = value > limit ? limit : value < -limit ? -limit : value;
  EdgeStart start;
  start.value = int(value);
  start.fraction = float(function - value * int64_t(256)) * (1.0f / 256.0f);
  return start;
}

/// The depth key at a texel from its edge functions: all weights are positive, so nothing cancels.
UMB_FN uint depth_key(RasterTriangle triangle, ivec3 edges, vec3 fractions) {
  UMB_PRECISE float w0 = float(edges.x) + fractions.x;
  UMB_PRECISE float w1 = float(edges.y) + fractions.y;
  UMB_PRECISE float w2 = float(edges.z) + fractions.z;
  UMB_PRECISE float z = w0 * triangle.z.x + w1 * triangle.z.y + w2 * triangle.z.z;
  return floatBitsToUint(clamp(z, triangle.z_min, triangle.z_max));
}

UMB_NAMESPACE_END
#endif
