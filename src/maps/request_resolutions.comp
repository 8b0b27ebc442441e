#version 460
// O2: the resolution that each cluster/light pair asks for, and per light which levels are asked for and the finest of all.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;

/// Farthest axis depth of a box on the light's views; ortho: metres make no difference.
float farthest_depth(LightRecord light, ShadowView view, Box box) {
  vec3 a = abs(box.lo - light.position_ws);
  vec3 b = abs(box.hi - light.position_ws);
  if (light.views == ViewsCube) return max(max(max(a.x, b.x), max(a.y, b.y)), max(a.z, b.z));
  vec3 centre = (box.lo + box.hi) * 0.5 - view.origin;
  return max(dot(view.w_row, centre) + dot(abs(view.w_row), (box.hi - box.lo) * 0.5), light.near_m);
}

float request(FrameRecord frame, uint cluster, Box box, LightRecord light) {
  uint cell = Uints(frame.cluster_cells).v[cluster];
  uint tile_index = cell / MaxSlices;
  uint slice = cell % MaxSlices;
  bool tight = frame.explicit_bounds != 0u;
  vec4 sphere = vec4((box.lo + box.hi) * 0.5, length(box.hi - box.lo) * 0.5);
  if (has_flag(MapsDropFacingAway) && faces_away(Cones(frame.cluster_cones).v[cluster], sphere.xyz, sphere.w, light)) return 0.0;
  ShadowView view = Views(push.views).v[light.first_view];
  CameraRecord camera = camera_of_tile(frame, tile_index);
  float pixel_m = nearest_pixel_m(camera, box, slice);
  if (has_levels(light)) return Views(push.views).v[light.first_view + SunPlane].side_m / pixel_m;
  if (light.views == ViewsOrtho) return view.side_m / pixel_m;
  uint tile = tile_index - camera.first_tile;
  if (!tight) sphere = cell_sphere(camera, uvec2(tile % camera.tiles.x, tile / camera.tiles.x), slice);
  float pixels = tight ? box_pixels(camera, box) : float(TileSide * TileSide);
  float alpha = sphere_solid_angle(sphere.w, distance(sphere.xyz, light.position_ws));
  float paper = paper_resolution(pixels, alpha, view.tangent);
  if (has_flag(MapsPaperResolution)) return paper;
  // Within the sphere alpha says nothing (E2): the pixel's size decides.
  float scaled = alpha >= 4.0 * Pi ? 0.0 : paper * CentreTexelScale;
  return max(scaled, matching_resolution(farthest_depth(light, view, box), view.tangent, pixel_m));
}

/// Where receivers of a level lie.
void ask_for_level(LightRecord light, uint place, Box box) {
  ShadowView plane = Views(push.views).v[light.first_view + SunPlane];
  SunRect rect = sun_overlap(sun_rect(plane, box.lo, box.hi), sun_casters(plane, Views(push.views).v[light.first_view]));
  if (sun_rect_is_empty(rect)) return;
  uint at = (light.first_view + SunFirstWindow + place) * 4u;
  uint bits[4] = {ordered_bits(-rect.lo.x), ordered_bits(-rect.lo.y), ordered_bits(rect.hi.x), ordered_bits(rect.hi.y)};
  for (uint i = 0u; i < 4u; ++i)
    if (Uints(push.level_bounds).v[at + i] < bits[i]) atomicMax(Uints(push.level_bounds).v[at + i], bits[i]);
}

void main() {
  uint pair = global_index(64u);
  if (pair >= pair_count()) return;
  uint cluster = Uints(push.pair_clusters).v[pair];
  float wanted = 0.0;
  if (cluster != NoIndex) {
    FrameRecord frame = Frame(push.frame).record;
    uint slot = Uints(frame.cluster_lights).v[pair];
    LightRecord light = Lights(frame.lights).v[slot];
    Box box = Boxes(frame.cluster_boxes).v[cluster];
    if (light.view_count > 0u) wanted = request(frame, cluster, box, light);
    if (wanted > 0.0) {
      wanted /= push.undersampling;
      if (!has_levels(light)) wanted = min(clamp(wanted, float(push.min_resolution), float(push.max_resolution)), float(light.resolution));
      uint bits = floatBitsToUint(wanted);
      if (Requests(push.requests).v[slot].finest < bits) atomicMax(Requests(push.requests).v[slot].finest, bits);
      if (!has_flag(MapsExact)) {
        uint place = has_levels(light) ? sun_place_of_request(wanted) : place_of_level(level_of_resolution(wanted));
        if (has_levels(light)) ask_for_level(light, place, box);
        if ((Requests(push.requests).v[slot].places & 1u << place) == 0u) atomicOr(Requests(push.requests).v[slot].places, 1u << place);
      }
    }
  }
  Uints(push.pair_requests).v[pair] = floatBitsToUint(wanted);
}
