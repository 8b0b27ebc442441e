// umbrage_visibility at any points, through the include's own way from a position to its cluster's lights. Taps are counted.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UMBRAGE_SET 0
#define UMBRAGE_COUNT_TAPS
#define UMBRAGE_CHECK_TEXELS
#include "umbrage/shaders/umbrage.glsl"

layout(local_size_x = 64) in;
struct Sample {
  vec3 position_ws;
  vec3 normal_ws;
  uint host_index;
};
layout(buffer_reference, scalar) readonly buffer Samples { Sample v[]; };
layout(buffer_reference, scalar) buffer Answers { float v[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t shadows;
  uint64_t samples;
  uint64_t answers;
  uint count;
} push;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  Sample point = Samples(push.samples).v[i];
  UmbrageFrame frame = umbrage_frame(push.shadows);
  UmbrageCluster cluster = umbrage_cluster_at(frame, point.position_ws);
  float visibility = -1.0;
  for (uint k = 0u; k < cluster.count; ++k) {
    if (umbrage_light(frame, cluster, k).host_index != point.host_index) continue;
    visibility = umbrage_visibility(frame, cluster, k, point.position_ws, point.normal_ws);
  }
  Answers(push.answers).v[i] = visibility;
}
