#version 460
// Prefix sum, step 1: the sum of each block.
#extension GL_GOOGLE_include_directive : require
#include "gpu/scan.glsl"
layout(local_size_x = ScanThreads) in;

shared uint sums[ScanThreads];

void main() {
  uint count = scan_count();
  if (gl_WorkGroupID.x * ScanBlock >= count) return;
  uint thread = gl_LocalInvocationIndex;
  uint begin = gl_WorkGroupID.x * ScanBlock + thread * ScanItemsPerThread;
  uint end = min(begin + ScanItemsPerThread, count);
  uint sum = 0u;
  for (uint i = begin; i < end; ++i) sum += Uints(push.values).v[i];
  sums[thread] = sum;
  barrier();
  if (thread != 0u) return;
  for (uint i = 1u; i < ScanThreads; ++i) sum += sums[i];
  Uints(push.sums).v[gl_WorkGroupID.x] = sum;
}
