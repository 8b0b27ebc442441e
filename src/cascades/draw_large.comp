#version 460
// Queued triangles → depth: a workgroup a triangle, its threads share the cells that it may touch.
#extension GL_GOOGLE_include_directive : require
layout(constant_id = 0) const bool masked = false;
#include "cascades/cascade_types.shared.h"
layout(local_size_x = CascadeThreads) in;
layout(push_constant, scalar) uniform PushBlock { DrawCascadesPush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "cascades/draw_grid.glsl"

/// True where an edge leaves the whole rectangle outside.
bool misses(int step_x, int step_y, ivec2 from, ivec2 first, ivec2 last) {
  ivec2 corner = ivec2(step_x > 0 ? last.x : first.x, step_y > 0 ? last.y : first.y) * SubTexels + SubTexels / 2;
  return int64_t(step_x) * int64_t(corner.x - from.x) + int64_t(step_y) * int64_t(corner.y - from.y) < int64_t(edge_rule(step_x, step_y));
}

void main() {
  uint index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (index >= min(Arguments(push.arguments).v.larges, push.large_capacity)) return;
  GridTriangle t = GridTriangles(push.larges).v[index];
  CascadeRecord cascade = Table(push.table).v.records[t.cascade];
  ivec3 step_x = grid_steps_x(t);
  ivec3 step_y = grid_steps_y(t);
  const int cell = int(CellTexels);
  for (uint regions = t.regions; regions != 0u; regions &= regions - 1u) {
    TexelRect rect = covered_rect(t, region_rect(cascade, regions & (~regions + 1u)));
    if (rect_is_empty(rect)) continue;
    ivec2 cells = (rect.last - rect.first) / cell + 1;
    for (int i = int(gl_LocalInvocationIndex); i < cells.x * cells.y; i += int(CascadeThreads)) {
      ivec2 first = rect.first + ivec2(i % cells.x, i / cells.x) * cell;
      ivec2 last = min(first + cell - 1, rect.last);
      if (misses(step_x.x, step_y.x, ivec2(t.x1, t.y1), first, last) || misses(step_x.y, step_y.y, ivec2(t.x2, t.y2), first, last) ||
          misses(step_x.z, step_y.z, ivec2(t.x0, t.y0), first, last)) continue;
      draw_cell(t, cascade.side, first, last);
    }
  }
}
