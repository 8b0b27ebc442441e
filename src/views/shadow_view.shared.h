// The one abstraction: a picture taken from a light. A point light is six of them, a spot one, a directional light one, or one a
// level (sun_levels.shared.h).
#ifndef UMBRAGE_VIEWS_SHADOW_VIEW_SHARED_H
#define UMBRAGE_VIEWS_SHADOW_VIEW_SHARED_H
#include "views/cube_projection.shared.h"
#include "views/view_math.shared.h"

UMB_NAMESPACE_BEGIN

/// How a light's views are laid out.
UMB_CONST uint ViewsCube = 0u;    // six faces
UMB_CONST uint ViewsSpot = 1u;    // one perspective view
UMB_CONST uint ViewsOrtho = 2u;   // one orthographic view

/// A cube face, a spot's cone or an ortho box. Clip position of a world position p, with r = p - origin:
/// (x_row·r + x_offset, y_row·r + y_offset, z_row·r + z_offset, w_row·r + w_offset); z/w is reversed, 1 at the near plane. With a
/// grid, x_row·r and y_row·r are rounded to it before they are moved, so that they lie on the same steps wherever that is to.
struct ShadowView {
  vec3 origin;
  float near_m;            // perspective
  vec3 x_row;
  float z_offset;
  vec3 y_row;
  float w_offset;
  vec3 z_row;
  uint light;              // slot, or NoIndex: nothing to draw
  vec3 w_row;
  uint resolution;         // fixed cubes, windows of a sun: texels along a side
  uint atlas_x, atlas_y;   // fixed cubes: first texel
  float tangent;           // perspective: of the half-angle
  float side_m;            // ortho: world size of the view's side
  float x_offset, y_offset;
  float grid;              // steps in a unit of clip x and y, a power of two; 0: none
};
UMB_ASSERT_SIZE(ShadowView, 108);

/// Steps of the grid in a texel.
UMB_CONST float ViewSubTexels = 256.0f;

UMB_FN float on_grid(float x, float grid) { return grid > 0.0f ? roundEven(x * grid) / grid : x; }

/// Of r = position - origin.
UMB_FN vec4 clip_of_relative(ShadowView view, vec3 r) {
  return vec4(on_grid(dot(view.x_row, r), view.grid) + view.x_offset, on_grid(dot(view.y_row, r), view.grid) + view.y_offset,
              dot(view.z_row, r) + view.z_offset, dot(view.w_row, r) + view.w_offset);
}
UMB_FN vec4 view_clip_position(ShadowView view, vec3 position_ws) { return clip_of_relative(view, position_ws - view.origin); }

/// A view without a projection yet.
UMB_FN ShadowView bare_view(vec3 origin) {
  ShadowView view;
  view.origin = origin;
  view.near_m = 0.0f;
  view.x_row = vec3(0.0f);
  view.y_row = vec3(0.0f);
  view.z_row = vec3(0.0f);
  view.z_offset = 0.0f;
  view.w_row = vec3(0.0f);
  view.w_offset = 1.0f;
  view.tangent = 0.0f;
  view.side_m = 0.0f;
  view.resolution = 0u;
  view.light = 0u;
  view.atlas_x = 0u;
  view.atlas_y = 0u;
  view.x_offset = 0.0f;
  view.y_offset = 0.0f;
  view.grid = 0.0f;
  return view;
}

UMB_FN ShadowView perspective_view(vec3 origin, float near_m, mat3 rotation, float tangent) {
  mat3 rows = transpose(rotation);
  ShadowView view = bare_view(origin);
  view.near_m = near_m;
  view.x_row = rows[0] / tangent;
  view.y_row = rows[1] / tangent;
  view.z_offset = near_m;
  view.w_row = rows[2];
  view.w_offset = 0.0f;
  view.tangent = tangent;
  return view;
}

/// A square of half_side_m around the origin, seen from infinitely far. depth_range_m: from depth 0 to 1; depth_offset: the origin's.
UMB_FN ShadowView parallel_view(vec3 origin, mat3 rows, float half_side_m, float depth_range_m, float depth_offset) {
  ShadowView view = bare_view(origin);
  view.x_row = rows[0] / half_side_m;
  view.y_row = rows[1] / half_side_m;
  view.z_row = rows[2] / -depth_range_m;
  view.z_offset = depth_offset;
  view.side_m = half_side_m * 2.0f;
  return view;
}

/// Along a direction, around a world box, with `guard` texels to spare on every side at a resolution.
UMB_FN ShadowView ortho_view(vec3 direction, vec3 box_min, vec3 box_max, uint resolution, uint guard) {
  mat3 rotation = view_rotation(direction);
  mat3 rows = transpose(rotation);
  OrthoFit fit = ortho_fit(rotation, box_min, box_max, resolution, guard);
  float half_side = fit.texel_m * float(resolution) * 0.5f;
  float range = max(fit.depth_max - fit.depth_min, 1e-6f);
  vec3 origin = rows[0] * (fit.origin.x + half_side) + rows[1] * (fit.origin.y + half_side);
  return parallel_view(origin, rows, half_side, range, fit.depth_max / range);
}

// --- What lookups reach -----------------------------------------------------------------------------------------------

/// Taps read texels whose centres lie within one and a half of the receiver; a little more for rounding. Cells and tiles may be
/// smaller than a texel, so its centre counts.
UMB_CONST float FilterTexels = 1.55f;
/// The receiver's plane is moved so many texels towards the light's side before it is compared.
UMB_CONST float NormalOffsetTexels = 0.5f;
/// A tap never compares deeper than the receiver plus so many texels, however steep the receiver's plane: what lies farther
/// behind cannot matter to it, which is what depth culling rests on.
UMB_CONST float TapDepthTexels = 8.0f;

/// A texel's size at depth 1 of a perspective view, and everywhere in an ortho view.
UMB_FN float unit_texel_m(ShadowView view, uint kind, uint resolution) {
  return (kind == ViewsOrtho ? view.side_m : 2.0f * view.tangent) / float(resolution);
}

/// The least depth of what the views of a light see of a box: perspective along the axis of its view, ortho 1. `view`: any of them.
UMB_FN float least_depth(ShadowView view, uint kind, vec3 box_min, vec3 box_max) {
  if (kind == ViewsOrtho) return 1.0f;
  vec3 apart = max(box_min - view.origin, view.origin - box_max);
  if (kind == ViewsCube) return max(max(apart.x, apart.y), max(apart.z, view.near_m));
  vec3 centre = (box_min + box_max) * 0.5f - view.origin;
  return max(dot(view.w_row, centre) - dot(abs(view.w_row), (box_max - box_min) * 0.5f), view.near_m);
}

/// By how much a box of receivers is grown, on every side, so that its footprint holds all taps (E7). A texel is widest
/// where the axis depth is largest.
UMB_FN float view_receiver_margin_m(ShadowView view, uint kind, vec3 box_min, vec3 box_max, uint resolution) {
  float texel = unit_texel_m(view, kind, resolution);
  if (kind == ViewsOrtho) return texel * FilterTexels;
  if (kind == ViewsCube) return receiver_margin_m(box_min - view.origin, box_max - view.origin, resolution, FilterTexels, 0.0f);
  vec3 centre = (box_min + box_max) * 0.5f - view.origin;
  float depth = dot(view.w_row, centre) + dot(abs(view.w_row), (box_max - box_min) * 0.5f);
  return texel * FilterTexels * max(depth, 0.0f);
}

/// The farthest depth that a tap compares, of receivers no deeper than `depth`; in the view's depth (ViewFootprint).
UMB_FN float farthest_tap_depth(ShadowView view, uint kind, float depth, uint resolution) {
  float texel = unit_texel_m(view, kind, resolution);
  if (kind == ViewsOrtho) return depth + TapDepthTexels * texel * length(view.z_row);
  return depth * (1.0f + TapDepthTexels * texel);
}

// --- Boxes on views ---------------------------------------------------------------------------------------------------

/// What a view sees of a box. Depth: along the view's axis, in metres from the light; ortho: 1 - z, 0 at the near side and 1
/// at the far side of the casters.
struct ViewFootprint {
  FaceBox box;             // perspective: in units in which the view's pyramid is |x|, |y| <= z; ortho: clip x, y and depth
  FaceRect rect;
  uint perspective;
};
UMB_ASSERT_SIZE(ViewFootprint, 44);

/// False when the view does not see the box. kind: ViewsCube, … ; face: number of the view among its light's.
UMB_FN bool project_box_to_view(ShadowView view, uint kind, uint face, vec3 box_min, vec3 box_max, UMB_OUT(ViewFootprint) seen) {
  seen.perspective = kind == ViewsOrtho ? 0u : 1u;
  seen.rect.min_st = vec2(-1.0f);
  seen.rect.max_st = vec2(1.0f);
  if (kind == ViewsCube) {
    if (!clip_box_to_face(face, box_min - view.origin, box_max - view.origin, seen.box)) return false;
    seen.rect = face_rect(seen.box);
    return true;
  }
  // The box around the box in the view's frame: larger than the box itself, never smaller.
  vec3 centre = (box_min + box_max) * 0.5f - view.origin;
  vec3 half_size = (box_max - box_min) * 0.5f;
  vec3 depth_row = kind == ViewsOrtho ? vec3(0.0f) - view.z_row : view.w_row;
  float depth_offset = kind == ViewsOrtho ? 1.0f - view.z_offset : 0.0f;
  vec3 at = vec3(dot(view.x_row, centre) + view.x_offset, dot(view.y_row, centre) + view.y_offset, dot(depth_row, centre) + depth_offset);
  vec3 extent = vec3(dot(abs(view.x_row), half_size), dot(abs(view.y_row), half_size), dot(abs(depth_row), half_size));
  seen.box.lo = at - extent;
  seen.box.hi = at + extent;
  if (!all(lessThanEqual(box_min, box_max))) return false;
  if (kind == ViewsOrtho) {
    seen.rect.min_st = max(vec2(seen.box.lo.x, seen.box.lo.y) - CubeProjectionSlack, vec2(-1.0f));
    seen.rect.max_st = min(vec2(seen.box.hi.x, seen.box.hi.y) + CubeProjectionSlack, vec2(1.0f));
    return seen.rect.min_st.x <= seen.rect.max_st.x && seen.rect.min_st.y <= seen.rect.max_st.y;
  }
  vec3 apart = distance_to_axis_planes(seen.box.lo, seen.box.hi);
  seen.box.lo.z = max(seen.box.lo.z, max(apart.x, apart.y));
  if (!(seen.box.hi.z > 0.0f && seen.box.hi.z >= seen.box.lo.z)) return false;
  seen.rect = face_rect(seen.box);
  return true;
}

/// The tiles [x, y) of one row that a footprint touches; x >= y: none.
UMB_FN uvec2 footprint_row(ViewFootprint seen, uint row, uint tiles) {
  if (seen.perspective != 0u) return tile_row_span(seen.box, row, tiles);
  return uvec2(texel_of(seen.rect.min_st.x, tiles), texel_of(seen.rect.max_st.x, tiles) + 1u);
}

UMB_NAMESPACE_END
#endif
