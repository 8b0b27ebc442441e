#version 460
// The pairs of one round, each with its draw: as many instances as the light has views for the batch.
#extension GL_GOOGLE_include_directive : require
#include "culling/traverse.glsl"
layout(local_size_x = TraverseThreads) in;

LightRecord light;
uint light_slot;
uint next_pair;
uint batches_drawn = 0u;
uint triangles_drawn = 0u;

void visit(uint caster, Box box) {
  uint mask = view_mask(light, box);
  if (mask == 0u || !caster_is_lit_by(caster, light.light_mask)) return;
  uint pair = next_pair++;
  if (pair < push.window_first || pair - push.window_first >= push.window_size) return;
  uint local = pair - push.window_first;
  BatchRecord batch = Batches(push.batches).v[Casters(push.casters).v[caster].batch];
  bool masked = batch.mask != NoIndex;
  Pairs(push.pairs).v[local] = CasterPair(caster, light_slot | (mask << 20u));
  uint command = masked ? push.window_size + atomicAdd(DrawCountList(push.draw_counts).v[0].masked, 1u)
                        : atomicAdd(DrawCountList(push.draw_counts).v[0].opaque, 1u);
  uint views = bitCount(mask);
  Commands(push.commands).v[command] = DrawCommand(batch.index_count, views, batch.first_index, 0, local << 3u);
  batches_drawn += views;
  triangles_drawn += views * batch.triangle_count;
}

void main() {
  light_slot = gl_WorkGroupID.x;
  uint entry = light_slot * TraverseThreads + gl_LocalInvocationIndex;
  uint last_entry = gl_NumWorkGroups.x * TraverseThreads - 1u;
  next_pair = Uints(push.counts).v[entry];
  uint end = entry < last_entry ? Uints(push.counts).v[entry + 1u] : Counters(push.counters).counters.caster_pairs;
  if (end == next_pair) return;
  if (end > Counters(push.counters).counters.pair_limit) Uints(push.used).v[light_slot] = LightIsUsed | LightLacksCasters;
  if (end <= push.window_first || next_pair >= push.window_first + push.window_size) return;
  light = Lights(push.lights).v[light_slot];
  walk(light, gl_LocalInvocationIndex);
  add_wide(batches_drawn, false);
  add_wide(triangles_drawn, true);
}
