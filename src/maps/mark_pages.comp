#version 460
// O3, O7: what the receivers of each cluster/light pair may look up: pages of the pair's map, tiles of its projection maps,
// the farthest depth in each cell of its depth grids. The box is grown by the filter and the bias first (E7).
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;

#include "maps/mark_box.glsl"

/// The map of a directional light's level, or where its window does not hold the box, of the next coarser one that does.
uint map_of_level(LightMaps maps, LightRecord light, float wanted, Box box) {
  uint shift = maps.shift == MaxShift ? SunPlaces : maps.shift;
  uint map = maps.first + sun_map_of_place(maps.kept, min(sun_place_of_request(wanted) + shift, SunPlaces - 1u));
  uint last = maps.first + uint(bitCount(maps.kept)) - 1u;
  ShadowView plane = Views(push.views).v[light.first_view + SunPlane];
  SunRect rect = sun_overlap(sun_rect(plane, box.lo, box.hi), sun_casters(plane, Views(push.views).v[light.first_view]));
  while (map < last) {
    MapRecord level = Maps(Frame(push.frame).record.maps).v[map];
    if (sun_window_holds(plane, Views(push.views).v[level.first_view], rect)) break;
    ++map;
  }
  return map;
}

void main() {
  uint pair = global_index(64u);
  if (pair >= pair_count()) return;
  FrameRecord frame = Frame(push.frame).record;
  uint request = Uints(push.pair_requests).v[pair];
  if (request == 0u) {
    Uints(frame.pair_maps).v[pair] = NoIndex;
    return;
  }
  uint slot = Uints(frame.cluster_lights).v[pair];
  LightMaps maps = LightMapList(frame.light_maps).v[slot];
  float wanted = uintBitsToFloat(request);
  LightRecord light = Lights(frame.lights).v[slot];
  Box box = Boxes(frame.cluster_boxes).v[Uints(push.pair_clusters).v[pair]];
  uint map_index;
  if (has_levels(light)) {
    map_index = map_of_level(maps, light, wanted, box);
  } else {
    uint place;
    if (has_flag(MapsExact)) {
      float finest = uintBitsToFloat(Requests(push.requests).v[slot].finest);
      place = bucket_of_request(wanted, finest, push.maps_per_light, !has_flag(MapsLinearBuckets));
    } else {
      place = min(place_of_level(level_of_resolution(wanted)) + maps.shift, place_of_level(MinLevel));
    }
    map_index = maps.first + map_of_place(maps.kept, place);
  }
  Uints(frame.pair_maps).v[pair] = map_index;
  if (has_flag(MapsMarkBlocks)) return;
  MapRecord map = Maps(frame.maps).v[map_index];
  mark_box(frame, map_index, map, box);
}
