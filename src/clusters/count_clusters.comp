#version 460
// First cluster number of each tile: exclusive prefix sums over all tiles, by one workgroup.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
layout(local_size_x = 128) in;
layout(push_constant, scalar) uniform PushBlock { CompactPush push; };

shared uint sums[128];

void main() {
  uint total = Frame(push.frame).record.tile_count;
  uint thread = gl_LocalInvocationIndex;
  uint share = (total + 127u) / 128u;
  uint begin = min(thread * share, total);
  uint end = min(begin + share, total);
  uint sum = 0u;
  for (uint i = begin; i < end; ++i) sum += Uints(push.tile_counts).v[i];
  sums[thread] = sum;
  barrier();
  uint before = 0u;
  for (uint i = 0u; i < thread; ++i) before += sums[i];
  for (uint i = begin; i < end; ++i) {
    uint count = Uints(push.tile_counts).v[i];
    Uints(push.tile_counts).v[i] = before;
    before += count;
  }
  if (thread != 127u) return;
  uint clusters = min(before, Frame(push.frame).record.cluster_capacity);
  Counters(push.counters).counters.clusters_found = before;
  Counters(push.counters).counters.clusters = clusters;
  Counters(push.counters).counters.cluster_groups[0] = (clusters + 63u) / 64u;
  Counters(push.counters).counters.cluster_groups[1] = 1u;
  Counters(push.counters).counters.cluster_groups[2] = 1u;
}
