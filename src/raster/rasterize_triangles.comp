#version 460
// Work items → depth in the page pool: a workgroup an item, a thread a triangle. Small triangles are drawn at once, large ones
// are queued for the tiles; what finds the queue full is drawn here all the same.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
layout(constant_id = 0) const bool masked = false;
#include "raster/raster_types.shared.h"
layout(local_size_x = RasterThreads) in;
layout(push_constant, scalar) uniform PushBlock { PageRasterPush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "raster/draw_block.glsl"
#include "raster/triangle_setup.glsl"

/// Page by page.
void draw_here(RasterTriangle t, bool narrow, ivec2 first, ivec2 last) {
  const int side = int(PageSide);
  uint page_side = page_side_of(map.resolution);
  bool looked_up = draws_looked_up(map);
  ivec2 begin = first / side * side;
  for (ivec2 block = begin; block.y <= last.y;) {
    ivec2 lo = max(block, first);
    uint origin = page_origin(pool, map, t.view, uvec2(lo));
    if (origin != NoTexel) {
      ivec3 edges;
      vec3 fractions;
      if (narrow) {
        ivec2 at = lo * SubTexels + SubTexels / 2;
        ivec3 x = steps_x(t);
        ivec3 y = steps_y(t);
        EdgeStart a = start_narrow_edge(x.x, y.x, at.x - t.x1, at.y - t.y1);
        EdgeStart b = start_narrow_edge(x.y, y.y, at.x - t.x2, at.y - t.y2);
        EdgeStart c = start_narrow_edge(x.z, y.z, at.x - t.x0, at.y - t.y0);
        edges = ivec3(a.value, b.value, c.value);
        fractions = vec3(a.fraction, b.fraction, c.fraction);
      } else {
        start_edges(t, uvec2(block), edges, fractions);
        edges += steps_x(t) * (lo.x - block.x) + steps_y(t) * (lo.y - block.y);
      }
      draw_block(pool, t, page_side, origin, looked_up, lo, min(block + side - 1, last), edges, fractions);
    }
    block.x += side;
    if (block.x > last.x) block = ivec2(begin.x, block.y + side);
  }
}

void take_triangle(RasterTriangle t, bool narrow) {
  ivec2 first, last;
  texel_box(t, map.resolution, first, last);
  if (first.x > last.x || first.y > last.y) return;
  if ((push.flags & TestReceivers) != 0u && !receivers_see(pool, map, t.view, first, last, near_m, t.z_max)) return;
  if (map.resolution >= PageSide && (last.x - first.x + 1) * (last.y - first.y + 1) > int(QueuedTexels)) {
    uint place = atomicAdd(Appended(push.appended).v.triangles, 1u);
    if (place < push.large_capacity) {
      RasterTriangles(push.triangles).v[place] = t;
      return;
    }
  }
  draw_here(t, narrow, first, last);
}

void end_triangle() {}

void main() { set_up_item(); }
