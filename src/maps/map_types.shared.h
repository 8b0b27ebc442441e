// Shadow maps: a light at one resolution, its pages, and what is known of the receivers that look at it.
#ifndef UMBRAGE_MAPS_TYPES_SHARED_H
#define UMBRAGE_MAPS_TYPES_SHARED_H
#include "clusters/cluster_types.shared.h"
#include "core/rounding.shared.h"
#include "views/shadow_view.shared.h"

UMB_NAMESPACE_BEGIN

/// Texels along a page's side: a row has as many as a word has bits. Maps below it are one page of their own side a view.
UMB_CONST uint PageSide = 32u;
/// Views of spots reach beyond the cone by the filter of a map of so many texels a side.
UMB_CONST uint GuardedSide = 64u;
/// O13: hardware-sparse maps below so many texels a side lie in ordinary images.
UMB_CONST uint LeastSparseSide = 64u;
/// Places in the pool are counted in units of so many texels.
UMB_CONST uint PoolUnit = 16u;
/// Resolutions: powers of two 2^MinLevel … 2^MaxLevel (levels), or any multiple of the page (exact).
UMB_CONST uint MinLevel = 2u;
UMB_CONST uint MaxLevel = 13u;
UMB_CONST uint MaxMapsPerLight = 16u;
/// O7: tiles along a projection map's side.
UMB_CONST uint ProjectionSide = 32u;

/// Points that a map answers for: those that some depth buffer shows; with a light's whole map those that none does, wherever they
/// are or where the host says (CameraDesc::other_receivers_ws).
UMB_CONST uint ReceiversInSight = 0u;
UMB_CONST uint ReceiversAnywhere = 1u;   // every page is marked and nothing is known of the receivers
UMB_CONST uint ReceiversInBoxes = 2u;

/// A light's views at one resolution. Views are numbered first_view … first_view + view_count-1 among the shadow views.
struct MapRecord {
  uint light;              // slot
  uint first_view;
  uint view_count;         // 6 or 1
  uint kind;               // ViewsCube, ViewsSpot, ViewsOrtho
  uint resolution;         // texels along a view's side
  uint pages;              // along a view's side
  uint words;              // page words a view: bit y * pages + x, from the lowest
  uint first_word;         // of the first view
  uint first_receiver;     // of the first view in projection maps and depth grids
  uint faces;              // bit v: view v has receivers (the map's cube-face mask)
  uint receivers;          // ReceiversInSight, …
  uint light_mask;
  uint image;              // stores of images: which, and the layer of the first view; NoIndex: none yet
  uint layer;
  uint asked;              // resolution asked for; more than `resolution` where images are short
  uint triangles;          // (triangle, view) pairs drawn into it
};
UMB_ASSERT_SIZE(MapRecord, 64);

/// Images that a store keeps maps in, at most.
UMB_CONST uint MaxMapImages = 24u;

/// An array of square depth images. A map takes as many layers, one after the other, as it has views.
struct MapImage {
  uint side;               // texels
  uint layers;
  uint first_layer;        // among the layers of all images
};
UMB_ASSERT_SIZE(MapImage, 12);

/// The maps of a light: first … first + count-1, finest first; `whole` is the last of them, for points that no depth buffer
/// shows, or NoIndex.
struct LightMaps {
  uint first;
  uint count;
  uint whole;
  uint shift;              // halvings of what was asked for, because the budget is short
  uint kept;               // bit p: a map begins at place p (map_of_place)
};
UMB_ASSERT_SIZE(LightMaps, 20);

/// In lookups, instead of a map's number: the light's whole map.
UMB_CONST uint WholeMap = 0xfffffffeu;

UMB_FN uint pages_of(uint resolution) { return (resolution + PageSide - 1u) / PageSide; }
UMB_FN uint page_side_of(uint resolution) { return min(resolution, PageSide); }
UMB_FN uint page_words_of(uint pages) { return (pages * pages + 31u) / 32u; }
/// Pool units of one page of a map.
UMB_FN uint page_units_of(uint resolution) {
  uint side = page_side_of(resolution);
  return side * side / PoolUnit;
}

/// Of a grid over a view, the cells that texels first … last touch.
struct CellRect {
  ivec2 first, last;
};
UMB_ASSERT_SIZE(CellRect, 16);

UMB_FN CellRect cells_of_texels(ivec2 first, ivec2 last, uint side, uint resolution) {
  float scale = float(side) / float(resolution);
  // Where a texel lies in two cells, rounding must not lose one.
  float slack = (resolution & (resolution - 1u)) == 0u ? 0.0f : 1e-3f;
  CellRect cells;
  cells.first.x = int(floor_to_uint(float(first.x) * scale - slack, side - 1u));
  cells.first.y = int(floor_to_uint(float(first.y) * scale - slack, side - 1u));
  cells.last.x = int(floor_to_uint((float(last.x) + 0.999f) * scale + slack, side - 1u));
  cells.last.y = int(floor_to_uint((float(last.y) + 0.999f) * scale + slack, side - 1u));
  return cells;
}

/// Where the page of a texel is found: a word of page bits and the bit in it.
struct PagePlace {
  uint word;
  uint bit;
};
UMB_ASSERT_SIZE(PagePlace, 8);

UMB_FN PagePlace page_place(MapRecord map, uint view, uvec2 texel) {
  uint page = (texel.y / PageSide) * map.pages + texel.x / PageSide;
  PagePlace place;
  place.word = map.first_word + view * map.words + page / 32u;
  place.bit = page % 32u;
  return place;
}

/// First texel in the pool of a page whose bit is set. bits: of the word; first: the word's place in units.
UMB_FN uint page_texel(uint bits, uint first, uint bit, uint resolution) {
  return (first + uint(bitCount(bits & ((1u << bit) - 1u))) * page_units_of(resolution)) * PoolUnit;
}

/// The word of texel_bits that has a row of a page of PageSide: its rows are fewer than its units. first: of the page, in the pool.
UMB_FN uint texel_word(uint first, uint row) { return first / PoolUnit + row; }

/// Is it worth while to mark texels one by one? Not where there are more than half as many lookups as texels: most are read then,
/// and are drawn in less time than it takes to mark them. tiles: of all cameras; lookups: of every pixel as many as clusters have
/// lights on average.
UMB_FN bool marks_texels(FrameCounters counters, uint tiles) {
  float lookups = float(tiles * TileSide * TileSide) * (float(counters.pairs_found) / float(max(counters.clusters_found, 1u)));
  return 2.0f * lookups <= float(counters.pool_units) * float(PoolUnit);
}

/// A texel within its page.
UMB_FN uint texel_in_page(uvec2 texel, uint resolution) {
  return (texel.y % PageSide) * page_side_of(resolution) + texel.x % PageSide;
}

/// Fixed cubes: the tile of the atlas that a view has for its own.
UMB_FN uvec2 atlas_tile(uint view, uint columns, uint tile_resolution) {
  return uvec2(view % columns, view / columns) * tile_resolution;
}

UMB_NAMESPACE_END
#endif
