#version 460
// How many items (a batch in one map) each thread of each map's traversal finds, and each map in all.
#extension GL_GOOGLE_include_directive : require
#include "culling/map_items.glsl"
layout(local_size_x = TraverseThreads) in;

uvec2 found = uvec2(0u);   // opaque, masked
shared uvec2 found_by[TraverseThreads];

void visit(uint leaf, uint views) {
  bool masked = Batches(push.batches).v[Casters(push.casters).v[Uints(push.order).v[leaf]].batch].mask != NoIndex;
  found += masked ? uvec2(0u, 1u) : uvec2(1u, 0u);
}

void main() {
  uint map_index = gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationIndex;
  load_map(map_index);
  walk(thread);
  found_by[thread] = found;
  barrier();
  uvec2 before = uvec2(0u);
  for (uint i = 0u; i < thread; ++i) before += found_by[i];
  Uvec2s(push.counts).v[map_index * TraverseThreads + thread] = before;
  if (thread != TraverseThreads - 1u) return;
  Uints(push.totals).v[map_index] = before.x + found.x;
  Uints(push.totals).v[gl_NumWorkGroups.x + map_index] = before.y + found.y;
}
