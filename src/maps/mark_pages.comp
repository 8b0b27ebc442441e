#version 460
// O3, O7: what the receivers of each cluster/light pair may look up: pages of the pair's map, tiles of its projection maps,
// the farthest depth in each cell of its depth grids. The box is grown by the filter and the bias first (E7).
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;

void set_bits(uint64_t words, uint word, uint bits) {
  if (bits != 0u && (Uints(words).v[word] & bits) != bits) atomicOr(Uints(words).v[word], bits);
}

void mark_rows(FrameRecord frame, MapRecord map, uint view, ViewFootprint seen) {
  if (map.pages == 0u) return;   // the store backs whole maps
  TileRect pages = tile_rect(seen.rect, map.pages);
  for (uint y = pages.begin.y; y < pages.end.y; ++y) {
    uvec2 span = footprint_row(seen, y, map.pages);
    if (span.x >= span.y) continue;
    uint first = y * map.pages + span.x;
    uint last = y * map.pages + span.y;
    for (uint word = first / 32u; word * 32u < last; ++word) {
      uint begin = max(first, word * 32u) - word * 32u;
      uint end = min(last, word * 32u + 32u) - word * 32u;
      set_bits(frame.page_bits, map.first_word + view * map.words + word, tile_span_mask(begin, end).x);
    }
  }
}

void mark_receivers(FrameRecord frame, MapRecord map, uint view, ViewFootprint seen, float depth) {
  uint receiver = map.first_receiver + view;
  TileRect tiles = tile_rect(seen.rect, ProjectionSide);
  for (uint y = tiles.begin.y; y < tiles.end.y; ++y) {
    uvec2 span = footprint_row(seen, y, ProjectionSide);
    set_bits(frame.projection, receiver * ProjectionSide + y, tile_span_mask(span.x, span.y).x);
  }
  uint side = frame.receiver_grid;
  TileRect cells = tile_rect(seen.rect, side);
  uint bits = floatBitsToUint(max(depth, 1e-30));
  for (uint y = cells.begin.y; y < cells.end.y; ++y) {
    uvec2 span = footprint_row(seen, y, side);
    uint row = (receiver * side + y) * side;
    for (uint x = span.x; x < span.y; ++x)
      if (Uints(frame.receiver_depth).v[row + x] < bits) atomicMax(Uints(frame.receiver_depth).v[row + x], bits);
  }
}

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
  MapRecord map = Maps(frame.maps).v[map_index];
  for (uint face = 0u; face < map.view_count; ++face) {
    ShadowView view = Views(push.views).v[map.first_view + face];
    float margin = view_receiver_margin_m(view, map.kind, box.lo, box.hi, map.resolution);
    ViewFootprint seen;
    if (!project_box_to_view(view, map.kind, face, box.lo - margin, box.hi + margin, seen)) continue;
    uint bit = 1u << face;
    if ((Maps(frame.maps).v[map_index].faces & bit) == 0u) atomicOr(Maps(frame.maps).v[map_index].faces, bit);
    mark_rows(frame, map, face, seen);
    mark_receivers(frame, map, face, seen, farthest_tap_depth(view, map.kind, seen.box.hi.z, map.resolution));
  }
}
