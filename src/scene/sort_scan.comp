#version 460
// Radix sort, step 2: exclusive prefix sums over all digits and blocks, by one workgroup.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/tree_push.shared.h"
layout(local_size_x = SortThreads) in;
layout(push_constant, scalar) uniform PushBlock { SortPush push; };

shared uint sums[SortThreads];

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint total = push.blocks * SortDigits;
  uint share = (total + SortThreads - 1u) / SortThreads;
  uint begin = min(thread * share, total);
  uint end = min(begin + share, total);
  uint sum = 0u;
  for (uint i = begin; i < end; ++i) sum += Uints(push.counts).v[i];
  sums[thread] = sum;
  barrier();
  uint before = 0u;
  for (uint i = 0u; i < thread; ++i) before += sums[i];
  for (uint i = begin; i < end; ++i) {
    uint count = Uints(push.counts).v[i];
    Uints(push.counts).v[i] = before;
    before += count;
  }
}
