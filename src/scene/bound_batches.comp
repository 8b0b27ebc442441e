#version 460
// World box of each batch that moved or deformed, from its vertices (O4: recomputed for what moves). A workgroup a caster.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/scene_push.shared.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { BoundBatchesPush push; };

shared uint lo[3];
shared uint hi[3];

void main() {
  uint caster_index = Uints(push.moved).v[gl_WorkGroupID.x];
  uint thread = gl_LocalInvocationIndex;
  if (thread < 3u) {
    lo[thread] = 0xffffffffu;
    hi[thread] = 0u;
  }
  barrier();
  CasterRecord caster = Casters(push.casters).v[caster_index];
  if (caster.instance != NoIndex) {
    InstanceRecord instance = Instances(push.instances).v[caster.instance];
    BatchRecord batch = Batches(push.batches).v[caster.batch];
    vec3 box_min = vec3(1e30);
    vec3 box_max = vec3(-1e30);
    for (uint i = thread; i < batch.index_count; i += 64u) {
      uint vertex = Uints(push.indices).v[batch.first_index + i] * instance.position_stride;
      Floats positions = Floats(instance.positions);
      vec4 position = vec4(positions.v[vertex], positions.v[vertex + 1u], positions.v[vertex + 2u], 1.0);
      vec3 world = vec3(dot(instance.row0, position), dot(instance.row1, position), dot(instance.row2, position));
      box_min = min(box_min, world);
      box_max = max(box_max, world);
    }
    if (box_min.x <= box_max.x) {
      for (int axis = 0; axis < 3; ++axis) {
        atomicMin(lo[axis], ordered_bits(box_min[axis]));
        atomicMax(hi[axis], ordered_bits(box_max[axis]));
      }
    }
  }
  barrier();
  if (thread != 0u) return;
  Box box = Box(vec3(1e30), vec3(-1e30));
  if (lo[0] <= hi[0]) {
    box.lo = vec3(from_ordered_bits(lo[0]), from_ordered_bits(lo[1]), from_ordered_bits(lo[2]));
    box.hi = vec3(from_ordered_bits(hi[0]), from_ordered_bits(hi[1]), from_ordered_bits(hi[2]));
  }
  Boxes(push.boxes).v[caster_index] = box;
}
