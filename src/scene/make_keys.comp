#version 460
// Morton code of each box's centre; empty boxes sort last.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/tree_push.shared.h"
layout(local_size_x = 128) in;
layout(push_constant, scalar) uniform PushBlock { BoundsPush push; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  Box bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lo[axis] = from_ordered_bits(Uints(push.bounds).v[axis]);
    bounds.hi[axis] = from_ordered_bits(Uints(push.bounds).v[3 + axis]);
  }
  Box box = Boxes(push.boxes).v[i];
  Uints(push.keys).v[i] = box_is_empty(box) ? NoIndex : morton_code((box.lo + box.hi) * 0.5, bounds);
  Uints(push.values).v[i] = i;
}
