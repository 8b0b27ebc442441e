#version 460
// Copies C to W where active casters are going to be drawn onto it (C2). A thread a run of texels, a cell wide.
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
  if (state.shows_work == 0u || run >= runs * cascade.side) return;
  uvec2 texel = uvec2(run % runs * CellTexels, run / runs);
  uint at = texel.y * cascade.side + texel.x;
  Uints maps = Uints(table.v.maps);
  uint from = map_words(table, index, state.front) + at;
  uint to = map_words(table, index, 2u) + at;
  uint farthest = 0u;
  for (uint i = 0u; i < CellTexels; ++i) {
    uint depth = maps.v[from + i];
    farthest = max(farthest, depth);
    maps.v[to + i] = depth;
  }
  uint cell = cell_words(table, index) + texel.y / CellTexels * runs + run % runs;
  atomicMax(Uints(table.v.farthest).v[cell], farthest);
}
