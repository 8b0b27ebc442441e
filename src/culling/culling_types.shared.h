// (batch, light) pairs and what draws are made of them.
#ifndef UMBRAGE_CULLING_TYPES_SHARED_H
#define UMBRAGE_CULLING_TYPES_SHARED_H
#include "store/store_types.shared.h"

UMB_NAMESPACE_BEGIN

/// Threads that share a light's traversal; each owns the lowest nodes whose number has its remainder.
UMB_CONST uint TraverseThreads = 64u;

/// A batch to be drawn into views of a light.
struct CasterPair {
  uint caster;
  uint light_and_mask;       // light slot in the low 20 bits; bit 20 + i: view i of the light
};
UMB_ASSERT_SIZE(CasterPair, 8);

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
  uint64_t counts;           // per light and thread: counts, then first pairs
  uint64_t counters;
  uint64_t pairs;            // write_casters
  uint64_t commands;         // opaque ones, then masked ones
  uint64_t draw_counts;
  uint64_t used;             // write_casters marks lights whose pairs are beyond the last round
  uint window_first;         // write_casters: first pair of the round; write_view_casters: first view
  uint window_size;          // write_casters: pairs a round; write_view_casters: room for commands a list
};
UMB_ASSERT_SIZE(TraversePush, 128);

UMB_FN uint pair_light(CasterPair pair) { return pair.light_and_mask & 0xfffffu; }
UMB_FN uint pair_mask(CasterPair pair) { return pair.light_and_mask >> 20u; }

/// Number of the n-th set bit (O12: the layer from instance index and face mask).
UMB_FN uint nth_set_bit(uint mask, uint n) {
  for (uint i = 0u; i < n; ++i) mask &= mask - 1u;
  return uint(findLSB(mask));
}

UMB_NAMESPACE_END
#endif
