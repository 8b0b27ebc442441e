// Debug pictures instead of the image: clusters, lights per pixel, normals, depth; for explicit bounds, it dimmed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#define UMBRAGE_SET 2
#include "umbrage/shaders/umbrage.glsl"
#include "palette.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { FramePush push; };

// Legend of the heat map: a bar with 0 and the largest count beside it.
const ivec2 bar_size = ivec2(256, 14);
const ivec2 bar_margin = ivec2(40, 16);
const int glyph_scale = 3;
// 3x5 digits, rows from the top, the high bit first.
const uint digits[10] =
    uint[](0x7b6fu, 0x2c97u, 0x73e7u, 0x73cfu, 0x5bc9u, 0x79cfu, 0x79efu, 0x7249u, 0x7befu, 0x7bcfu);

/// Is the pixel inside the decimal number whose top left corner is at `corner`?
bool in_number(ivec2 pixel, ivec2 corner, uint number) {
  ivec2 cell = pixel - corner;
  if (cell.x < 0 || cell.y < 0) return false;
  cell /= glyph_scale;
  int length = 1;
  for (uint rest = number / 10u; rest > 0u; rest /= 10u) ++length;
  int place = cell.x / 4, column = cell.x % 4;
  if (cell.y >= 5 || place >= length || column == 3) return false;
  for (int i = place + 1; i < length; ++i) number /= 10u;
  return (digits[number % 10u] >> (14 - (cell.y * 3 + column)) & 1u) != 0u;
}

vec3 with_legend(ivec2 pixel, ivec2 size, uint most, vec3 under) {
  ivec2 corner = ivec2(bar_margin.x, size.y - bar_margin.y - bar_size.y);
  ivec2 in_bar = pixel - corner;
  if (all(greaterThanEqual(in_bar, ivec2(0))) && all(lessThan(in_bar, bar_size))) {
    return turbo(float(in_bar.x) / float(bar_size.x - 1));
  }
  if (in_number(pixel, corner - ivec2(6 * glyph_scale, 0), 0u)) return vec3(1.0);
  if (in_number(pixel, corner + ivec2(bar_size.x + 3 * glyph_scale, 0), most)) return vec3(1.0);
  ivec2 frame = ivec2(3);
  bool near = all(greaterThanEqual(in_bar, -frame)) && all(lessThan(in_bar, bar_size + frame));
  return near ? vec3(0.0) : under;
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
  bool room = size.x >= 2 * bar_size.x && size.y >= 8 * bar_size.y;
  return room ? with_legend(pixel, size, most, color) : color;
}

/// White near, black far, equal steps for equal ratios of distance (equal distances when orthographic).
vec3 show_depth(Frame frame, ivec2 pixel, float depth) {
  float distance_m = -dot(offset_from_depth(frame, vec2(pixel) + 0.5, depth), frame.data.back_ws);
  vec2 range_m = frame.data.shown_depth_m;
  float share = frame.data.orthographic != 0u ? (distance_m - range_m.x) / (range_m.y - range_m.x)
                                              : log(distance_m / range_m.x) / log(range_m.y / range_m.x);
  return vec3(mix(1.0, 0.1, clamp(share, 0.0, 1.0)));
}

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
  if (push.show == ShowExplicitBounds) {
    shown = imageLoad(picture_target, pixel).rgb * 0.45;
  } else if (push.show == ShowLightsPerPixel) {
    shown = show_lights(frame, pixel, depth, size);
  } else if (depth > 0.0) {
    if (push.show == ShowClusters) shown = show_clusters(frame, pixel, depth);
    if (push.show == ShowNormals) shown = from_octahedral(texelFetch(geometric_normal_target, pixel, 0).xy) * 0.5 + 0.5;
    if (push.show == ShowDepth) shown = show_depth(frame, pixel, depth);
  }
  imageStore(picture_target, pixel, vec4(shown, 1.0));
}
