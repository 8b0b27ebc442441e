// A page of a sparse image, as the device asks the host for it, and the push constants of the passes around it.
#ifndef UMBRAGE_STORE_SPARSE_PAGE_SHARED_H
#define UMBRAGE_STORE_SPARSE_PAGE_SHARED_H
#include "core/shared_math.h"

UMB_NAMESPACE_BEGIN

struct SparsePage {
  uint image_layer;        // image << 16 | layer
  uint place;              // y << 16 | x, in pages
};
UMB_ASSERT_SIZE(SparsePage, 8);

/// What the host reads: how many, and then the pages.
struct SparseRequests {
  uint count;
  uint pad;
};
UMB_ASSERT_SIZE(SparseRequests, 8);

UMB_NAMESPACE_END
#endif
