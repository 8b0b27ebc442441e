// Push constants of the writers.
#ifndef UMBRAGE_RASTER_TYPES_SHARED_H
#define UMBRAGE_RASTER_TYPES_SHARED_H
#include "culling/culling_types.shared.h"

UMB_NAMESPACE_BEGIN

struct CastPush {            // cast.vert, mask.frag
  uint64_t batches;
  vec2 area;                 // texels that the viewport covers: the atlas, or one tile
};
UMB_ASSERT_SIZE(CastPush, 16);

UMB_NAMESPACE_END
#endif
