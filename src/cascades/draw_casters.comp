#version 460
// Listed casters → depth: a workgroup an item, a thread a triangle. Small triangles are drawn at once, others are queued; what
// finds the queue full is drawn here all the same.
#extension GL_GOOGLE_include_directive : require
layout(constant_id = 0) const bool masked = false;
#include "cascades/cascade_types.shared.h"
layout(local_size_x = CascadeThreads) in;
layout(push_constant, scalar) uniform PushBlock { DrawCascadesPush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "cascades/draw_grid.glsl"
#include "raster/triangle.glsl"

CascadeItem item;
CascadeRecord cascade;
CascadeState state;
uint target;
uint mask_batch;   // NoIndex: opaque
TexelRect reach;   // around the regions

/// True if nothing that the caster covers could be nearer than the static casters drawn before (C4).
bool is_occluded(GridBox box, TexelRect within) {
  ivec2 first = max(ivec2(box.lo.x, box.lo.y) - ivec2(cascade.origin.x, cascade.origin.y), within.first);
  ivec2 last = min(ivec2(box.hi.x, box.hi.y) - ivec2(cascade.origin.x, cascade.origin.y), within.last);
  if (first.x > last.x || first.y > last.y) return true;
  first /= int(CellTexels);
  last /= int(CellTexels);
  if ((last.x - first.x + 1) * (last.y - first.y + 1) > MostCells) return false;
  Table table = Table(push.table);
  uint cells = cell_words(table, item.cascade);
  int nearest = max(box.lo.z - cascade.origin.z, 0);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x)
      if (nearest < int(Uints(table.v.farthest).v[cells + uint(y) * (cascade.side / CellTexels) + uint(x)])) return false;
  return true;
}

/// Regions in which something may be seen. Cells of a map that was kept or cleared say nothing.
uint seen_regions() {
  if (push.draws_actives == 0u && state.action != MapIsScrolled) return item.regions;
  GridBox box = grid_box(cascade, Boxes(push.boxes).v[item.caster]);
  uint seen = 0u;
  for (uint regions = item.regions; regions != 0u; regions &= regions - 1u) {
    uint region = regions & (~regions + 1u);
    if (!is_occluded(box, region_rect(cascade, region))) seen |= region;
  }
  return seen;
}

TexelRect rect_around(uint regions) {
  TexelRect around = TexelRect(ivec2(int(cascade.side)), ivec2(-1));
  for (; regions != 0u; regions &= regions - 1u) {
    TexelRect rect = region_rect(cascade, regions & (~regions + 1u));
    around.first = min(around.first, rect.first);
    around.last = max(around.last, rect.last);
  }
  return around;
}

ivec2 sub_texels(vec3 grid) {
  vec2 whole = floor(grid.xy);
  vec2 part = (grid.xy - whole) * float(SubTexels);
  return (ivec2(round_to_int(whole.x), round_to_int(whole.y)) - ivec2(cascade.origin.x, cascade.origin.y)) * SubTexels +
         ivec2(round_to_int(part.x), round_to_int(part.y));
}

void draw_cells(GridTriangle t, TexelRect rect) {
  const int cell = int(CellTexels);
  for (ivec2 first = rect.first; first.y <= rect.last.y;) {
    draw_cell(t, cascade.side, first, min(first + cell - 1, rect.last));
    first.x += cell;
    if (first.x > rect.last.x) first = ivec2(rect.first.x, first.y + cell);
  }
}

/// a, b, c: grid positions within MostTexels.
void draw_triangle(vec3 a, vec3 b, vec3 c, vec2 uv[3]) {
  ivec2 p0 = sub_texels(a);
  ivec2 p1 = sub_texels(b);
  ivec2 p2 = sub_texels(c);
  ivec2 lo = min(p0, min(p1, p2));
  ivec2 hi = max(p0, max(p1, p2));
  if (first_texel(lo.x) > min(last_texel(hi.x), reach.last.x) || first_texel(lo.y) > min(last_texel(hi.y), reach.last.y) ||
      last_texel(hi.x) < reach.first.x || last_texel(hi.y) < reach.first.y) return;
  ivec2 ab = p1 - p0;
  ivec2 ac = p2 - p0;
  bool is_small = max(hi.x - lo.x, hi.y - lo.y) <= SmallTexels * SubTexels;
  float area;
  if (is_small) area = float(ab.x * ac.y - ab.y * ac.x);
  else area = float(int64_t(ab.x) * int64_t(ac.y) - int64_t(ab.y) * int64_t(ac.x));
  if (area == 0.0) return;
  bool turns = area < 0.0;
  GridTriangle t;
  t.x0 = p0.x, t.y0 = p0.y;
  t.x1 = turns ? p2.x : p1.x, t.y1 = turns ? p2.y : p1.y;
  t.x2 = turns ? p1.x : p2.x, t.y2 = turns ? p1.y : p2.y;
  vec3 z = clamp(turns ? vec3(a.z, c.z, b.z) : vec3(a.z, b.z, c.z), vec3(-MostUnits), vec3(MostUnits));
  float base = floor(min(z.x, min(z.y, z.z)));
  t.z_base = round_to_int(base) - cascade.origin.z;
  if (t.z_base > FarDepth) return;
  precise vec3 above = z - base;
  t.z_most = max(above.x, max(above.y, above.z));
  precise float scale = 1.0 / abs(area);
  precise vec3 share = above * scale;
  t.z = share;
  // Of a caster that comes up in the kept part, few triangles do.
  int absolute = t.z_base + cascade.origin.z;
  t.cascade = item.cascade;
  t.regions = item.regions;
  if (!appears_in_depth(cascade, absolute, absolute + round_to_int(ceil(t.z_most)))) t.regions &= ~RegionKept;
  t.target = target;
  t.batch = masked ? mask_batch : NoIndex;
  t.u = vec3(uv[0].x, turns ? uv[2].x : uv[1].x, turns ? uv[1].x : uv[2].x) * scale;
  t.v = vec3(uv[0].y, turns ? uv[2].y : uv[1].y, turns ? uv[1].y : uv[2].y) * scale;
  bool is_queued = false;
  for (uint regions = t.regions; regions != 0u && !is_queued; regions &= regions - 1u) {
    TexelRect rect = covered_rect(t, region_rect(cascade, regions & (~regions + 1u)));
    if (rect_is_empty(rect)) continue;
    if (is_small) {
      draw_small(t, cascade.side, rect.first, rect.last);
      continue;
    }
    uint place = atomicAdd(Arguments(push.arguments).v.larges, 1u);
    is_queued = place < push.large_capacity;
    t.regions = regions;
    if (is_queued) GridTriangles(push.larges).v[place] = t;
    else draw_cells(t, rect);
  }
}

/// Cut to the coordinates that integers hold. The planes do not depend on where the map lies.
void draw_far(vec3 grid[3], vec2 uv[3]) {
  ClipVertex corner[9];
  for (uint i = 0u; i < 3u; ++i) {
    float z = clamp(grid[i].z, -MostUnits, MostUnits) / (2.0 * MostUnits) + 0.5;
    corner[i] = ClipVertex(vec4(grid[i].x / MostTexels, grid[i].y / MostTexels, z, 1.0), uv[i]);
  }
  uint count = clip_triangle(corner, 1.0);
  for (uint i = 0u; i < count; ++i)
    corner[i].position.xyz = vec3(clamp(corner[i].position.xy, -1.0, 1.0) * MostTexels, (corner[i].position.z - 0.5) * (2.0 * MostUnits));
  for (uint i = 2u; i < count; ++i) {
    vec2 fan[3] = vec2[](corner[0].uv, corner[i - 1u].uv, corner[i].uv);
    draw_triangle(corner[0].position.xyz, corner[i - 1u].position.xyz, corner[i].position.xyz, fan);
  }
}

void draw_batch(InstanceRecord instance, BatchRecord batch) {
  for (uint triangle = gl_LocalInvocationIndex; triangle < batch.triangle_count; triangle += CascadeThreads) {
    vec3 grid[3];
    vec2 uv[3];
    bool is_far = false;
    for (uint i = 0u; i < 3u; ++i) {
      uint vertex = Uints(push.indices).v[batch.first_index + 3u * triangle + i];
      Floats position = Floats(instance.positions);
      uint at = vertex * instance.position_stride;
      vec4 p = vec4(position.v[at], position.v[at + 1u], position.v[at + 2u], 1.0);
      precise vec3 world = vec3(dot(instance.row0, p), dot(instance.row1, p), dot(instance.row2, p));
      grid[i] = grid_position(cascade, world);
      is_far = is_far || !(max(abs(grid[i].x), abs(grid[i].y)) <= MostTexels);
      uv[i] = vec2(0.0);
      uint uv_at = vertex * instance.uv_stride;
      if (masked && mask_batch != NoIndex) uv[i] = vec2(Floats(instance.uvs).v[uv_at], Floats(instance.uvs).v[uv_at + 1u]);
    }
    if (is_far) draw_far(grid, uv);
    else draw_triangle(grid[0], grid[1], grid[2], uv);
  }
}

void main() {
  uint index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  Arguments arguments = Arguments(push.arguments);
  if (index >= (push.draws_actives != 0u ? arguments.v.actives : arguments.v.statics)) return;
  item = CascadeItems(push.items).v[index];
  Table table = Table(push.table);
  cascade = table.v.records[item.cascade];
  state = States(table.v.states).v[item.cascade];
  target = map_words(table, item.cascade, push.draws_actives != 0u ? 2u : state.front);
  item.regions = seen_regions();
  States states = States(table.v.states);
  CasterRecord caster = Casters(push.casters).v[item.caster];
  BatchRecord batch = Batches(push.batches).v[caster.batch];
  if (gl_LocalInvocationIndex == 0u) {
    if (item.regions == 0u) atomicAdd(states.v[item.cascade].occluded, 1u);
    else if (push.draws_actives != 0u) atomicAdd(states.v[item.cascade].active_triangles, batch.triangle_count);
    else atomicAdd(states.v[item.cascade].static_triangles, batch.triangle_count);
  }
  if (item.regions == 0u) return;
  mask_batch = batch.mask != NoIndex ? caster.batch : NoIndex;
  reach = rect_around(item.regions);
  draw_batch(Instances(push.instances).v[caster.instance], batch);
}
