// Arrays of clusters by address.
#include "scene/scene_buffers.glsl"
#include "clusters/cluster_push.shared.h"

UMB_ARRAY(ClusterWords, ClusterWord, 4);
UMB_ARRAY(FoundClusters, FoundCluster, 4);
UMB_ARRAY(ClusterLists, ClusterList, 4);
UMB_ARRAY(Cones, vec4, 4);
UMB_ARRAY(Cameras, CameraRecord, 4);
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Frame { FrameRecord record; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Counters { FrameCounters counters; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Shape { TreeShape shape; };

/// The camera that a tile belongs to.
CameraRecord camera_of_tile(FrameRecord frame, uint tile) {
  for (uint i = 1u; i < frame.camera_count; ++i) {
    CameraRecord camera = Cameras(frame.cameras).v[i];
    if (tile >= camera.first_tile && tile < camera.end_tile) return camera;
  }
  return frame.camera;
}
