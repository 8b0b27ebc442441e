// What the passes over cascades keep and are told.
#ifndef UMBRAGE_CASCADES_TYPES_SHARED_H
#define UMBRAGE_CASCADES_TYPES_SHARED_H
#include "cascades/cascade_table.shared.h"
#include "culling/culling_types.shared.h"

UMB_NAMESPACE_BEGIN

/// Threads of a workgroup that draws.
UMB_CONST uint CascadeThreads = 64u;
/// Texels along x that a thread scrolls or copies, and along the side of a cell whose farthest depth is kept for occlusion.
UMB_CONST uint CellTexels = 16u;
/// A box over more cells than this is taken to be seen.
UMB_CONST int MostCells = 64;
/// Triangles wider or higher than this many texels are queued and drawn by a workgroup each.
UMB_CONST int SmallTexels = 32;
/// A batch drawn into regions of a cascade.
struct CascadeItem {
  uint caster;
  uint cascade;
  uint regions;
};
UMB_ASSERT_SIZE(CascadeItem, 12);

/// Arguments of indirect dispatches, and what they are made from.
struct CascadeArguments {
  uint static_groups[3];
  uint active_groups[3];
  uint large_groups[3];
  uint statics, actives, larges;
};
UMB_ASSERT_SIZE(CascadeArguments, 48);

/// A triangle on a cascade's map: sub-texels from the map's first texel, depths above `z_base` over twice the area.
struct GridTriangle {
  int x0, y0, x1, y1, x2, y2;
  int z_base;
  float z_most;
  vec3 z;
  uint cascade;
  uint regions;
  uint target;             // first word of the map that it is drawn into
  uint batch;              // with a mask, or NoIndex
  vec3 u, v;               // of the vertices, over twice the area
};
UMB_ASSERT_SIZE(GridTriangle, 84);

struct CascadePush {         // all passes but the two below
  uint64_t table;
  uint64_t arguments;
  uint64_t moved;            // note_moved: casters, or 0: all
  uint64_t boxes;            // note_moved: of the casters now
  uint64_t casters;
  uint64_t instances;
  uint count;                // note_moved: casters
  uint step;                 // plan_draws: PlanStatics, …
};
UMB_ASSERT_SIZE(CascadePush, 56);

struct ListCascadesPush {    // list_casters
  uint64_t table;
  uint64_t arguments;
  uint64_t items;            // static ones; from `capacity` on active ones
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t order;            // caster tree
  uint64_t leaves;
  uint64_t nodes;
  uint64_t shape;
  uint64_t counters;         // FrameCounters, of walk.glsl
  uint capacity;
  uint padding;
};
UMB_ASSERT_SIZE(ListCascadesPush, 96);

struct DrawCascadesPush {    // draw_casters, draw_large
  uint64_t table;
  uint64_t arguments;
  uint64_t items;            // of the list that is drawn
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t indices;
  uint64_t boxes;            // of the casters
  uint64_t larges;           // GridTriangle
  uint large_capacity;
  uint draws_actives;        // 1: the active list, into W
};
UMB_ASSERT_SIZE(DrawCascadesPush, 80);

UMB_CONST uint PlanStatics = 0u;
UMB_CONST uint PlanActives = 1u;
UMB_CONST uint PlanLarges = 2u;

UMB_NAMESPACE_END
#endif
