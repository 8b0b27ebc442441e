// Arrays of clusters by address.
#include "scene/scene_buffers.glsl"
#include "clusters/cluster_push.shared.h"

UMB_ARRAY(ClusterWords, ClusterWord, 4);
UMB_ARRAY(FoundClusters, FoundCluster, 4);
UMB_ARRAY(ClusterLists, ClusterList, 4);
UMB_ARRAY(Cones, vec4, 4);
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Frame { FrameRecord record; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Counters { FrameCounters counters; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Shape { TreeShape shape; };
