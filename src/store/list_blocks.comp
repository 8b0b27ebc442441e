#version 460
// O18: the pages of sparse images that this frame needs, for the host to bind. A workgroup a map.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
#include "maps/marked_blocks.glsl"
#include "store/sparse_page.shared.h"
layout(local_size_x = 64) in;
UMB_ARRAY(Pages, SparsePage, 4);

void main() {
  FrameRecord frame = Frame(push.frame).record;
  MapRecord map = Maps(frame.maps).v[group_index()];
  if (block_units(map.resolution) == 0u) return;   // in an ordinary image
  uvec2 blocks = blocks_of(map.resolution);
  for (uint i = gl_LocalInvocationIndex; i < map.view_count * blocks.x * blocks.y; i += 64u) {
    uint view = i / (blocks.x * blocks.y);
    uint block = i % (blocks.x * blocks.y);
    uvec2 at = uvec2(block % blocks.x, block / blocks.x);
    if (!any_marked(frame, map, view, at, map.resolution)) continue;
    uint place = atomicAdd(Counters(push.counters).counters.pages_listed, 1u);
    Pages(push.requests).v[place] = SparsePage(map.image << 16u | map.layer + view, at.y << 16u | at.x);
  }
}
