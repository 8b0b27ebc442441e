#version 460
// Queued triangles → lists of the tiles they touch: BinThreads threads a triangle, each a tile at a time. A share that finds the
// lists full is drawn here.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
layout(constant_id = 0) const bool masked = false;
#include "raster/raster_types.shared.h"
layout(local_size_x = RasterThreads) in;
layout(push_constant, scalar) uniform PushBlock { PageRasterPush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "raster/draw_block.glsl"

/// True where an edge leaves the whole tile outside.
bool misses(ivec3 edges, ivec3 step_x, ivec3 step_y) {
  ivec3 most = edges + (max(step_x, ivec3(0)) + max(step_y, ivec3(0))) * int(PageSide - 1u);
  return any(lessThan(most, ivec3(0)));
}

/// No texel of first … last has a larger depth key; edges: at texel `first`. The key is linear, and 32 roundings small.
float nearest_key(RasterTriangle t, ivec3 edges, vec3 fractions, ivec2 size) {
  vec3 weights = vec3(edges) + fractions;
  float across = dot(vec3(steps_x(t)), t.z) * float(size.x);
  float down = dot(vec3(steps_y(t)), t.z) * float(size.y);
  float margin = 4e-6 * (dot(abs(weights), t.z) + dot(vec3(abs(steps_x(t))), t.z) * float(size.x) + dot(vec3(abs(steps_y(t))), t.z) * float(size.y));
  return min(t.z_max, dot(weights, t.z) + max(across, 0.0) + max(down, 0.0) + margin);
}

/// Is any of texels first … last of a page looked up?
bool any_looked_up(Pool pool, uint origin, ivec2 first, ivec2 last) {
  uint columns = bits_between(first.x, last.x + 1);
  for (int y = first.y; y <= last.y; ++y)
    if ((pool.texel_bits.v[texel_word(origin, uint(y))] & columns) != 0u) return true;
  return false;
}

void link(uint triangle, RasterTile tile, ivec3 edges, vec3 fractions, float nearest, uint node) {
  uint next = atomicExchange(Uints(push.heads).v[tile_of_texel(tile.first_texel)], node);
  TileNodes(push.nodes).v[node] = TileNode(triangle, next, edges, fractions, nearest);
  if (next == NoIndex) RasterTiles(push.tiles).v[atomicAdd(Appended(push.appended).v.tiles, 1u)] = tile;
}

void main() {
  Appended appended = Appended(push.appended);
  uint index = group_index() * (RasterThreads / BinThreads) + gl_LocalInvocationIndex / BinThreads;
  if (index >= min(appended.v.triangles, push.large_capacity)) return;
  Frame frame = Frame(push.frame);
  Pool pool = pool_of(frame);
  RasterTriangle t = RasterTriangles(push.triangles).v[index];
  MapRecord map = Maps(frame.v.maps).v[t.map];
  float near_m = Views(frame.v.views).v[map.first_view].near_m;
  ivec2 first, last;
  texel_box(t, map.resolution, first, last);
  ivec2 first_tile = first / int(PageSide);
  ivec2 tiles = last / int(PageSide) - first_tile + 1;
  bool looked_up = draws_looked_up(map);
  ivec3 step_x = steps_x(t);
  ivec3 step_y = steps_y(t);
  for (int i = int(gl_LocalInvocationIndex % BinThreads); i < tiles.x * tiles.y; i += int(BinThreads)) {
    ivec2 corner = (first_tile + ivec2(i % tiles.x, i / tiles.x)) * int(PageSide);
    ivec3 edges;
    vec3 fractions;
    start_edges(t, uvec2(corner), edges, fractions);
    if (misses(edges, step_x, step_y)) continue;
    uint origin = page_origin(pool, map, t.view, uvec2(corner));
    if (origin == NoTexel) continue;
    ivec2 seen_first = max(corner, first);
    ivec2 seen_last = min(corner + int(PageSide) - 1, last);
    ivec3 seen_edges = edges + step_x * (seen_first.x - corner.x) + step_y * (seen_first.y - corner.y);
    if (looked_up && !any_looked_up(pool, origin, seen_first % int(PageSide), seen_last % int(PageSide))) continue;
    float nearest = nearest_key(t, seen_edges, fractions, seen_last - seen_first);
    if ((push.flags & TestReceivers) != 0u && !receivers_see(pool, map, t.view, seen_first, seen_last, near_m, nearest)) continue;
    uint node = atomicAdd(appended.v.nodes, 1u);
    if (node < push.node_capacity) {
      link(index, RasterTile(origin, looked_up ? 1u : 0u), edges, fractions, nearest, node);
    } else {
      draw_block(pool, t, PageSide, origin, looked_up, seen_first, seen_last, seen_edges, fractions);
    }
  }
}
