// Push constants of the passes that sort boxes and build the tree over them.
#ifndef UMBRAGE_SCENE_TREE_PUSH_SHARED_H
#define UMBRAGE_SCENE_TREE_PUSH_SHARED_H
#include "scene/scene_types.shared.h"

UMB_NAMESPACE_BEGIN

UMB_CONST uint SortThreads = 128u;
UMB_CONST uint SortItemsPerThread = 16u;
UMB_CONST uint SortBlock = 2048u;
UMB_CONST uint SortDigits = 16u;   // 4 bits a pass
UMB_CONST uint SortPasses = 8u;

struct BoundsPush {       // reduce_bounds, make_keys
  uint64_t boxes;
  uint64_t bounds;        // six ordered_bits: lo, hi
  uint64_t keys;
  uint64_t values;
  uint count;
  uint pad;
};
UMB_ASSERT_SIZE(BoundsPush, 40);

struct SortPush {         // sort_count, sort_scan, sort_scatter
  uint64_t keys_in;
  uint64_t values_in;
  uint64_t keys_out;
  uint64_t values_out;
  uint64_t counts;        // digit-major: [digit][block]
  uint count;
  uint blocks;
  uint shift;
  uint pad;
};
UMB_ASSERT_SIZE(SortPush, 56);

struct NodesPush {        // build_nodes
  uint64_t boxes;         // level 0: of the items, else of the level below
  uint64_t order;         // level 0: items in Morton order
  uint64_t leaves;        // level 0: boxes in Morton order are written here
  uint64_t nodes;         // this level's
  uint child_count;
  uint is_leaf_level;
};
UMB_ASSERT_SIZE(NodesPush, 40);

UMB_NAMESPACE_END
#endif
