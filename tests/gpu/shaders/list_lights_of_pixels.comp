// What the include says of every pixel: its cluster and lights by depth, by position, and the cluster's box and cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UMBRAGE_SET 0
#include "umbrage/shaders/umbrage.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
struct Sample {
  vec3 position_ws;
  float depth;
};
struct Answer {
  uint cluster, cluster_at, cell;
  uint inside_box;
  uint lights[8];      // bit host_index
  uint lights_at[8];
};
layout(buffer_reference, scalar) readonly buffer Samples { Sample v[]; };
layout(buffer_reference, scalar) buffer Answers { Answer v[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t shadows;
  uint64_t samples;
  uint64_t answers;
  uint width;
  uint height;
} push;

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= push.width || pixel.y >= push.height) return;
  uint i = pixel.y * push.width + pixel.x;
  Sample point = Samples(push.samples).v[i];
  UmbrageFrame frame = umbrage_frame(push.shadows);
  UmbrageCluster cluster = umbrage_cluster(frame, vec2(pixel) + 0.5, point.depth);
  UmbrageCluster at = umbrage_cluster_at(frame, point.position_ws);
  Answer answer;
  answer.cluster = cluster.index;
  answer.cluster_at = at.index;
  uvec2 cell = umbrage_cluster_cell(frame, cluster);
  answer.cell = cluster.index == 0xffffffffu ? 0xffffffffu : cell.x * 512u + cell.y;
  answer.inside_box = 0u;
  if (cluster.index != 0xffffffffu) {
    vec3 lo, hi;
    umbrage_cluster_box(frame, cluster.index, lo, hi);
    answer.inside_box = uint(all(lessThanEqual(lo, point.position_ws)) && all(lessThanEqual(point.position_ws, hi)));
  }
  for (uint word = 0u; word < 8u; ++word) answer.lights[word] = answer.lights_at[word] = 0u;
  for (uint k = 0u; k < cluster.count; ++k) {
    uint light = umbrage_light(frame, cluster, k).host_index;
    answer.lights[light >> 5] |= 1u << (light & 31u);
  }
  for (uint k = 0u; k < at.count; ++k) {
    uint light = umbrage_light(frame, at, k).host_index;
    answer.lights_at[light >> 5] |= 1u << (light & 31u);
  }
  Answers(push.answers).v[i] = answer;
}
