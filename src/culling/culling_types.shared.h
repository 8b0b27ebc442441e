// (batch, view) pairs and what draws are made of them.
#ifndef UMBRAGE_CULLING_TYPES_SHARED_H
#define UMBRAGE_CULLING_TYPES_SHARED_H
#include "maps/map_types.shared.h"

UMB_NAMESPACE_BEGIN

/// Threads that share a traversal; each owns the lowest nodes whose number has its remainder. A multiple of TreeWidth.
UMB_CONST uint TraverseThreads = 64u;

/// A batch drawn into one view: everything that is the same for its vertices, as instance attributes of cast.vert. (Loads by
/// address would be repeated for every vertex.)
struct CasterInstance {
  vec4 row_x, row_y, row_z, row_w;   // the view's clip position of mesh space
  float tile_texels;                 // the view's side; where it begins in the atlas
  float tile_x, tile_y;
  uint view;
  uint64_t positions;                // address
  uint position_stride;              // in floats
  uint batch;
  uint64_t uvs;
  uint uv_stride;
  uint caster;
};
UMB_ASSERT_SIZE(CasterInstance, 112);

/// A batch drawn into some views of a map: the work item of the page pool's writers.
struct CasterItem {
  uint caster;
  uint map;
  uint faces;                        // bit v: into view v of the map
};
UMB_ASSERT_SIZE(CasterItem, 12);

/// VkDrawIndexedIndirectCommand.
struct DrawCommand {
  uint index_count;
  uint instance_count;
  uint first_index;
  int vertex_offset;
  uint first_instance;
};
UMB_ASSERT_SIZE(DrawCommand, 20);

/// How many commands each list has: opaque, masked.
struct DrawCounts {
  uint opaque;
  uint masked;
};
UMB_ASSERT_SIZE(DrawCounts, 8);

struct TraversePush {        // count_casters, write_casters, write_view_casters
  uint64_t lights;
  uint64_t views;
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t order;            // caster tree
  uint64_t leaves;
  uint64_t nodes;
  uint64_t shape;
  uint64_t counts;           // per light and thread: instances, then the first one
  uint64_t counters;
  uint64_t drawn;            // CasterInstance
  uint64_t commands;         // opaque ones, then masked ones
  uint64_t draw_counts;
  uint64_t used;             // write_casters marks lights that are beyond the last round
  uint window_first;         // write_casters: first instance of the round; write_view_casters: first view
  uint window_size;          // write_casters: instances a round; write_view_casters: room for commands a list
};
UMB_ASSERT_SIZE(TraversePush, 128);

struct ItemPush {            // count_items, write_items
  uint64_t frame;            // FrameRecord: lights, views, maps, what is known of receivers, counters
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t order;            // caster tree
  uint64_t leaves;
  uint64_t nodes;
  uint64_t shape;
  uint64_t counts;           // per map and thread: opaque and masked items of the map's threads before it
  uint64_t totals;           // opaque items per map, then masked ones; exclusive sums once they are scanned
  uint64_t counters;
  uint64_t items;            // CasterItem: opaque ones, and from window_size on masked ones
  uint64_t draw_counts;
  uint64_t used;             // write_items marks lights that are beyond the last round
  uint window_first;         // first item of the round
  uint window_size;
};
UMB_ASSERT_SIZE(ItemPush, 120);

/// What the lowest nodes of the tree are tested against on the way to the batches of a map. The items are the same with each.
UMB_CONST uint NodesByLight = 0u;
UMB_CONST uint NodesByView = 1u;                   // and against the views that have receivers
UMB_CONST uint NodesByReceivers = 2u;              // as batches are

/// Number of the n-th set bit (O12: the layer from instance index and face mask).
UMB_FN uint nth_set_bit(uint mask, uint n) {
  for (uint i = 0u; i < n; ++i) mask &= mask - 1u;
  return uint(findLSB(mask));
}

/// view_clip_position as a row over mesh space.
UMB_FN vec4 clip_row(InstanceRecord instance, vec3 row, vec3 origin, float offset) {
  vec3 translation = vec3(instance.row0.w, instance.row1.w, instance.row2.w) - origin;
  return vec4(row.x * instance.row0.x + row.y * instance.row1.x + row.z * instance.row2.x,
              row.x * instance.row0.y + row.y * instance.row1.y + row.z * instance.row2.y,
              row.x * instance.row0.z + row.y * instance.row1.z + row.z * instance.row2.z, dot(row, translation) + offset);
}

UMB_FN CasterInstance caster_instance(InstanceRecord instance, ShadowView view, uint view_index, uint caster, uint batch) {
  CasterInstance drawn;
  drawn.row_x = clip_row(instance, view.x_row, view.origin, 0.0f);
  drawn.row_y = clip_row(instance, view.y_row, view.origin, 0.0f);
  drawn.row_z = clip_row(instance, view.z_row, view.origin, view.z_offset);
  drawn.row_w = clip_row(instance, view.w_row, view.origin, view.w_offset);
  drawn.tile_texels = float(view.resolution);
  drawn.tile_x = float(view.atlas_x);
  drawn.tile_y = float(view.atlas_y);
  drawn.view = view_index;
  drawn.positions = instance.positions;
  drawn.position_stride = instance.position_stride;
  drawn.uvs = instance.uvs;
  drawn.uv_stride = instance.uv_stride;
  drawn.batch = batch;
  drawn.caster = caster;
  return drawn;
}

UMB_NAMESPACE_END
#endif
