// Push constants of the writers.
#ifndef UMBRAGE_RASTER_TYPES_SHARED_H
#define UMBRAGE_RASTER_TYPES_SHARED_H
#include "culling/culling_types.shared.h"

UMB_NAMESPACE_BEGIN

struct CastPush {            // cast.vert, mask.frag
  uint64_t batches;
  vec2 atlas_size;           // texels; what the viewport covers
};
UMB_ASSERT_SIZE(CastPush, 16);

UMB_NAMESPACE_END
#endif
