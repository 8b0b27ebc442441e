#version 460
// Only when the pool is short: what each light's pages would need after 0, 1, … halvings of its resolutions. A workgroup a
// map. An estimate: filters reach farther at coarse texels; the rounds that follow count what is really marked.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;

bool is_marked(FrameRecord frame, MapRecord map, uint view, uint x, uint y) {
  uint page = y * map.pages + x;
  return (Uints(frame.page_bits).v[map.first_word + view * map.words + page / 32u] & (1u << (page % 32u))) != 0u;
}

bool any_marked(FrameRecord frame, MapRecord map, uint view, uint x, uint y, uint pages) {
  uvec2 begin = uvec2(x, y) * map.pages / pages;
  uvec2 end = (uvec2(x, y) + 1u) * map.pages + (pages - 1u);
  end /= pages;
  for (uint row = begin.y; row < end.y; ++row)
    for (uint column = begin.x; column < end.x; ++column)
      if (is_marked(frame, map, view, column, row)) return true;
  return false;
}

void main() {
  if (Counters(push.counters).counters.pool_units <= push.capacity_units) return;
  FrameRecord frame = Frame(push.frame).record;
  MapRecord map = Maps(frame.maps).v[group_index()];
  for (uint shift = 0u; shift <= MaxShift; ++shift) {
    uint resolution = has_flag(MapsExact) ? exact_resolution(float(map.resolution >> shift)) : max(map.resolution >> shift, 1u << MinLevel);
    uint pages = pages_of(resolution);
    uint marked = 0u;
    for (uint i = gl_LocalInvocationIndex; i < map.view_count * pages * pages; i += 64u) {
      uint view = i / (pages * pages);
      uint page = i % (pages * pages);
      if (any_marked(frame, map, view, page % pages, page / pages, pages)) ++marked;
    }
    if (marked > 0u) atomicAdd(Uints(push.demand).v[map.light * (MaxShift + 1u) + shift], marked * page_units_of(resolution));
  }
}
