// Debug pictures of the map that each pixel's brightest light is looked up in: its resolution, the size of its texels, its
// pages, the triangles drawn into it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#include "palette.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ShowPush push; };
#include "brightest.glsl"
#include "legend.glsl"

const int first_level = 2, levels = 12;        // Maps have 4…8192 texels a side.
const int finest_texel = -3, texel_steps = 7;  // 1/8…8 pixels.
const int fewest_triangles = 5, triangle_steps = 14;   // 32…2^18 and more.
const vec3 unmarked_color = vec3(1.0, 0.0, 1.0);

/// The map of one pixel, and the page of it on which the pixel lies.
struct Seen {
  uint light;              // In the cluster's list, or NoLight.
  UmbrageDebugMap map;
  uint view;               // UmbrageNoIndex: beyond the map.
  uvec2 page;
};

vec3 level_color(float level) { return turbo((level - float(first_level) + 0.5) / float(levels)); }

/// Blue below a pixel, pale at one, red above.
vec3 texel_color(float exponent) {
  float x = clamp(exponent / 3.0, -1.0, 1.0);
  vec3 far = x < 0.0 ? vec3(0.10, 0.30, 0.85) : vec3(0.80, 0.08, 0.10);
  vec3 middle = x < 0.0 ? vec3(0.45, 0.75, 0.95) : vec3(0.98, 0.65, 0.30);
  float share = abs(x) * 2.0;
  return share < 1.0 ? mix(vec3(0.95), middle, share) : mix(middle, far, share - 1.0);
}

vec3 triangles_color(float exponent) { return turbo((exponent - float(fewest_triangles) + 0.5) / float(triangle_steps)); }

Seen seen_at(Frame frame, UmbrageFrame shadows, Point p) {
  Seen seen = Seen(NoLight, umbrage_debug_no_map(0u), UmbrageNoIndex, uvec2(0u));
  if (!p.exists) return seen;
  UmbrageCluster cluster = umbrage_cluster(shadows, p.pixel, p.depth);
  seen.light = brightest(frame, shadows, cluster, p, push.light, false);
  if (seen.light == NoLight) return seen;
  seen.map = umbrage_debug_map(shadows, cluster, seen.light);
  if (seen.map.resolution == 0u) return seen;
  UmbrageDebugTexel texel = umbrage_debug_texel(shadows, seen.map, p.position_ws);
  seen.view = texel.view;
  if (texel.view != UmbrageNoIndex) seen.page = uvec2(min(texel.at, float(seen.map.resolution) - 1.0)) / seen.map.page_side;
  return seen;
}

/// log2 of the larger extent in pixels of a shadow texel on the surface.
float texel_exponent(Frame frame, UmbrageFrame shadows, Point p, uint light) {
  vec3 du_ws, dv_ws;
  umbrage_texel_footprint(shadows, umbrage_cluster(shadows, p.pixel, p.depth), light, p.position_ws, p.normal, du_ws, dv_ws);
  vec4 offset = vec4(p.position_ws - frame.data.eye_ws, 1.0);
  vec2 half_size = 0.5 * vec2(frame.data.width, frame.data.height);
  vec4 centre = frame.data.clip_from_offset * offset;
  vec4 u = frame.data.clip_from_offset * (offset + vec4(du_ws, 0.0));
  vec4 v = frame.data.clip_from_offset * (offset + vec4(dv_ws, 0.0));
  vec2 du = (u.xy / max(u.w, 1e-9) - centre.xy / centre.w) * half_size;
  vec2 dv = (v.xy / max(v.w, 1e-9) - centre.xy / centre.w) * half_size;
  return log2(max(max(length(du), length(dv)), 1e-9));
}

bool is_other_page(Seen a, Seen b) {
  return b.light != NoLight && a.map.slot == b.map.slot && (a.map.index != b.map.index || a.view != b.view || a.page != b.page);
}

/// Dark between pages of one light; else the level's colour, a shade of it for each page.
vec3 page_color(Frame frame, UmbrageFrame shadows, ivec2 pixel, Seen seen) {
  if (seen.view == UmbrageNoIndex) return vec3(0.0);
  if (!umbrage_debug_page_is_marked(shadows, seen.map, seen.view, seen.page)) return unmarked_color;
  if (is_other_page(seen, seen_at(frame, shadows, point_at(frame, pixel + ivec2(1, 0)))) ||
      is_other_page(seen, seen_at(frame, shadows, point_at(frame, pixel + ivec2(0, 1))))) {
    return vec3(0.0);
  }
  uint page = (seen.map.index * 6u + seen.view) * seen.map.pages * seen.map.pages + seen.page.y * seen.map.pages + seen.page.x;
  return mix(level_color(log2(float(seen.map.resolution))), hash_color(page), 0.4);
}

vec3 legend_color(int exponent) {
  if (push.show == ShowTriangles) return triangles_color(float(exponent));
  return push.show == ShowTexelsPerPixel ? texel_color(float(exponent)) : level_color(float(exponent));
}

vec3 with_legend(ivec2 pixel, ivec2 size, vec3 under) {
  bool texels = push.show == ShowTexelsPerPixel;
  int exponent;
  uint place;
  if (push.show == ShowTriangles) place = legend_at(pixel, size, fewest_triangles, triangle_steps, exponent);
  else if (texels) place = legend_at(pixel, size, finest_texel, texel_steps, exponent);
  else place = legend_at(pixel, size, first_level, levels, exponent);
  if (place == LegendField) return legend_color(exponent);
  if (place != LegendOutside) return place == LegendInk ? legend_ink : legend_paper;
  return with_title(pixel, size, NoNumber, under);
}

void main() {
  Frame frame = Frame(push.frame);
  ivec2 size = ivec2(frame.data.width, frame.data.height);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  Point p = point_at(frame, pixel);
  Seen seen = seen_at(frame, shadows, p);
  float lit = luminance(imageLoad(picture_target, pixel).rgb);
  vec3 shown = p.exists ? vec3(0.10 + 0.25 * lit) : vec3(0.0);   // No light, or none with a map.
  if (seen.map.resolution > 0u) {
    if (push.show == ShowResolution) shown = level_color(log2(float(seen.map.resolution)));
    if (push.show == ShowTexelsPerPixel) shown = texel_color(texel_exponent(frame, shadows, p, seen.light));
    if (push.show == ShowPages) shown = page_color(frame, shadows, pixel, seen);
    if (push.show == ShowTriangles) shown = triangles_color(log2(max(float(seen.map.triangles), 1.0)));
    shown *= mix(0.6, 1.0, lit);
  }
  imageStore(picture_target, pixel, vec4(with_legend(pixel, size, shown), 1.0));
}
