#version 460
// The levels of directional lights: from where receivers ask for each to the window that a map of it is. A window holds the
// receivers of its own level and of all finer ones, so that what moves to a coarser level finds its texels there. A thread a light.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
#include "maps/map_push.shared.h"
#include "views/sun_levels.shared.h"
layout(local_size_x = 32) in;
UMB_ARRAY(Views, ShadowView, 4);
UMB_ARRAY(Requests, LightRequest, 4);
layout(push_constant, scalar) uniform PushBlock { PlaceLevelsPush push; };

void main() {
  FrameRecord frame = Frame(push.frame).record;
  if (gl_GlobalInvocationID.x >= frame.directional_count) return;
  uint slot = Uints(frame.light_order).v[gl_GlobalInvocationID.x];
  LightRecord light = Lights(frame.lights).v[slot];
  if (light.view_count == 0u) return;
  ShadowView plane = Views(frame.views).v[light.first_view + SunPlane];
  uint most = 1u << uint(findMSB(min(push.max_resolution, light.resolution)));
  uint places = Requests(push.requests).v[slot].places;
  SunRect asked;
  asked.lo = vec2(1e30);
  asked.hi = vec2(-1e30);
  for (uint place = 0u; place < SunPlaces; ++place) {
    uint at = (light.first_view + SunFirstWindow + place) * 4u;
    if (Uints(push.level_bounds).v[at] != 0u) {
      asked.lo = min(asked.lo, -vec2(from_ordered_bits(Uints(push.level_bounds).v[at]), from_ordered_bits(Uints(push.level_bounds).v[at + 1u])));
      asked.hi = max(asked.hi, vec2(from_ordered_bits(Uints(push.level_bounds).v[at + 2u]), from_ordered_bits(Uints(push.level_bounds).v[at + 3u])));
    }
    uint level = SunFinestLevel - place;
    SunWindow window = sun_window(asked, level, most);
    Views(frame.views).v[light.first_view + SunFirstWindow + place] = sun_window_view(plane, window, level);
    if (window.holds == 0u && (places >> place & 1u) != 0u) places |= 2u << place;   // the rest goes to the next coarser level
  }
  Requests(push.requests).v[slot].places = sun_kept_places(places, push.levels_per_sun);
}
