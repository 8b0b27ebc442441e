#version 460
// The instances of one round, and a draw per batch and light: as many instances as the light has views for it (O12).
#extension GL_GOOGLE_include_directive : require
#include "culling/traverse.glsl"
layout(local_size_x = TraverseThreads) in;

uint light_slot;
uint next_instance;
uint batches_drawn = 0u;
uint triangles_drawn = 0u;

void visit(uint leaf, uint views) {
  uint caster_index = Uints(push.order).v[leaf];
  if (!caster_is_lit_by(caster_index, light.light_mask)) return;
  uint first = next_instance;
  next_instance += bitCount(views);
  uint begin = max(first, push.window_first);
  uint end = min(next_instance, push.window_first + push.window_size);
  if (begin >= end) return;
  CasterRecord caster = Casters(push.casters).v[caster_index];
  InstanceRecord instance = Instances(push.instances).v[caster.instance];
  for (uint i = begin; i < end; ++i) {
    uint view_index = light.first_view + nth_set_bit(views, i - first);
    ShadowView view = Views(push.views).v[view_index];
    Drawn(push.drawn).v[i - push.window_first] = caster_instance(instance, view, view_index, caster_index, caster.batch);
  }
  BatchRecord batch = Batches(push.batches).v[caster.batch];
  uint command = batch.mask != NoIndex ? push.window_size + atomicAdd(DrawCountList(push.draw_counts).v[0].masked, 1u)
                                       : atomicAdd(DrawCountList(push.draw_counts).v[0].opaque, 1u);
  Commands(push.commands).v[command] = DrawCommand(batch.index_count, end - begin, batch.first_index, 0, begin - push.window_first);
  batches_drawn += end - begin;
  triangles_drawn += (end - begin) * batch.triangle_count;
}

void main() {
  light_slot = gl_WorkGroupID.x;
  uint entry = light_slot * TraverseThreads + gl_LocalInvocationIndex;
  uint last_entry = gl_NumWorkGroups.x * TraverseThreads - 1u;
  next_instance = Uints(push.counts).v[entry];
  uint end = entry < last_entry ? Uints(push.counts).v[entry + 1u] : Counters(push.counters).counters.caster_pairs;
  if (end == next_instance) return;
  if (end > Counters(push.counters).counters.pair_limit) Uints(push.used).v[light_slot] = LightIsUsed | LightLacksCasters;
  if (end <= push.window_first || next_instance >= push.window_first + push.window_size) return;
  light = Lights(push.lights).v[light_slot];
  walk(gl_LocalInvocationIndex);
  add_wide(batches_drawn, false);
  add_wide(triangles_drawn, true);
}
