// World positions or geometric normals of all pixels, three floats each; no surface: NaN positions, zero normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { FramePush push; };

const uint quiet_nan = 0x7fc00000u;

void main() {
  Frame frame = Frame(push.frame);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(frame.data.width) || pixel.y >= int(frame.data.height)) return;
  uint index = uint(pixel.y) * frame.data.width + uint(pixel.x);
  float depth = texelFetch(depth_target, pixel, 0).x;
  uvec3 bits = uvec3(push.first == 0u ? quiet_nan : 0u);
  if (depth > 0.0) {
    vec3 value = push.first == 0u ? frame.data.eye_ws + offset_from_depth(frame, vec2(pixel) + 0.5, depth)
                                  : from_octahedral(texelFetch(geometric_normal_target, pixel, 0).xy);
    bits = floatBitsToUint(value);
  }
  Words words = Words(push.output_buffer);
  for (uint i = 0u; i < 3u; ++i) words.at[3u * index + i] = bits[i];
}
