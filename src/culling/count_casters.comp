#version 460
// How many instances (a batch in one view each) each thread of each light's traversal finds.
#extension GL_GOOGLE_include_directive : require
#include "culling/traverse.glsl"
layout(local_size_x = TraverseThreads) in;

uint found = 0u;

void visit(uint leaf, uint views) {
  if (caster_is_lit_by(Uints(push.order).v[leaf], light.light_mask)) found += bitCount(views);
}

void main() {
  uint slot = gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationIndex;
  light = Lights(push.lights).v[slot];
  if (light.type != NoIndex && light.view_count > 0u && Views(push.views).v[light.first_view].light == slot) walk(thread);
  Uints(push.counts).v[slot * TraverseThreads + thread] = found;
}
