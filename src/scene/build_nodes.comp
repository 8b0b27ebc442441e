#version 460
// One level of the left-balanced 32-way tree (O5): a node is the union of 32 consecutive boxes of the level below.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/tree_push.shared.h"
layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform PushBlock { NodesPush push; };

void main() {
  uint node = gl_GlobalInvocationID.x;
  uint begin = node * TreeWidth;
  if (begin >= push.child_count) return;
  uint end = min(begin + TreeWidth, push.child_count);
  Box around = Box(vec3(1e30), vec3(-1e30));
  for (uint i = begin; i < end; ++i) {
    Box box;
    if (push.is_leaf_level != 0u) {
      box = Boxes(push.boxes).v[Uints(push.order).v[i]];
      Boxes(push.leaves).v[i] = box;
    } else {
      box = Boxes(push.boxes).v[i];
    }
    around.lo = min(around.lo, box.lo);
    around.hi = max(around.hi, box.hi);
  }
  Boxes(push.nodes).v[node] = around;
}
