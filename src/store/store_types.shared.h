// Where shadow texels live: views, and their tiles in the depth atlas of the fixed-cubes store.
#ifndef UMBRAGE_STORE_TYPES_SHARED_H
#define UMBRAGE_STORE_TYPES_SHARED_H
#include "clusters/cluster_types.shared.h"
#include "views/view_math.shared.h"

UMB_NAMESPACE_BEGIN

/// One picture taken from a light: a cube face, a spot's cone or an ortho box. Clip position of a world position p, with
/// r = p - origin: (x_row·r, y_row·r, z_row·r + z_offset, w_row·r + w_offset); z/w is reversed, 1 at the near plane.
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
  uint resolution;         // texels along a side
  uint atlas_x, atlas_y;   // first texel
  float tangent;           // perspective: of the half-angle
  float texel_m;           // ortho: world size of a texel
};
UMB_ASSERT_SIZE(ShadowView, 96);

struct BuildViewsPush {      // build_views
  uint64_t frame;
  uint64_t lights;
  uint64_t used;             // one word a light slot
  uint64_t counters;
  uint64_t views;
  uint64_t scene_bounds;     // ordered_bits
  uint light_slots;
  uint all_lights;           // draw maps whatever the clusters say
};
UMB_ASSERT_SIZE(BuildViewsPush, 56);

/// The tile of the atlas that a view has for its own.
UMB_FN uvec2 atlas_tile(uint view, uint columns, uint tile_resolution) {
  return uvec2(view % columns, view / columns) * tile_resolution;
}

UMB_FN vec4 view_clip_position(ShadowView view, vec3 position_ws) {
  vec3 r = position_ws - view.origin;
  return vec4(dot(view.x_row, r), dot(view.y_row, r), dot(view.z_row, r) + view.z_offset, dot(view.w_row, r) + view.w_offset);
}

UMB_FN ShadowView perspective_view(LightRecord light, mat3 rotation, float tangent) {
  ShadowView view;
  mat3 rows = transpose(rotation);
  view.origin = light.position_ws;
  view.near_m = light.near_m;
  view.x_row = rows[0] / tangent;
  view.y_row = rows[1] / tangent;
  view.z_row = vec3(0.0f);
  view.z_offset = light.near_m;
  view.w_row = rows[2];
  view.w_offset = 0.0f;
  view.tangent = tangent;
  view.texel_m = 0.0f;
  view.resolution = light.resolution;
  view.light = 0u;
  view.atlas_x = 0u;
  view.atlas_y = 0u;
  return view;
}

UMB_FN ShadowView ortho_view(LightRecord light, Box scene) {
  mat3 rotation = view_rotation(light.direction_ws);
  mat3 rows = transpose(rotation);
  OrthoFit fit = ortho_fit(rotation, scene.lo, scene.hi, light.resolution, ViewGuardTexels);
  float half_side = fit.texel_m * float(light.resolution) * 0.5f;
  ShadowView view;
  view.origin = rows[0] * (fit.origin.x + half_side) + rows[1] * (fit.origin.y + half_side);
  view.near_m = 0.0f;
  view.x_row = rows[0] / half_side;
  view.y_row = rows[1] / half_side;
  float range = max(fit.depth_max - fit.depth_min, 1e-6f);
  view.z_row = rows[2] / -range;
  view.z_offset = fit.depth_max / range;
  view.w_row = vec3(0.0f);
  view.w_offset = 1.0f;
  view.tangent = 0.0f;
  view.texel_m = fit.texel_m;
  view.resolution = light.resolution;
  view.light = 0u;
  view.atlas_x = 0u;
  view.atlas_y = 0u;
  return view;
}

UMB_NAMESPACE_END
#endif
