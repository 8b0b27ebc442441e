#version 460
// Which lights reach a box of points that no depth buffer holds: they are used, and choose_maps gives them a map for those. A
// thread a light and BoxesAtOnce boxes.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_arrays.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { ReachBoxesPush push; };

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= push.light_slots) return;
  LightRecord light = Lights(push.lights).v[slot];
  if (light.type == NoIndex) return;
  uint end = min((gl_WorkGroupID.y + 1u) * BoxesAtOnce, push.box_count);
  for (uint i = gl_WorkGroupID.y * BoxesAtOnce; i < end; ++i) {
    if (!light_shines_on(light, Boxes(push.boxes).v[i])) continue;
    atomicOr(Uints(push.used).v[slot], LightReachesBoxes);
    return;
  }
}
