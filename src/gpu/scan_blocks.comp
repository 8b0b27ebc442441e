#version 460
// Prefix sum, step 2: where each block begins, and the total; by one workgroup.
#extension GL_GOOGLE_include_directive : require
#include "gpu/scan.glsl"
layout(local_size_x = ScanThreads) in;

shared uint sums[ScanThreads];

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint blocks = (scan_count() + ScanBlock - 1u) / ScanBlock;
  uint share = (blocks + ScanThreads - 1u) / ScanThreads;
  uint begin = min(thread * share, blocks);
  uint end = min(begin + share, blocks);
  uint sum = 0u;
  for (uint i = begin; i < end; ++i) sum += Uints(push.sums).v[i];
  sums[thread] = sum;
  barrier();
  uint before = 0u;
  for (uint i = 0u; i < thread; ++i) before += sums[i];
  for (uint i = begin; i < end; ++i) {
    uint count = Uints(push.sums).v[i];
    Uints(push.sums).v[i] = before;
    before += count;
  }
  if (thread == ScanThreads - 1u) Uints(push.total).v[0] = before;
}
