#version 460
// Empties the marked pages of maps in images of words. A workgroup a map.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "raster/page_buffers.glsl"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform PushBlock { ClearWordsPush push; };
layout(set = 0, binding = 2, r32ui) writeonly uniform uimage2DArray words[];

void main() {
  uint index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  Frame frame = Frame(push.frame);
  MapRecord map = Maps(frame.v.maps).v[index];
  uint side = page_side_of(map.resolution);
  for (uint i = 0u; i < map.view_count * map.pages * map.pages; ++i) {
    uint view = i / (map.pages * map.pages);
    uint page = i % (map.pages * map.pages);
    uint word = map.first_word + view * map.words + page / 32u;
    if ((Uints(frame.v.page_bits).v[word] >> page % 32u & 1u) == 0u) continue;
    uvec2 first = uvec2(page % map.pages, page / map.pages) * PageSide;
    for (uint texel = gl_LocalInvocationIndex; texel < side * side; texel += 256u)
      imageStore(words[nonuniformEXT(map.image)], ivec3(first + uvec2(texel % side, texel / side), map.layer + view), uvec4(0u));
  }
}
