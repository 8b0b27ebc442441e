#version 460
// The static map of the frame before → this frame's (C6): shifted by whole texels and whole depth units, clear where nothing is
// known; or cleared. A thread a run of texels, a cell wide.
#extension GL_GOOGLE_include_directive : require
#include "cascades/cascade_buffers.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { CascadePush push; };

void main() {
  Table table = Table(push.table);
  uint index = gl_WorkGroupID.y;
  CascadeRecord cascade = table.v.records[index];
  CascadeState state = States(table.v.states).v[index];
  uint runs = cascade.side / CellTexels;
  uint run = gl_GlobalInvocationID.x;
  if (state.action == MapIsKept || run >= runs * cascade.side) return;
  ivec2 texel = ivec2(run % runs * CellTexels, run / runs);
  Uints maps = Uints(table.v.maps);
  uint to = map_words(table, index, state.front) + uint(texel.y) * cascade.side + uint(texel.x);
  if (state.action == MapIsCleared) {
    for (uint i = 0u; i < CellTexels; ++i) maps.v[to + i] = ClearDepth;
    return;
  }
  ivec3 by = cascade.origin - cascade.former;
  ivec2 from = texel + ivec2(by.x, by.y);
  uint words = map_words(table, index, 1u - state.front);
  bool row_is_known = from.y >= 0 && from.y < int(cascade.side);
  uint farthest = 0u;
  for (uint i = 0u; i < CellTexels; ++i) {
    int x = from.x + int(i);
    uint depth = ClearDepth;
    if (row_is_known && x >= 0 && x < int(cascade.side))
      depth = scrolled_depth(maps.v[words + uint(from.y) * cascade.side + uint(x)], by.z);
    farthest = max(farthest, depth);
    maps.v[to + i] = depth;
  }
  uint cell = cell_words(table, index) + uint(texel.y) / CellTexels * runs + run % runs;
  atomicMax(Uints(table.v.farthest).v[cell], farthest);
}
