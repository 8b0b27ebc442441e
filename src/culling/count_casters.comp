#version 460
// How many instances (a batch in one view each) each thread of each light's traversal finds.
#extension GL_GOOGLE_include_directive : require
#include "culling/traverse.glsl"
layout(local_size_x = TraverseThreads) in;

LightRecord light;
uint found = 0u;

void visit(uint caster, Box box) {
  uint mask = view_mask(light, box);
  if (mask != 0u && caster_is_lit_by(caster, light.light_mask)) found += bitCount(mask);
}

void main() {
  uint slot = gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationIndex;
  light = Lights(push.lights).v[slot];
  if (light.type != NoIndex && light.view_count > 0u && Views(push.views).v[light.first_view].light == slot) walk(light, thread);
  Uints(push.counts).v[slot * TraverseThreads + thread] = found;
}
