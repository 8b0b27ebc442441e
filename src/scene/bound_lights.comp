#version 460
// Box of what each light reaches. Directional lights are in every list and so stay out of the tree.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "scene/scene_push.shared.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { BoundLightsPush push; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  LightRecord light = Lights(push.lights).v[i];
  bool reaches = light.type == LightPoint || light.type == LightSpot;
  Boxes(push.boxes).v[i] = reaches ? light_box(light) : Box(vec3(1e30), vec3(-1e30));
}
