#version 460
// The lights of each cluster, through the light tree (or by trying all): first counted, then written at scanned places, in
// the tree's order. A thread a cluster: neighbours walk alike, and no barrier is needed at any subgroup size.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
#include "gpu/groups.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { LightListPush push; };
layout(constant_id = 0) const bool writes = false;
layout(constant_id = 1) const bool brute_force = false;

uint cluster;
uint found = 0u;

void take(uint slot, uint first) {
  if (writes) {
    Uints(push.cluster_lights).v[first + found] = slot;
    Uints(push.pair_clusters).v[first + found] = cluster;
    Uints(push.used).v[slot] = LightIsUsed;
  }
  ++found;
}

void try_leaf(uint leaf, Box box, uint first) {
  uint slot = Uints(push.order).v[leaf];
  LightRecord light = Lights(push.lights).v[slot];
  if (light.type > LightSpot) return;   // directional, or dead
  if (light_shines_on(light, box)) take(slot, first);
}

/// The tree is implicit, so that walking it needs no stack: down to the first child, on to the next sibling, up when a
/// group of siblings ends.
void walk(Box box, uint first) {
  TreeShape shape = Shape(push.shape).shape;
  uint height = shape.levels;   // 0 = leaves
  uint i = 0u;
  if (height == 0u) return;
  while (true) {
    if (height == 0u) {
      try_leaf(i, box, first);
    } else if (boxes_meet(Boxes(push.nodes).v[shape.first[height - 1u] + i], box)) {
      --height;
      i *= TreeWidth;
      continue;
    }
    ++i;
    while (height < shape.levels && (i % TreeWidth == 0u || i >= (height == 0u ? shape.count : shape.nodes[height - 1u]))) {
      i = (i - 1u) / TreeWidth + 1u;
      ++height;
    }
    if (height >= shape.levels) return;
  }
}

void main() {
  cluster = gl_GlobalInvocationID.x;
  FrameRecord frame = Frame(push.frame).record;
  uint clusters = Counters(push.counters).counters.clusters;
  if (cluster >= clusters) {
    if (!writes && cluster < frame.cluster_capacity) Uints(push.counts).v[cluster] = 0u;
    return;
  }
  if (writes && cluster == 0u) {
    uvec3 groups = groups_for((min(Counters(push.counters).counters.pairs_found, frame.pair_capacity) + 63u) / 64u);
    for (int i = 0; i < 3; ++i) Counters(push.counters).counters.pair_groups[i] = groups[i];
  }
  Box box = Boxes(push.boxes).v[cluster];
  uint first = 0u;
  if (writes) {
    first = Uints(push.counts).v[cluster];
    uint end = cluster + 1u < clusters ? Uints(push.counts).v[cluster + 1u] : Counters(push.counters).counters.pairs_found;
    if (end > frame.pair_capacity) {   // no room: every light, slower and right
      ClusterLists(push.lists).v[cluster] = ClusterList(NoIndex, frame.light_count);
      for (uint pair = first; pair < frame.pair_capacity; ++pair) Uints(push.pair_clusters).v[pair] = NoIndex;
      Counters(push.counters).counters.all_lights_used = 1u;
      return;
    }
  }
  for (uint i = 0u; i < frame.directional_count; ++i) take(Uints(frame.light_order).v[i], first);
  if (brute_force) {
    uint count = Shape(push.shape).shape.count;
    for (uint leaf = 0u; leaf < count; ++leaf) try_leaf(leaf, box, first);
  } else {
    walk(box, first);
  }
  if (writes) ClusterLists(push.lists).v[cluster] = ClusterList(first, found);
  else Uints(push.counts).v[cluster] = found;
}
