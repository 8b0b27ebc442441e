// Push constants of the passes that find clusters and their lights.
#ifndef UMBRAGE_CLUSTERS_PUSH_SHARED_H
#define UMBRAGE_CLUSTERS_PUSH_SHARED_H
#include "clusters/cluster_types.shared.h"

UMB_NAMESPACE_BEGIN

struct AssignPush {            // assign_clusters
  uint64_t camera;             // CameraRecord
  uint64_t words;              // ClusterWord [tile][SliceWords]
  uint64_t found;              // FoundCluster [tile][MaxSlices], the first tile_counts[tile] filled
  uint64_t tile_counts;
  uint normal_encoding;
  uint pad;
};
UMB_ASSERT_SIZE(AssignPush, 40);

/// A cluster as assign_clusters leaves it.
struct FoundCluster {
  uint bits;                   // explicit bounds
  uint normals_low, normals_high;
  uint slice;
};
UMB_ASSERT_SIZE(FoundCluster, 16);

struct CompactPush {           // count_clusters, compact_clusters
  uint64_t frame;
  uint64_t camera;             // compact_clusters: CameraRecord
  uint64_t words;
  uint64_t found;
  uint64_t tile_counts;        // count_clusters turns counts into first indices
  uint64_t counters;
  uint64_t cells;
  uint64_t boxes;
  uint64_t cones;
};
UMB_ASSERT_SIZE(CompactPush, 72);

struct LightListPush {         // list_lights
  uint64_t frame;
  uint64_t counters;
  uint64_t boxes;              // of clusters
  uint64_t lights;
  uint64_t order;              // light tree
  uint64_t nodes;
  uint64_t counts;             // count: lights per cluster; write: their first indices
  uint64_t lists;
  uint64_t cluster_lights;
  uint64_t used;               // one word a light slot
  uint64_t shape;              // TreeShape
  uint64_t pair_clusters;      // cluster of each pair
};
UMB_ASSERT_SIZE(LightListPush, 96);

UMB_NAMESPACE_END
#endif
