#version 460
// The compact list: cell, world box and normal cone of every occupied cluster, ordered by tile and slice.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
#include "clusters/normal_cone.shared.h"
layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform PushBlock { CompactPush push; };

void main() {
  CameraRecord camera = Cameras(push.camera).v[0];
  uint capacity = Frame(push.frame).record.cluster_capacity;
  bool tight = Frame(push.frame).record.explicit_bounds != 0u;
  uvec2 tile = gl_WorkGroupID.xy;
  uint tile_index = camera.first_tile + tile.y * camera.tiles.x + tile.x;
  uint thread = gl_LocalInvocationIndex;
  uint first = Uints(push.tile_counts).v[tile_index];
  if (thread < SliceWords) ClusterWords(push.words).v[tile_index * SliceWords + thread].first += first;
  uint end = tile_index + 1u < Frame(push.frame).record.tile_count ? Uints(push.tile_counts).v[tile_index + 1u] : Counters(push.counters).counters.clusters_found;
  for (uint i = thread; i < end - first; i += 32u) {
    uint cluster = first + i;
    if (cluster >= capacity) break;
    FoundCluster found = FoundClusters(push.found).v[tile_index * MaxSlices + i];
    Box cell = cell_box(camera, tile, found.slice);
    if (tight) cell = explicit_box(found.bits, cell);
    Uints(push.cells).v[cluster] = tile_index * MaxSlices + found.slice;
    Boxes(push.boxes).v[cluster] = cell;
    bool any_normal = (found.normals_low & found.normals_high) == 0xffffffffu || (found.normals_low | found.normals_high) == 0u;
    Cones(push.cones).v[cluster] = any_normal ? vec4(0.0, 0.0, 1.0, -1.0) : normal_cone(found.normals_low, found.normals_high);
  }
}
