#version 460
// A tile's list → depth: a workgroup a tile, each thread owns a column of texels, so that there are no atomics.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_control_flow_attributes : require
layout(constant_id = 0) const bool masked = false;
#include "raster/raster_types.shared.h"
layout(local_size_x = PageSide) in;
layout(push_constant, scalar) uniform PushBlock { PageRasterPush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "raster/draw_block.glsl"

uint nearest[PageSide];   // of the thread's column; unrolled loops keep it in registers

/// Nearer than every triangle: of texels that nobody looks up.
const uint Closed = 0x7f800000u;

/// Of a page's column the rows that are drawn, a bit each.
uint wanted_rows(Pool pool, RasterTile tile, uint column) {
  if (tile.looked_up == 0u) return 0xffffffffu;
  uint rows = 0u;
  for (uint row = 0u; row < PageSide; ++row) rows |= (pool.texel_bits.v[texel_word(tile.first_texel, row)] >> column & 1u) << row;
  return rows;
}

/// The part of a thread's column that a triangle covers. edges: at its first texel.
void draw_column(RasterTriangle t, ivec3 edges, vec3 fractions, uint wanted) {
  ivec3 step_y = steps_y(t);
  ivec3 ahead = max(step_y, ivec3(0)) * int(TileStep - 1u);
  float level = masked && t.batch != NoIndex ? mask_level(t) : 0.0;
  [[unroll]] for (uint first = 0u; first < PageSide; first += TileStep) {
    ivec3 most = edges + ahead;
    if ((most.x | most.y | most.z) >= 0 && (wanted >> first & ((1u << TileStep) - 1u)) != 0u) {
      ivec3 at = edges;
      [[unroll]] for (uint row = first; row < first + TileStep; ++row) {
        uint key = (at.x | at.y | at.z) >= 0 ? depth_key(t, at, fractions) : 0u;
        if (masked && key > nearest[row] && is_cut_out(t, vec3(at) + fractions, level)) key = 0u;
        nearest[row] = max(nearest[row], key);
        at += step_y;
      }
    }
    edges += step_y * int(TileStep);
  }
}

void main() {
  uint index = group_index();
  if (index >= Appended(push.appended).v.tiles) return;
  RasterTile tile = RasterTiles(push.tiles).v[index];
  Pool pool = pool_of(Frame(push.frame));
  int column = int(gl_LocalInvocationIndex);
  uint at = tile.first_texel + uint(column);
  uint wanted = wanted_rows(pool, tile, uint(column));
  [[unroll]] for (uint row = 0u; row < PageSide; ++row)
    nearest[row] = (wanted >> row & 1u) != 0u ? pool.texels.v[at + row * PageSide] : Closed;
  uint farthest = 0u;     // of the column
  for (uint node = Uints(push.heads).v[tile_of_texel(tile.first_texel)]; node != NoIndex;) {
    TileNode share = TileNodes(push.nodes).v[node];
    node = share.next;
    if (share.nearest <= uintBitsToFloat(farthest)) continue;
    RasterTriangle t = RasterTriangles(push.triangles).v[share.triangle];
    draw_column(t, share.edges + steps_x(t) * column, share.fractions, wanted);
    farthest = nearest[0];
    [[unroll]] for (uint row = 1u; row < PageSide; ++row) farthest = min(farthest, nearest[row]);
  }
  [[unroll]] for (uint row = 0u; row < PageSide; ++row)
    if ((wanted >> row & 1u) != 0u) pool.texels.v[at + row * PageSide] = nearest[row];
}
