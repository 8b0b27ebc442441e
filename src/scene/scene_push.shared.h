// Push constants of the passes that bound casters and lights.
#ifndef UMBRAGE_SCENE_PUSH_SHARED_H
#define UMBRAGE_SCENE_PUSH_SHARED_H
#include "scene/scene_types.shared.h"

UMB_NAMESPACE_BEGIN

struct BoundBatchesPush {
  uint64_t moved;       // caster indices
  uint64_t casters;
  uint64_t instances;
  uint64_t batches;
  uint64_t indices;
  uint64_t boxes;
};
UMB_ASSERT_SIZE(BoundBatchesPush, 48);

struct BoundLightsPush {
  uint64_t lights;
  uint64_t boxes;
  uint count;
  uint pad;
};
UMB_ASSERT_SIZE(BoundLightsPush, 24);

UMB_NAMESPACE_END
#endif
