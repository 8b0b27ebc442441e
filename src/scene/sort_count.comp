#version 460
// Radix sort, step 1: how often each 4-bit digit occurs in a block of keys.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/tree_push.shared.h"
layout(local_size_x = SortThreads) in;
layout(push_constant, scalar) uniform PushBlock { SortPush push; };

shared uint counts[SortDigits * SortThreads];

void main() {
  uint thread = gl_LocalInvocationIndex;
  for (uint digit = 0u; digit < SortDigits; ++digit) counts[digit * SortThreads + thread] = 0u;
  uint begin = gl_WorkGroupID.x * SortBlock + thread * SortItemsPerThread;
  uint end = min(begin + SortItemsPerThread, push.count);
  for (uint i = begin; i < end; ++i)
    counts[((Uints(push.keys_in).v[i] >> push.shift) & 15u) * SortThreads + thread] += 1u;
  barrier();
  if (thread >= SortDigits) return;
  uint sum = 0u;
  for (uint i = 0u; i < SortThreads; ++i) sum += counts[thread * SortThreads + i];
  Uints(push.counts).v[thread * push.blocks + gl_WorkGroupID.x] = sum;
}
