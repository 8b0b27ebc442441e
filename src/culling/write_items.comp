#version 460
// The items of one round. Items are numbered by kind (opaque, masked), map, thread and place in the tree.
#extension GL_GOOGLE_include_directive : require
#include "culling/map_items.glsl"
layout(local_size_x = TraverseThreads) in;
UMB_ARRAY(Items, CasterItem, 4);
UMB_ARRAY(DrawCountList, DrawCounts, 4);

uint map_index;
uint first_masked;   // of all items
uvec2 next_item;     // opaque, masked
uint batches_drawn = 0u;
uint triangles_drawn = 0u;

void visit(uint leaf, uint faces) {
  uint caster = Uints(push.order).v[leaf];
  BatchRecord batch = Batches(push.batches).v[Casters(push.casters).v[caster].batch];
  bool masked = batch.mask != NoIndex;
  uint item = masked ? next_item.y++ : next_item.x++;
  if (item < push.window_first || item - push.window_first >= push.window_size) return;
  uint place = masked ? push.window_size + item - max(push.window_first, first_masked) : item - push.window_first;
  Items(push.items).v[place] = CasterItem(caster, map_index, faces);
  batches_drawn += bitCount(faces);
  triangles_drawn += bitCount(faces) * batch.triangle_count;
}

/// How many of the items begin … end-1 the round draws.
uint in_window(uint begin, uint end) {
  uint first = max(begin, push.window_first);
  return max(min(end, push.window_first + push.window_size), first) - first;
}

void main() {
  map_index = gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationIndex;
  uint maps = gl_NumWorkGroups.x;
  uint items = Counters(push.counters).counters.caster_pairs;
  first_masked = Uints(push.totals).v[maps];
  if (map_index == 0u && thread == 0u)
    DrawCountList(push.draw_counts).v[0] = DrawCounts(in_window(0u, first_masked), in_window(first_masked, items));

  // A map ends where the next begins, the last opaque one where the masked ones begin.
  uvec2 map_begin = uvec2(Uints(push.totals).v[map_index], Uints(push.totals).v[maps + map_index]);
  uvec2 map_end = uvec2(Uints(push.totals).v[map_index + 1u], map_index + 1u < maps ? Uints(push.totals).v[maps + map_index + 1u] : items);
  if (map_begin == map_end) return;
  uint entry = map_index * TraverseThreads + thread;
  next_item = map_begin + Uvec2s(push.counts).v[entry];
  uvec2 end = thread + 1u < TraverseThreads ? map_begin + Uvec2s(push.counts).v[entry + 1u] : map_end;
  if (next_item == end) return;
  load_map(map_index);
  uint limit = Counters(push.counters).counters.pair_limit;
  bool lacks = (end.x > limit && end.x > next_item.x) || (end.y > limit && end.y > next_item.y);
  if (lacks) Uints(push.used).v[map.light] = LightIsUsed | LightLacksCasters;
  if (in_window(next_item.x, end.x) + in_window(next_item.y, end.y) == 0u) return;
  walk(thread);
  add_wide(batches_drawn, false);
  add_wide(triangles_drawn, true);
  if (triangles_drawn > 0u) atomicAdd(Maps(Frame(push.frame).record.maps).v[map_index].triangles, triangles_drawn);
}
