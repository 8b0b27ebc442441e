#version 460
// The views of every light that some cluster uses; fixed cubes: and where in the atlas each is drawn.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
#include "maps/map_push.shared.h"
#include "views/sun_levels.shared.h"
layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform PushBlock { BuildViewsPush push; };
UMB_ARRAY(Views, ShadowView, 4);

Box scene_box() {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = from_ordered_bits(Uints(push.scene_bounds).v[axis]);
    box.hi[axis] = from_ordered_bits(Uints(push.scene_bounds).v[3 + axis]);
  }
  if (!(box.lo.x <= box.hi.x)) box = Box(vec3(0.0), vec3(1.0));   // no casters
  return box;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= push.light_slots) return;
  LightRecord light = Lights(push.lights).v[slot];
  if (light.type == NoIndex) return;
  // Clusters without a list are looked up with every light.
  bool all_held = Counters(push.counters).counters.all_lights_used != 0u ||
                  Counters(push.counters).counters.clusters_found > Counters(push.counters).counters.clusters;
  uint word = Uints(push.used).v[slot];
  if (all_held || (word & LightIsUsed) != 0u) atomicAdd(Counters(push.counters).counters.lights_visible, 1u);
  // Receivers that no depth buffer holds need some lights, or all, that no cluster does.
  bool used = push.all_lights != 0u || all_held || word != 0u;
  if (used) Uints(push.used).v[slot] = word | LightIsUsed;
  if (used && light.view_count > 0u) atomicAdd(Counters(push.counters).counters.views_drawn, light.view_count);
  FrameRecord frame = Frame(push.frame).record;
  // In the page pool a view serves maps of every resolution: its guard is that of one page.
  uint guarded = frame.store == StoreAtlas ? light.resolution : GuardedSide;
  Box box = scene_box();
  for (uint i = 0u; i < light.view_count; ++i) {
    ShadowView view;
    if (light.views == ViewsOrtho) view = ortho_view(light.direction_ws, box.lo, box.hi, guarded, ViewGuardTexels);
    else if (light.views == ViewsCube) view = perspective_view(light.position_ws, light.near_m, face_rotation(i), 1.0);
    else view = perspective_view(light.position_ws, light.near_m, view_rotation(light.direction_ws), spot_tangent(light.outer_cone_rad, guarded, ViewGuardTexels));
    if (frame.store == StoreAtlas) {
      uvec2 tile = atlas_tile(light.first_view + i, frame.atlas_columns, frame.atlas_resolution);
      view.resolution = light.resolution;
      view.atlas_x = tile.x;
      view.atlas_y = tile.y;
    }
    view.light = used ? slot : NoIndex;
    Views(push.views).v[light.first_view + i] = view;
  }
  // In the page pool its maps are windows of a plane, which place_levels finds.
  if (light.views == ViewsOrtho && light.view_count > 0u && frame.store == StorePool)
    Views(push.views).v[light.first_view + SunPlane] = sun_plane(light.direction_ws, box.lo, box.hi);
}
