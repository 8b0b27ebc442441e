// Does a batch cast on anything that is seen? Its box against what is known of the receivers of a map (O6, O7, O22).
#ifndef UMBRAGE_CULLING_RECEIVERS_SHARED_H
#define UMBRAGE_CULLING_RECEIVERS_SHARED_H
#ifndef __cplusplus
#include "gpu/buffers.glsl"
#endif
#include "maps/map_types.shared.h"

UMB_NAMESPACE_BEGIN

/// umbrage::CasterCulling; each drops what the one before drops.
UMB_CONST uint CullLightVolume = 0u;
UMB_CONST uint CullViewMask = 1u;
UMB_CONST uint CullProjectionMap = 2u;
UMB_CONST uint CullProjectionMapDepth = 3u;
UMB_CONST uint CullReceiverGrid = 4u;

/// Vertices are projected with other roundings than the box around them: relative to the distance from the light.
UMB_CONST float BoxSlack = 1e-5f;
/// Likewise for nodes; more, so that a node is never dropped that has a leaf which is not.
UMB_CONST float NodeSlack = 3e-5f;
/// Of depths: relative, and in metres or (ortho) parts of the range.
UMB_CONST float DepthSlack = 1e-5f;
UMB_CONST float LeastDepth = 1e-6f;

/// What is known of the receivers of a map's views. Addresses are those of the map's first view.
struct MapReceivers {
  uint64_t tiles;          // ProjectionSide words a view: bit x of word y
  uint64_t depths;         // grid² words a view, row by row: bits of the farthest receiver depth, 0 without receivers
  uint grid;               // 1, 2, 4 … ProjectionSide
  float farthest[6];       // of each view; for CullProjectionMapDepth only
};

#ifdef __cplusplus
inline uint word_at(uint64_t address, uint i) { return reinterpret_cast<const uint*>(address)[i]; }
#else
uint word_at(uint64_t address, uint i) { return Uints(address).v[i]; }
#endif

/// The receivers of a map, from the tables of all maps.
UMB_FN MapReceivers receivers_of(MapRecord map, uint64_t projection, uint64_t receiver_depth, uint grid, uint mode) {
  MapReceivers receivers;
  receivers.tiles = projection + uint64_t(map.first_receiver) * ProjectionSide * 4u;
  receivers.depths = receiver_depth + uint64_t(map.first_receiver) * grid * grid * 4u;
  receivers.grid = grid;
  for (uint view = 0u; view < 6u; ++view) {
    float farthest = 0.0f;
    if (mode == CullProjectionMapDepth && map.receivers != ReceiversAnywhere && view < map.view_count) {
      for (uint i = 0u; i < grid * grid; ++i) farthest = max(farthest, uintBitsToFloat(word_at(receivers.depths, view * grid * grid + i)));
    }
    receivers.farthest[view] = farthest;
  }
  return receivers;
}

/// A box with slack (BoxSlack, NodeSlack) on every side.
UMB_FN Box with_slack(Box box, vec3 origin, float slack) {
  vec3 distances = max(abs(box.lo - origin), abs(box.hi - origin));
  vec3 by = vec3(max(distances.x, max(distances.y, distances.z)) * slack);
  Box grown;
  grown.lo = box.lo - by;
  grown.hi = box.hi + by;
  return grown;
}

/// Bit v: view v of the map sees the box. first: the map's first view; all views of a cube have its origin.
UMB_FN uint views_seeing(MapRecord map, ShadowView first, Box box) {
  if (map.kind == ViewsCube) return face_mask(box.lo - first.origin, box.hi - first.origin);
  ViewFootprint seen;
  return project_box_to_view(first, map.kind, 0u, box.lo, box.hi, seen) ? 1u : 0u;
}

/// Whether all of a box lies behind a receiver.
UMB_FN bool is_behind(ViewFootprint seen, float farthest_receiver) {
  return seen.box.lo.z > farthest_receiver * (1.0f + DepthSlack) + LeastDepth;
}

/// Whether what a view sees of a box may cast on one of the view's receivers.
UMB_FN bool meets_receivers(ViewFootprint seen, MapReceivers receivers, uint view, uint mode) {
  if (mode == CullProjectionMapDepth && is_behind(seen, receivers.farthest[view])) return false;
  TileRect tiles = tile_rect(seen.rect, ProjectionSide);
  for (uint y = tiles.begin.y; y < tiles.end.y; ++y) {
    uint row = word_at(receivers.tiles, view * ProjectionSide + y);
    if (row == 0u) continue;
    uvec2 span = footprint_row(seen, y, ProjectionSide);
    uint both = row & tile_span_mask(span.x, span.y).x;
    if (mode != CullReceiverGrid) {
      if (both != 0u) return true;
      continue;
    }
    uint cell_tiles = ProjectionSide / receivers.grid;
    uint first_cell = (view * receivers.grid + y / cell_tiles) * receivers.grid;
    while (both != 0u) {
      uint cell = uint(findLSB(both)) / cell_tiles;
      if (!is_behind(seen, uintBitsToFloat(word_at(receivers.depths, first_cell + cell)))) return true;
      both &= ~tile_span_mask(cell * cell_tiles, (cell + 1u) * cell_tiles).x;
    }
  }
  return false;
}

/// Views of a map, one bit each, into which a batch is drawn. box: with_slack, and met by the light.
UMB_FN uint faces_to_draw(MapRecord map, ShadowView first, MapReceivers receivers, Box box, uint mode) {
  if (mode == CullLightVolume) return (1u << map.view_count) - 1u;
  uint seeing = views_seeing(map, first, box);
  if (map.receivers == ReceiversAnywhere) return seeing;
  seeing &= map.faces;
  if (mode == CullViewMask) return seeing;
  uint faces = 0u;
  for (uint left = seeing; left != 0u; left &= left - 1u) {
    uint face = uint(findLSB(left));
    ViewFootprint seen;
    if (!project_box_to_view(first, map.kind, face, box.lo, box.hi, seen)) continue;
    if (meets_receivers(seen, receivers, face, mode)) faces |= 1u << face;
  }
  return faces;
}

UMB_NAMESPACE_END
#endif
