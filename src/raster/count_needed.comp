#version 460
// The oracle of the benchmarks: of the (triangle, view) pairs of a frame's items, those that cover a texel that was looked up.
// Plain and slow: every texel of a triangle's box until one is found.
#extension GL_GOOGLE_include_directive : require
layout(constant_id = 0) const bool masked = false;
#include "raster/raster_types.shared.h"
layout(local_size_x = RasterThreads) in;
layout(push_constant, scalar) uniform PushBlock { CountNeededPush push; };
#include "raster/page_raster_buffers.glsl"
#include "raster/triangle_setup.glsl"

bool needed = false;   // this triangle, so far

bool is_looked_up(uint texel) { return (Uints(push.texels).v[texel / 32u] >> texel % 32u & 1u) != 0u; }

bool covers_one(RasterTriangle t, uint origin, ivec2 first, ivec2 last, ivec3 row_edges) {
  uint side = page_side_of(map.resolution);
  for (int y = first.y; y <= last.y; ++y, row_edges += steps_y(t)) {
    ivec3 edges = row_edges;
    for (int x = first.x; x <= last.x; ++x, edges += steps_x(t))
      if ((edges.x | edges.y | edges.z) >= 0 && is_looked_up(origin + uint(y) % PageSide * side + uint(x) % PageSide)) return true;
  }
  return false;
}

void take_triangle(RasterTriangle t, bool narrow) {
  ivec2 first, last;
  texel_box(t, map.resolution, first, last);
  int side = int(PageSide);
  for (int top = first.y / side * side; top <= last.y && !needed; top += side) {
    for (int left = first.x / side * side; left <= last.x && !needed; left += side) {
      ivec2 block = ivec2(left, top);
      ivec2 lo = max(block, first);
      uint origin = page_origin(pool, map, t.view, uvec2(lo));
      if (origin == NoTexel) continue;
      ivec3 edges;
      vec3 fractions;
      start_edges(t, uvec2(block), edges, fractions);
      edges += steps_x(t) * (lo.x - block.x) + steps_y(t) * (lo.y - block.y);
      needed = covers_one(t, origin, lo, min(block + side - 1, last), edges);
    }
  }
}

void end_triangle() {
  if (needed) atomicAdd(Uints(push.count).v[0], 1u);
  needed = false;
}

void main() { set_up_item(); }
