#version 460
// Only when the store is short: what each light's pages would need after 0, 1, … halvings of its resolutions. A workgroup a
// map. An estimate: filters reach farther at coarse texels; the rounds that follow count what is really marked.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
#include "maps/marked_blocks.glsl"
layout(local_size_x = 64) in;

void main() {
  if (Counters(push.counters).counters.pool_units <= push.capacity_units) return;
  FrameRecord frame = Frame(push.frame).record;
  MapRecord map = Maps(frame.maps).v[group_index()];
  for (uint shift = 0u; shift <= MaxShift; ++shift) {
    uint resolution = has_flag(MapsExact) ? exact_resolution(float(map.resolution >> shift), backing().x)
                                          : backed_resolution(max(map.resolution >> shift, 1u << MinLevel), backing().x);
    uvec2 blocks = blocks_of(resolution);
    uint marked = 0u;
    for (uint i = gl_LocalInvocationIndex; i < map.view_count * blocks.x * blocks.y; i += 64u) {
      uint block = i % (blocks.x * blocks.y);
      if (any_marked(frame, map, i / (blocks.x * blocks.y), uvec2(block % blocks.x, block / blocks.x), resolution)) ++marked;
    }
    if (marked > 0u) atomicAdd(Uints(push.demand).v[map.light * (MaxShift + 1u) + shift], marked * block_units(resolution));
  }
}
