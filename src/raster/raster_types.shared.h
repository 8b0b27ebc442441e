// Push constants of the writers.
#ifndef UMBRAGE_RASTER_TYPES_SHARED_H
#define UMBRAGE_RASTER_TYPES_SHARED_H
#include "culling/culling_types.shared.h"

UMB_NAMESPACE_BEGIN

struct CastPush {            // cast.vert, mask.frag
  uint64_t pairs;            // multi_draw
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t lights;
  uint64_t views;
  vec2 atlas_size;           // texels
  uint view;                 // traditional: the view that is drawn
  uint tile_resolution;      // traditional: texels along the tile's side
};
UMB_ASSERT_SIZE(CastPush, 64);

UMB_NAMESPACE_END
#endif
