#version 460
// O13: how much the store must back for what is marked of each map. A workgroup a map.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
#include "maps/marked_blocks.glsl"
layout(local_size_x = 64) in;

shared uint found;

void main() {
  FrameRecord frame = Frame(push.frame).record;
  MapRecord map = Maps(frame.maps).v[group_index()];
  if (gl_LocalInvocationIndex == 0u) found = 0u;
  barrier();
  uvec2 blocks = blocks_of(map.resolution);
  uint units = block_units(map.resolution);
  for (uint i = gl_LocalInvocationIndex; units > 0u && i < map.view_count * blocks.x * blocks.y; i += 64u) {
    uint block = i % (blocks.x * blocks.y);
    if (any_marked(frame, map, i / (blocks.x * blocks.y), uvec2(block % blocks.x, block / blocks.x), map.resolution)) atomicAdd(found, 1u);
  }
  barrier();
  if (gl_LocalInvocationIndex != 0u || found == 0u) return;
  atomicAdd(Counters(push.counters).counters.pages, found);
  // Saturates: what is beyond 2^31 units is too much whatever it is.
  if (atomicAdd(Counters(push.counters).counters.pool_units, found * units) > 0x80000000u)
    atomicMin(Counters(push.counters).counters.pool_units, 0x80000000u);
}
