#version 460
// The box around all boxes, by order-free minima and maxima.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/tree_push.shared.h"
layout(local_size_x = 128) in;
layout(push_constant, scalar) uniform PushBlock { BoundsPush push; };

const uint items_per_thread = 16u;

void main() {
  Box all_boxes = Box(vec3(1e30), vec3(-1e30));
  uint begin = gl_GlobalInvocationID.x * items_per_thread;
  uint end = min(begin + items_per_thread, push.count);
  for (uint i = begin; i < end; ++i) {
    Box box = Boxes(push.boxes).v[i];
    all_boxes.lo = min(all_boxes.lo, box.lo);
    all_boxes.hi = max(all_boxes.hi, box.hi);
  }
  if (box_is_empty(all_boxes)) return;
  for (int axis = 0; axis < 3; ++axis) {
    atomicMin(Uints(push.bounds).v[axis], ordered_bits(all_boxes.lo[axis]));
    atomicMax(Uints(push.bounds).v[3 + axis], ordered_bits(all_boxes.hi[axis]));
  }
}
