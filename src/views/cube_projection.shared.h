// Axis-aligned boxes projected onto the faces of a cube map (Olsson et al. 2014, poster, listing 1, for all six faces
// and with its errors mended; derived in docs/cube-projection.md). Boxes are closed and relative to the light.
#ifndef UMBRAGE_VIEWS_CUBE_PROJECTION_SHARED_H
#define UMBRAGE_VIEWS_CUBE_PROJECTION_SHARED_H

#include "core/shared_math.h"
#include "views/cube_face.shared.h"

UMB_NAMESPACE_BEGIN

/// Rectangles grow by this much in s and t on every side: more than the divisions of Vulkan (2.5 units in the last
/// place each) can move a point and its box apart.
UMB_CONST float CubeProjectionSlack = 2e-6f;
/// Tiles along a face's side, at most; a row of tiles is a 64-bit mask.
UMB_CONST uint MaxCubeTiles = 64u;

/// A box in the coordinates (sc, tc, depth) of one face. Its depth range is that of the part inside the face's pyramid
/// |sc|, |tc| <= depth, so lo.z and hi.z are also the nearest and farthest axis depth of what the face sees of the box.
struct FaceBox {
  vec3 lo;
  vec3 hi;
};
UMB_ASSERT_SIZE(FaceBox, 24);

/// Part of a face; -1 <= min <= max <= 1.
struct FaceRect {
  vec2 min_st;
  vec2 max_st;
};
UMB_ASSERT_SIZE(FaceRect, 16);

/// Tiles begin <= x, y < end of a face with a given number of tiles along its side.
struct TileRect {
  uvec2 begin;
  uvec2 end;
};
UMB_ASSERT_SIZE(TileRect, 16);

/// Distance of a box to the planes x = 0, y = 0 and z = 0, per axis.
UMB_FN vec3 distance_to_axis_planes(vec3 box_min, vec3 box_max) {
  return max(max(box_min, vec3(0.0f) - box_max), vec3(0.0f));
}

/// Bit f is set when the box meets the pyramid of face f beyond its apex: exact, comparisons only. 0 for an empty box
/// (any min > max); all six for a box with the light inside.
UMB_FN uint face_mask(vec3 box_min, vec3 box_max) {
  if (!all(lessThanEqual(box_min, box_max))) return 0u;
  vec3 apart = distance_to_axis_planes(box_min, box_max);
  // Being deepest is best: a face meets the box where its far side is as deep as the other two axes demand.
  vec3 demand = vec3(max(apart.y, apart.z), max(apart.x, apart.z), max(apart.x, apart.y));
  uint mask = 0u;
  if (box_max.x > 0.0f && box_max.x >= demand.x) mask |= 1u;
  if (box_min.x < 0.0f && -box_min.x >= demand.x) mask |= 2u;
  if (box_max.y > 0.0f && box_max.y >= demand.y) mask |= 4u;
  if (box_min.y < 0.0f && -box_min.y >= demand.y) mask |= 8u;
  if (box_max.z > 0.0f && box_max.z >= demand.z) mask |= 16u;
  if (box_min.z < 0.0f && -box_min.z >= demand.z) mask |= 32u;
  return mask;
}

/// The box in a face's coordinates, its depth range clipped to the face's pyramid. False when the face does not see it,
/// exactly as in face_mask; then the box is not to be used.
UMB_FN bool clip_box_to_face(uint face, vec3 box_min, vec3 box_max, UMB_OUT(FaceBox) box) {
  vec3 a = face_coordinates(face, box_min);
  vec3 b = face_coordinates(face, box_max);
  box.lo = min(a, b);
  box.hi = max(a, b);
  vec3 apart = distance_to_axis_planes(box.lo, box.hi);
  box.lo.z = max(box.lo.z, max(apart.x, apart.y));
  return all(lessThanEqual(box_min, box_max)) && box.hi.z > 0.0f && box.hi.z >= box.lo.z;
}

/// Smallest and largest c / depth over lo <= c <= hi, depth_min <= depth <= depth_max and |c| <= depth, with slack.
/// Such a pair (c, depth) exists.
UMB_FN vec2 quotient_range(float lo, float hi, float depth_min, float depth_max) {
  float first = -1.0f;
  float last = 1.0f;
  if (lo >= 0.0f)
    first = lo / depth_max;
  else if (-lo < depth_min)
    first = lo / depth_min;
  if (hi <= 0.0f)
    last = hi / depth_max;
  else if (hi < depth_min)
    last = hi / depth_min;
  return vec2(max(first - CubeProjectionSlack, -1.0f), min(last + CubeProjectionSlack, 1.0f));
}

/// The bounding rectangle of what a face sees of a box: exact but for the slack.
UMB_FN FaceRect face_rect(FaceBox box) {
  vec2 s = quotient_range(box.lo.x, box.hi.x, box.lo.z, box.hi.z);
  vec2 t = quotient_range(box.lo.y, box.hi.y, box.lo.z, box.hi.z);
  FaceRect rect;
  rect.min_st = vec2(s.x, t.x);
  rect.max_st = vec2(s.y, t.y);
  return rect;
}

/// Both steps: false when the face does not see the box, else its bounding rectangle on the face.
UMB_FN bool project_box_to_face(uint face, vec3 box_min, vec3 box_max, UMB_OUT(FaceRect) rect) {
  FaceBox box;
  if (!clip_box_to_face(face, box_min, box_max, box)) return false;
  rect = face_rect(box);
  return true;
}

/// The tiles that a rectangle touches. Tile i is [i, i + 1) / tiles of the side, the last one closed. Half-open tiles
/// and closed rectangles: what ends on a border has the tile that the border's points belong to, and a point has one.
UMB_FN TileRect tile_rect(FaceRect rect, uint tiles) {
  TileRect result;
  result.begin = uvec2(texel_of(rect.min_st.x, tiles), texel_of(rect.min_st.y, tiles));
  result.end = uvec2(texel_of(rect.max_st.x, tiles) + 1u, texel_of(rect.max_st.y, tiles) + 1u);
  return result;
}

/// The tiles [x, y) of one row that the box's silhouette (not just its rectangle) touches, exact but for the slack;
/// x >= y: none. The row's tiles see the depths at which t = tc / depth can lie between the row's borders.
UMB_FN uvec2 tile_row_span(FaceBox box, uint row, uint tiles) {
  float side = 2.0f / float(tiles);
  float t_begin = float(row) * side - 1.0f - CubeProjectionSlack;
  float t_end = float(row + 1u) * side - 1.0f + CubeProjectionSlack;
  float depth_min = box.lo.z;
  float depth_max = box.hi.z;
  // tc >= t_begin * depth must hold for the largest tc, and tc <= t_end * depth for the smallest.
  if (t_begin > 0.0f)
    depth_max = min(depth_max, box.hi.y / t_begin);
  else if (box.hi.y < 0.0f)
    depth_min = max(depth_min, box.hi.y / t_begin);
  if (t_end < 0.0f)
    depth_max = min(depth_max, box.lo.y / t_end);
  else if (box.lo.y > 0.0f)
    depth_min = max(depth_min, box.lo.y / t_end);
  if (depth_max <= 0.0f || depth_min > depth_max) return uvec2(0u, 0u);
  vec2 s = quotient_range(box.lo.x, box.hi.x, depth_min, depth_max);
  return uvec2(texel_of(s.x, tiles), texel_of(s.y, tiles) + 1u);
}

/// Bits begin <= i < end of a row: x holds tiles 0…31, y tiles 32…63.
UMB_FN uvec2 tile_span_mask(uint begin, uint end) {
  if (begin >= end) return uvec2(0u, 0u);
  uint low_end = min(end, 32u);
  uint high_begin = max(begin, 32u);
  uint low = begin < low_end ? (0xffffffffu >> (32u - (low_end - begin))) << begin : 0u;
  uint high = high_begin < end ? (0xffffffffu >> (32u - (end - high_begin))) << (high_begin - 32u) : 0u;
  return uvec2(low, high);
}

/// By how much to grow a box of receivers on every side before projecting it, so that its tiles hold every filter tap
/// up to filter_texels away from a receiver's texel in s and t, on its own face or across an edge, and receivers moved
/// by up to bias_m. A texel is widest where the axis depth is largest.
UMB_FN float receiver_margin_m(vec3 box_min, vec3 box_max, uint resolution, float filter_texels, float bias_m) {
  vec3 farthest = max(abs(box_min), abs(box_max));
  float depth_m = max(farthest.x, max(farthest.y, farthest.z)) + bias_m;
  return depth_m * 2.0f * filter_texels / float(resolution) + bias_m;
}

UMB_NAMESPACE_END
#endif
