#version 460
// Turns counts into the arguments of the next indirect dispatch.
#extension GL_GOOGLE_include_directive : require
#include "raster/page_raster_buffers.glsl"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform PushBlock { PageRasterPush push; };

uvec2 groups_of(uint count) {
  return uvec2(min(count, MaxGroupsX), (count + MaxGroupsX - 1u) / MaxGroupsX);
}

void main() {
  Arguments arguments = Arguments(push.arguments);
  Appended appended = Appended(push.appended);
  if (push.flags == PlanItems) {
    DrawCounts counts = ItemCounts(push.counts).v;
    uvec2 opaque = groups_of(min(counts.opaque, push.item_capacity));
    uvec2 masked = groups_of(min(counts.masked, push.item_capacity));
    arguments.v.items = uint[](opaque.x, opaque.y, 1u, masked.x, masked.y, 1u);
    appended.v = RasterCounts(0u, 0u, 0u);
  } else if (push.flags == PlanTriangles) {
    const uint per_group = RasterThreads / BinThreads;
    uvec2 groups = groups_of((min(appended.v.triangles, push.large_capacity) + per_group - 1u) / per_group);
    arguments.v.triangles = uint[](groups.x, groups.y, 1u);
    if (push.counters != 0ul) atomicMax(FrameCount(push.counters).v.large_triangles, appended.v.triangles);
  } else {
    uvec2 groups = groups_of(appended.v.tiles);
    arguments.v.tiles = uint[](groups.x, groups.y, 1u);
  }
}
