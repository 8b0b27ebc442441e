#version 460
// Empties what of the pool this frame's pages use: 0 is farther than everything, and nobody looks, or everybody where texels are not
// marked one by one. A workgroup per ClearUnits.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer Quads { uvec4 v[]; };

const uint quads = ClearUnits * PoolUnit / 4u;

void main() {
  FrameCounters counters = Counters(push.counters).counters;
  uint units = counters.pool_units;
  uint end = min((group_index() + 1u) * quads, units * (PoolUnit / 4u));
  Quads pool = Quads(Frame(push.frame).record.pool);
  Uints bits = Uints(Frame(push.frame).record.texel_bits);
  bool has_bits = Frame(push.frame).record.texel_bits != 0ul;
  uint looked_up = marks_texels(counters, Frame(push.frame).record.tile_count) ? 0u : 0xffffffffu;
  for (uint i = group_index() * ClearUnits + gl_LocalInvocationIndex; has_bits && i < min((group_index() + 1u) * ClearUnits, units); i += 64u) bits.v[i] = looked_up;
  for (uint i = group_index() * quads + gl_LocalInvocationIndex; i < end; i += 64u) pool.v[i] = uvec4(0u);
}
