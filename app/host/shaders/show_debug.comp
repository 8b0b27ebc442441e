// Debug pictures instead of the image: clusters, lights per pixel, normals, depth; for bounds and cubes, it dimmed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#define UMBRAGE_SET 2
#include "umbrage/shaders/umbrage.glsl"
#include "palette.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ShowPush push; };
#include "legend.glsl"

/// A bar from 0 to the largest count.
vec3 with_counts(ivec2 pixel, ivec2 size, uint most, vec3 under) {
  int scale = text_scale(size), pad = 3 * scale;
  ivec2 bar = ivec2(84, 5) * scale;
  ivec2 zero = ivec2(2 * pad, size.y - 5 * pad - text_height(scale) - bar.y);
  ivec2 corner = zero + ivec2(2 * char_width(scale), 0);
  ivec2 last = corner + ivec2(bar.x + char_width(scale), 0);
  ivec2 whole = ivec2(last.x - zero.x + digits_of(most) * char_width(scale), bar.y);
  if (!in_box(pixel, zero - pad, whole + 2 * pad)) return under;
  if (in_box(pixel, corner, bar)) return turbo(float(pixel.x - corner.x) / float(bar.x - 1));
  return in_number(pixel, zero, scale, 0u) || in_number(pixel, last, scale, most) ? legend_ink : legend_paper;
}

vec3 show_clusters(Frame frame, ivec2 pixel, float depth) {
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  uint index = umbrage_cluster(shadows, vec2(pixel) + 0.5, depth).index;
  float lit = luminance(imageLoad(picture_target, pixel).rgb);
  return hash_color(index) * mix(0.25, 1.0, lit);
}

vec3 show_lights(Frame frame, ivec2 pixel, float depth, ivec2 size) {
  uint most = Counters(frame.data.counters).data.most_lights_of_a_pixel;
  vec3 color = vec3(0.0);
  if (depth > 0.0) {
    UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
    uint count = umbrage_cluster(shadows, vec2(pixel) + 0.5, depth).count;
    color = turbo(float(count) / float(max(most, 1u)));
  }
  return with_counts(pixel, size, most, color);
}

/// White near, black far, equal steps for equal ratios of distance (equal distances when orthographic).
vec3 show_depth(Frame frame, ivec2 pixel, float depth) {
  float distance_m = -dot(offset_from_depth(frame, vec2(pixel) + 0.5, depth), frame.data.back_ws);
  vec2 range_m = frame.data.shown_depth_m;
  float share = frame.data.orthographic != 0u ? (distance_m - range_m.x) / (range_m.y - range_m.x)
                                              : log(distance_m / range_m.x) / log(range_m.y / range_m.x);
  return vec3(mix(1.0, 0.1, clamp(share, 0.0, 1.0)));
}

/// The light that the device has chosen.
uint title_number() { return push.show == ShowCubeProjection ? Subject(push.subject).data.light : NoNumber; }

void main() {
  Frame frame = Frame(push.frame);
  if (push.show == ShowExplicitBounds && gl_GlobalInvocationID.xy == uvec2(0u)) {
    Counters counters = Counters(frame.data.counters);
    counters.data.box_draws = 1u;
    counters.data.box_vertices = 24u;
    counters.data.box_instances = umbrage_cluster_count(umbrage_frame(frame.data.umbrage));
  }
  ivec2 size = ivec2(frame.data.width, frame.data.height);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  float depth = texelFetch(depth_target, pixel, 0).x;

  vec3 shown = vec3(0.0);
  if (push.show == ShowExplicitBounds || push.show == ShowCubeProjection) {
    shown = imageLoad(picture_target, pixel).rgb * 0.45;
  } else if (push.show == ShowLightsPerPixel) {
    shown = show_lights(frame, pixel, depth, size);
  } else if (depth > 0.0) {
    if (push.show == ShowClusters) shown = show_clusters(frame, pixel, depth);
    if (push.show == ShowNormals) shown = from_octahedral(texelFetch(geometric_normal_target, pixel, 0).xy) * 0.5 + 0.5;
    if (push.show == ShowDepth) shown = show_depth(frame, pixel, depth);
  }
  if (title_char(0) != 0u) shown = with_title(pixel, size, title_number(), shown);
  imageStore(picture_target, pixel, vec4(shown, 1.0));
}
