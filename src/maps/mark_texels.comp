#version 460
// Marks the texels that the nine taps of each depth-buffer sample read, of every light that reaches it: no others need be
// drawn. For pages of PageSide that have their place; smaller maps are drawn whole. A thread 2×2 pixels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "maps/map_arrays.glsl"
layout(local_size_x = MarkSide * MarkSide) in;
layout(push_constant, scalar) uniform PushBlock { MarkSamplesPush push; };
#include "clusters/sample.glsl"

/// What the passes of a thread read again and again.
struct Pages {
  Uints bits;
  Uints first;
  Uints texels;
};

/// Texels first … last of a view, which has them all; at most four pages.
void mark_rect(Pages pages, MapRecord map, uint view, uvec2 first, uvec2 last) {
  uvec2 end = last / PageSide;
  for (uvec2 page = first / PageSide; page.y <= end.y;) {
    PagePlace place = page_place(map, view, page * PageSide);
    uint bits = pages.bits.v[place.word];
    if ((bits >> place.bit & 1u) != 0u) {
      uvec2 lo = max(first, page * PageSide) - page * PageSide;
      uvec2 hi = min(last - page * PageSide, uvec2(PageSide - 1u));
      uint columns = (0xffffffffu >> (31u - (hi.x - lo.x))) << lo.x;
      uint row = texel_word(page_texel(bits, pages.first.v[place.word], place.bit, map.resolution), 0u);
      for (uint y = row + lo.y; y <= row + hi.y; ++y)
        if ((pages.texels.v[y] & columns) != columns) atomicOr(pages.texels.v[y], columns);
    }
    ++page.x;
    if (page.x > end.x) page = uvec2(first.x / PageSide, page.y + 1u);
  }
}

/// Texels within `reach` of places lo … hi on a view, where it has any.
void mark_around(Pages pages, MapRecord map, uint view, vec2 lo, vec2 hi, float reach) {
  float side = float(map.resolution);
  if (any(lessThan(hi, vec2(-reach))) || any(greaterThan(lo, vec2(side + reach)))) return;
  uint last = map.resolution - 1u;
  mark_rect(pages, map, view, uvec2(floor_to_uint(lo.x - reach, last), floor_to_uint(lo.y - reach, last)),
            uvec2(floor_to_uint(hi.x + reach, last), floor_to_uint(hi.y + reach, last)));
}

/// A sample's place on a view of a map, in texels.
struct Place {
  uint view;               // NoIndex: behind the light
  vec2 texels;
  float slack;             // texels: what roundings may make of `slack_m`
};

Place place_of(MapRecord map, LightRecord light, vec3 position, float slack_m) {
  float side = float(map.resolution);
  if (map.kind == ViewsCube) {
    vec3 relative = position - light.position_ws;
    uint face = face_of_direction(relative);
    vec3 place = face_coordinates(face, relative);
    return Place(face, (place.xy / place.z * 0.5 + 0.5) * side, side * (slack_m / place.z + 1e-6));
  }
  ShadowView view = Views(Frame(push.frame).record.views).v[map.first_view];
  if (map.kind == ViewsOrtho) {
    vec2 clip = view_clip_position(view, position).xy;
    return Place(0u, clamp(clip * 0.5 + 0.5, 0.0, 1.0) * side, side * (2.0 * slack_m / view.side_m + 1e-6));
  }
  vec3 relative = position - view.origin;
  float depth = dot(view.w_row, relative);
  vec2 clip = vec2(dot(view.x_row, relative), dot(view.y_row, relative)) / depth;
  return Place(depth > 0.0 ? 0u : NoIndex, clamp(clip * 0.5 + 0.5, 0.0, 1.0) * side, side * (slack_m / (depth * view.tangent) + 1e-6));
}

/// As nine taps: those beyond a cube face's border lie on the next face, at most a texel beside where the sample falls on it;
/// those beyond another view's border are moved to it.
void mark_place(Pages pages, MapRecord map, LightRecord light, vec3 position, Place place) {
  float side = float(map.resolution);
  float reach = 1.0 + place.slack;
  mark_around(pages, map, place.view, place.texels, place.texels, reach);
  if (map.kind != ViewsCube || (all(greaterThan(place.texels, vec2(reach))) && all(lessThan(place.texels, vec2(side - reach))))) return;
  for (uint face = 0u; face < CubeFaceCount; ++face) {
    vec3 beside = face_coordinates(face, position - light.position_ws);
    vec2 texels = (beside.xy / beside.z * 0.5 + 0.5) * side;
    if (face != place.view && beside.z > 0.0) mark_around(pages, map, face, texels, texels, reach + 1.0);
  }
}

const uint Samples = 4u;   // of a thread: 2×2 pixels

vec3 positions[Samples];
vec3 normals[Samples];     // 0: not known
uint slices[Samples];      // NoIndex: background

bool is_dark(uint i, LightRecord light) {
  if (light.faces != AllCubeFaces && !light_shines_on(light, Box(positions[i], positions[i]))) return true;
  vec3 to_light = light.type == LightDirectional ? -light.direction_ws : light.position_ws - positions[i];
  // Hosts keep normals with few bits.
  return normals[i] != vec3(0.0) && dot(normals[i], to_light) + 0.01 * dot(abs(to_light), vec3(1.0)) <= 0.0;
}

/// Samples of a slice in one map: at once where they lie close together in the middle of a view.
void mark_samples(Pages pages, MapRecord map, LightRecord light, uint slice, float slack_m) {
  vec2 lo = vec2(1e30);
  vec2 hi = vec2(-1e30);
  float reach = 0.0;
  uint view = NoIndex;
  bool together = true;
  [[unroll]] for (uint i = 0u; i < Samples; ++i) {
    bool is_lit = slices[i] == slice && !is_dark(i, light);
    Place place = place_of(map, light, positions[i], slack_m);
    together = together && (!is_lit || ((view == NoIndex || view == place.view) && place.view != NoIndex));
    view = is_lit ? place.view : view;
    lo = min(lo, is_lit ? place.texels : lo);
    hi = max(hi, is_lit ? place.texels : hi);
    reach = max(reach, is_lit ? 1.0 + place.slack : 0.0);
  }
  vec2 size = hi - lo;
  bool inside = min(lo.x, lo.y) > reach && max(hi.x, hi.y) < float(map.resolution) - reach;
  together = together && max(size.x, size.y) < 12.0 && (inside || map.kind != ViewsCube);
  if (together) {
    mark_around(pages, map, view, lo, hi, reach);
    return;
  }
  for (uint i = 0u; i < Samples; ++i) {
    if (slices[i] != slice || is_dark(i, light)) continue;
    Place place = place_of(map, light, positions[i], slack_m);
    if (place.view != NoIndex) mark_place(pages, map, light, positions[i], place);
  }
}

void mark_slice(FrameRecord frame, uint tile, uint slice) {
  ClusterList list = list_of_slice(frame, tile, slice);
  if (list.first == NoIndex) return;   // looked up in whole maps
  Box box = Box(vec3(1e30), vec3(-1e30));
  for (uint i = 0u; i < Samples; ++i)
    if (slices[i] == slice) box = Box(min(box.lo, positions[i]), max(box.hi, positions[i]));
  // Hosts compute positions with other roundings.
  vec3 largest = max(abs(box.lo), abs(box.hi));
  float slack_m = max(largest.x, max(largest.y, largest.z)) * 2e-6;
  box = Box(box.lo - slack_m, box.hi + slack_m);
  Pages pages = Pages(Uints(frame.page_bits), Uints(frame.page_first), Uints(frame.texel_bits));
  for (uint pair = list.first; pair < list.first + list.count; ++pair) {
    uint map_index = Uints(frame.pair_maps).v[pair];
    if (map_index == NoIndex) continue;
    MapRecord map = Maps(frame.maps).v[map_index];
    if (map.resolution < PageSide || map.receivers != ReceiversInSight) continue;
    LightRecord light = Lights(frame.lights).v[map.light];
    if (light_shines_on(light, box)) mark_samples(pages, map, light, slice, slack_m);
  }
}

void main() {
  if (!marks_texels(Counters(push.counters).counters, Frame(push.frame).record.tile_count)) return;
  CameraRecord camera = Cameras(push.camera).v[0];
  // Neighbours in a subgroup are neighbours in the picture.
  uvec2 own = uvec2(gl_LocalInvocationIndex % 4u + gl_LocalInvocationIndex / 32u * 4u, gl_LocalInvocationIndex / 4u % MarkSide);
  uvec2 first = (gl_WorkGroupID.xy * MarkSide + own) * 2u;
  for (uint i = 0u; i < Samples; ++i) {
    uvec2 pixel = first + uvec2(i % 2u, i / 2u);
    slices[i] = NoIndex;
    normals[i] = vec3(0.0);
    if (any(greaterThanEqual(pixel, camera.size)) || !read_sample(camera, ivec2(pixel), slices[i], positions[i])) slices[i] = NoIndex;
    else if (push.drop_facing_away != 0u && !read_normal(ivec2(pixel), normals[i])) normals[i] = vec3(0.0);
  }
  FrameRecord frame = Frame(push.frame).record;
  uint tile = camera.first_tile + first.y / TileSide * camera.tiles.x + first.x / TileSide;
  for (uint i = 0u; i < Samples; ++i) {
    bool is_first = slices[i] != NoIndex;   // of its slice
    for (uint j = 0u; j < i; ++j) is_first = is_first && slices[j] != slices[i];
    if (is_first) mark_slice(frame, tile, slices[i]);
  }
}
