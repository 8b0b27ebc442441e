#version 460
// For the traditional writer: the draws of each view on their own, in a range of commands per view.
#extension GL_GOOGLE_include_directive : require
#include "culling/traverse.glsl"
layout(local_size_x = TraverseThreads) in;

uint view_bit;
uint batches_drawn = 0u;
uint triangles_drawn = 0u;

void visit(uint leaf, uint views) {
  if ((views & view_bit) == 0u) return;
  uint caster_index = Uints(push.order).v[leaf];
  if (!caster_is_lit_by(caster_index, light.light_mask)) return;
  CasterRecord caster = Casters(push.casters).v[caster_index];
  BatchRecord batch = Batches(push.batches).v[caster.batch];
  uint local_view = gl_WorkGroupID.x;
  bool masked = batch.mask != NoIndex;
  uint at = masked ? atomicAdd(DrawCountList(push.draw_counts).v[local_view].masked, 1u)
                   : atomicAdd(DrawCountList(push.draw_counts).v[local_view].opaque, 1u);
  at += (local_view * 2u + uint(masked)) * push.window_size;
  uint view_index = push.window_first + local_view;
  ShadowView view = Views(push.views).v[view_index];
  InstanceRecord instance = Instances(push.instances).v[caster.instance];
  Drawn(push.drawn).v[at] = caster_instance(instance, view, view_index, caster_index, caster.batch);
  Commands(push.commands).v[at] = DrawCommand(batch.index_count, 1u, batch.first_index, 0, at);
  ++batches_drawn;
  triangles_drawn += batch.triangle_count;
}

void main() {
  uint view_index = push.window_first + gl_WorkGroupID.x;
  uint slot = Views(push.views).v[view_index].light;
  if (slot == NoIndex) return;
  light = Lights(push.lights).v[slot];
  view_bit = 1u << (view_index - light.first_view);
  walk(gl_LocalInvocationIndex);
  add_wide(batches_drawn, false);
  add_wide(triangles_drawn, true);
}
