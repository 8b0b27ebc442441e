// Where shadow texels live: tiles in the depth atlas of the fixed-cubes store.
#ifndef UMBRAGE_STORE_TYPES_SHARED_H
#define UMBRAGE_STORE_TYPES_SHARED_H
#include "clusters/cluster_types.shared.h"
#include "views/shadow_view.shared.h"

UMB_NAMESPACE_BEGIN

struct BuildViewsPush {      // build_views
  uint64_t frame;
  uint64_t lights;
  uint64_t used;             // one word a light slot
  uint64_t counters;
  uint64_t views;
  uint64_t scene_bounds;     // ordered_bits
  uint light_slots;
  uint all_lights;           // draw maps whatever the clusters say
};
UMB_ASSERT_SIZE(BuildViewsPush, 56);

/// The tile of the atlas that a view has for its own.
UMB_FN uvec2 atlas_tile(uint view, uint columns, uint tile_resolution) {
  return uvec2(view % columns, view / columns) * tile_resolution;
}

UMB_NAMESPACE_END
#endif
