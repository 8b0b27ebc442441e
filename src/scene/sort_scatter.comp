#version 460
// Radix sort, step 3: every key to its place; stable, because each thread owns a contiguous run.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/tree_push.shared.h"
layout(local_size_x = SortThreads) in;
layout(push_constant, scalar) uniform PushBlock { SortPush push; };

shared uint places[SortDigits * SortThreads];

void main() {
  uint thread = gl_LocalInvocationIndex;
  for (uint digit = 0u; digit < SortDigits; ++digit) places[digit * SortThreads + thread] = 0u;
  uint begin = gl_WorkGroupID.x * SortBlock + thread * SortItemsPerThread;
  uint end = min(begin + SortItemsPerThread, push.count);
  for (uint i = begin; i < end; ++i)
    places[((Uints(push.keys_in).v[i] >> push.shift) & 15u) * SortThreads + thread] += 1u;
  barrier();
  if (thread < SortDigits) {
    uint place = Uints(push.counts).v[thread * push.blocks + gl_WorkGroupID.x];
    for (uint i = 0u; i < SortThreads; ++i) {
      uint count = places[thread * SortThreads + i];
      places[thread * SortThreads + i] = place;
      place += count;
    }
  }
  barrier();
  for (uint i = begin; i < end; ++i) {
    uint key = Uints(push.keys_in).v[i];
    uint slot = ((key >> push.shift) & 15u) * SortThreads + thread;
    uint place = places[slot];
    places[slot] = place + 1u;
    Uints(push.keys_out).v[place] = key;
    Uints(push.values_out).v[place] = Uints(push.values_in).v[i];
  }
}
