// Arrays of the maps' records by address.
#include "clusters/cluster_buffers.glsl"
#include "maps/map_push.shared.h"
#include "maps/resolution.shared.h"

UMB_ARRAY(Maps, MapRecord, 4);
UMB_ARRAY(LightMapList, LightMaps, 4);
UMB_ARRAY(Requests, LightRequest, 4);
UMB_ARRAY(Views, ShadowView, 4);

/// Large indirect dispatches have two dimensions (set_groups).
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

/// The lights of the cluster that a sample lies in; first = NoIndex: all, or the cluster has no room.
ClusterList list_of_slice(FrameRecord frame, uint tile, uint slice) {
  ClusterWord word = ClusterWords(frame.cluster_words).v[tile * SliceWords + slice / 32u];
  uint cluster = word.first + uint(bitCount(word.occupied & ((1u << slice % 32u) - 1u)));
  if (cluster >= frame.cluster_capacity) return ClusterList(NoIndex, 0u);
  return ClusterLists(frame.cluster_lists).v[cluster];
}
