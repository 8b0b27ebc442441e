// Push constants of the writers, and what the page rasteriser keeps between its passes.
#ifndef UMBRAGE_RASTER_TYPES_SHARED_H
#define UMBRAGE_RASTER_TYPES_SHARED_H
#include "culling/culling_types.shared.h"
#include "raster/triangle.shared.h"

UMB_NAMESPACE_BEGIN

struct CastPush {            // cast.vert, cast_layer.vert, mask.frag
  uint64_t batches;
  vec2 viewport_size;        // texels: of the atlas, or of an image
};
UMB_ASSERT_SIZE(CastPush, 16);

/// Threads that share an item of the page rasteriser.
UMB_CONST uint RasterThreads = 64u;
/// Of a workgroup of as many, those that share a queued triangle: most touch a few tiles.
UMB_CONST uint BinThreads = 8u;
/// Rows of a page that a thread of draw_tiles, which has a column, skips or draws at once.
UMB_CONST uint TileStep = 8u;
/// A triangle whose box holds more texels is queued for the tiles.
UMB_CONST uint QueuedTexels = 512u;
/// Workgroups along x of an indirect dispatch; the rest go to y.
UMB_CONST uint MaxGroupsX = 32768u;

/// A queued triangle's share of one page: edge functions at the tile's first texel, and the next share of the same tile.
struct TileNode {
  uint triangle;
  uint next;                 // or NoIndex
  ivec3 edges;
  vec3 fractions;
  float nearest;             // depth key of the share: no texel has a larger one
};
UMB_ASSERT_SIZE(TileNode, 36);

/// A tile, that is a page of PageSide, that has nodes.
struct RasterTile {
  uint first_texel;          // in the pool
  uint looked_up;            // 1: only texels are drawn that lookups of samples read
};
UMB_ASSERT_SIZE(RasterTile, 8);

/// The list of a page by its first texel: pages of full side begin at least that far apart.
UMB_FN uint tile_of_texel(uint first_texel) { return first_texel / (PageSide * PageSide); }

/// Arguments of the indirect dispatches.
struct RasterArguments {
  uint items[6];             // groups along x, y, z: opaque, masked
  uint triangles[3];
  uint tiles[3];
};
UMB_ASSERT_SIZE(RasterArguments, 48);

/// What has been appended, or would have been had there been room.
struct RasterCounts {
  uint triangles;
  uint nodes;
  uint tiles;
};
UMB_ASSERT_SIZE(RasterCounts, 12);

struct PageRasterPush {      // plan_dispatches, rasterize_triangles, bin_triangles, draw_tiles
  uint64_t frame;
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t indices;
  uint64_t items;
  uint64_t counts;
  uint64_t arguments;
  uint64_t appended;         // RasterCounts
  uint64_t triangles;        // RasterTriangle
  uint64_t nodes;            // TileNode
  uint64_t heads;            // first node of each tile, or NoIndex
  uint64_t tiles;            // RasterTile
  uint64_t counters;         // plan_dispatches: FrameCounters, or 0
  uint item_capacity;        // masked items begin there
  uint large_capacity;
  uint node_capacity;
  uint flags;                // plan_dispatches: PlanItems, …; others: TestReceivers | TestTexels
};
UMB_ASSERT_SIZE(PageRasterPush, 128);

struct CountNeededPush {     // count_needed; names as in PageRasterPush
  uint64_t frame;
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t indices;
  uint64_t items;
  uint64_t counts;
  uint64_t texels;           // a bit each: what was looked up
  uint64_t count;            // the answer
  uint item_capacity;
  uint padding;
};
UMB_ASSERT_SIZE(CountNeededPush, 80);

/// Triangles, and tiles of large ones, are drawn only where and in front of what receives (the receiver grid).
UMB_CONST uint TestReceivers = 1u;
/// Only texels are drawn that lookups of samples read (FrameRecord::texel_bits).
UMB_CONST uint TestTexels = 2u;
UMB_CONST uint PlanItems = 0u;
UMB_CONST uint PlanTriangles = 1u;
UMB_CONST uint PlanTiles = 2u;

// --- By fragments -----------------------------------------------------------------------------------------------------

/// Items whose draws are listed at once.
UMB_CONST uint DrawWindow = 16384u;

/// A batch drawn into one view of a map, as instance attributes of cast_page.vert.
struct PageInstance {
  vec4 row0, row1, row2;     // relative to the view's origin from mesh space
  vec4 x_row;                // of the view; resolution
  vec4 y_row;                // of the view; layer, where maps lie in images
  vec4 z_row, w_row;         // of the view, with their offsets
  uint64_t positions;
  uint position_stride;      // in floats
  uint batch;
  uint64_t uvs;
  uint uv_stride;
  uint first_word;           // of the view's page bits
  vec4 plane;                // of the view: x_offset, y_offset, grid
};
UMB_ASSERT_SIZE(PageInstance, 160);

struct ListDrawsPush {       // list_page_draws
  uint64_t frame;
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t items;
  uint64_t counts;
  uint64_t drawn;            // PageInstance, six for each item
  uint64_t commands;
  uint64_t draw_count;
  uint masked;
  uint first;                // item of the window
  uint window;               // items
  uint item_capacity;
};
UMB_ASSERT_SIZE(ListDrawsPush, 88);

struct CastPagePush {        // cast_page.vert, write_page.frag, write_texel.glsl
  uint64_t frame;
  uint64_t batches;
  vec2 viewport_size;        // texels
  uint image;                // write_texel.glsl
  uint pad;
};
UMB_ASSERT_SIZE(CastPagePush, 32);

// --- Into images ------------------------------------------------------------------------------------------------------

/// VkDrawIndirectCommand.
struct ClearCommand {
  uint vertex_count;
  uint instance_count;
  uint first_vertex;
  uint first_instance;
};
UMB_ASSERT_SIZE(ClearCommand, 16);

struct ListLayersPush {      // list_layer_draws; of list_layer_clears what is marked *
  uint64_t frame;            // *
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t items;
  uint64_t counts_of_items;
  uint64_t drawn;            // PageInstance, six for each item
  uint64_t commands;         // * ClearCommand an image; draws: item_capacity DrawCommands for each list of counts
  uint64_t counts;           // * commands of each image; draws: opaque ones of each image, then masked ones
  uint64_t images;           // * MapImage
  uint64_t layers;           // * layer | resolution << 16 of the layers to clear, image by image
  uint item_capacity;        // masked items begin there
  uint image_count;
};
UMB_ASSERT_SIZE(ListLayersPush, 96);

struct ClearWordsPush {      // clear_words.comp
  uint64_t frame;
};
UMB_ASSERT_SIZE(ClearWordsPush, 8);

struct ClearLayersPush {     // clear_layers.vert
  uint64_t layers;
  float image_side;
  uint pad;
};
UMB_ASSERT_SIZE(ClearLayersPush, 16);

UMB_NAMESPACE_END
#endif
