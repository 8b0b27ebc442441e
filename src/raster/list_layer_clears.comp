#version 460
// The layers that maps use, image by image, and the draws that empty them. A workgroup a map, a thread a view.
#extension GL_GOOGLE_include_directive : require
#include "raster/page_buffers.glsl"
layout(local_size_x = 8) in;
layout(push_constant, scalar) uniform PushBlock { ListLayersPush push; };

UMB_ARRAY(Clears, ClearCommand, 4);
UMB_ARRAY(Images, MapImage, 4);

void main() {
  uint index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint view = gl_LocalInvocationIndex;
  MapRecord map = Maps(Frame(push.frame).v.maps).v[index];
  if (view >= map.view_count || (map.faces >> view & 1u) == 0u) return;
  uint first = Images(push.images).v[map.image].first_layer;
  uint place = atomicAdd(Clears(push.commands).v[map.image].instance_count, 1u);
  Uints(push.layers).v[first + place] = map.layer + view | map.resolution << 16u;
  if (place != 0u) return;
  Clears(push.commands).v[map.image].vertex_count = 6u;
  Clears(push.commands).v[map.image].first_instance = first;
  Uints(push.counts).v[map.image] = 1u;
}
