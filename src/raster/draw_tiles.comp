#version 460
// A tile's list → depth: a workgroup a tile, each thread owns a column of texels, so that there are no atomics.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
layout(constant_id = 0) const bool masked = false;
#include "raster/raster_types.shared.h"
layout(local_size_x = TileThreads) in;
layout(push_constant, scalar) uniform PushBlock { PageRasterPush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "raster/draw_block.glsl"

void main() {
  uint index = group_index();
  if (index >= Appended(push.appended).v.tiles) return;
  RasterTile tile = RasterTiles(push.tiles).v[index];
  Uints pool = Uints(Frame(push.frame).v.pool);
  ivec2 own = ivec2(gl_LocalInvocationIndex % TileTexels, gl_LocalInvocationIndex / TileTexels * TileRows);
  uint at = tile.first_texel + uint(own.y) * PageSide + uint(own.x);
  uint nearest[TileRows];
  for (uint row = 0u; row < TileRows; ++row) nearest[row] = pool.v[at + row * PageSide];
  uint farthest = 0u;                       // of the column
  for (uint node = Uints(push.heads).v[tile.tile]; node != NoIndex;) {
    TileNode share = TileNodes(push.nodes).v[node];
    node = share.next;
    RasterTriangle t = RasterTriangles(push.triangles).v[share.triangle];
    ivec3 step_y = steps_y(t);
    ivec3 edges = share.edges + steps_x(t) * own.x + step_y * own.y;
    ivec3 most = edges + max(step_y, ivec3(0)) * int(TileRows - 1u);
    if (floatBitsToUint(t.z_max) <= farthest || (most.x | most.y | most.z) < 0) continue;
    float level = masked && t.batch != NoIndex ? mask_level(t) : 0.0;
    for (uint row = 0u; row < TileRows; ++row, edges += step_y) {
      if ((edges.x | edges.y | edges.z) < 0) continue;
      uint key = depth_key(t, edges, share.fractions);
      if (key > nearest[row] && !(masked && is_cut_out(t, vec3(edges) + share.fractions, level))) nearest[row] = key;
    }
    farthest = nearest[0];
    for (uint row = 1u; row < TileRows; ++row) farthest = min(farthest, nearest[row]);
  }
  for (uint row = 0u; row < TileRows; ++row) pool.v[at + row * PageSide] = nearest[row];
}
