// What the three steps of the prefix sum share.
#include "gpu/buffers.glsl"
#include "gpu/scan.shared.h"
layout(push_constant, scalar) uniform PushBlock { ScanPush push; };

/// How many values there are to sum.
uint scan_count() {
  if (push.counted == 0ul) return push.count;
  return min(Uints(push.counted).v[0] * push.scale, push.count);
}
