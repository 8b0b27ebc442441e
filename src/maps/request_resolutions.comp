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

float request(FrameRecord frame, uint cluster, LightRecord light) {
  Box box = Boxes(frame.cluster_boxes).v[cluster];
  uint cell = Uints(frame.cluster_cells).v[cluster];
  uint tile_index = cell / MaxSlices;
  uint slice = cell % MaxSlices;
  bool tight = frame.explicit_bounds != 0u;
  vec4 sphere = vec4((box.lo + box.hi) * 0.5, length(box.hi - box.lo) * 0.5);
  if (has_flag(MapsDropFacingAway) && faces_away(Cones(frame.cluster_cones).v[cluster], sphere.xyz, sphere.w, light)) return 0.0;
  ShadowView view = Views(push.views).v[light.first_view];
  float pixel_m = nearest_pixel_m(frame.camera, box, slice);
  if (light.views == ViewsOrtho) return view.side_m / pixel_m;
  if (!tight) sphere = cell_sphere(frame.camera, uvec2(tile_index % frame.camera.tiles.x, tile_index / frame.camera.tiles.x), slice);
  float pixels = tight ? box_pixels(frame.camera, box) : float(TileSide * TileSide);
  float alpha = sphere_solid_angle(sphere.w, distance(sphere.xyz, light.position_ws));
  float paper = paper_resolution(pixels, alpha, view.tangent);
  if (has_flag(MapsPaperResolution)) return paper;
  // Within the sphere alpha says nothing (E2): the pixel's size decides.
  float scaled = alpha >= 4.0 * Pi ? 0.0 : paper * CentreTexelScale;
  return max(scaled, matching_resolution(farthest_depth(light, view, box), view.tangent, pixel_m));
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
    if (light.view_count > 0u) wanted = request(frame, cluster, light);
    if (wanted > 0.0) {
      wanted = clamp(wanted / push.undersampling, float(push.min_resolution), float(push.max_resolution));
      wanted = min(wanted, float(light.resolution));
      uint bits = floatBitsToUint(wanted);
      if (Requests(push.requests).v[slot].finest < bits) atomicMax(Requests(push.requests).v[slot].finest, bits);
      if (!has_flag(MapsExact)) {
        uint place = 1u << place_of_level(level_of_resolution(wanted));
        if ((Requests(push.requests).v[slot].places & place) == 0u) atomicOr(Requests(push.requests).v[slot].places, place);
      }
    }
  }
  Uints(push.pair_requests).v[pair] = floatBitsToUint(wanted);
}
