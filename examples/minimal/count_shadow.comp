// Asks for every pixel how much of the light arrives there and counts the pixels in shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define UMBRAGE_SET 1
#include "umbrage/shaders/umbrage.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform texture2D depth_image;
layout(buffer_reference, scalar) buffer Counter { uint pixels_in_shadow; };
layout(push_constant, scalar) uniform Push {
  uint64_t shadows;
  uint64_t counter;
  float eye_height_m;
  float near_m;
} push;

void main() {
  ivec2 size = textureSize(depth_image, 0);
  vec2 pixel = vec2(gl_GlobalInvocationID.xy) + 0.5;
  if (any(greaterThan(pixel, vec2(size)))) return;

  float depth = texelFetch(depth_image, ivec2(pixel), 0).x;
  if (depth == 0.0) return;
  float distance_m = push.near_m / depth;  // Reversed, infinite depth; the camera looks straight down.
  vec2 ndc = pixel / vec2(size) * 2.0 - 1.0;
  vec3 position_ws = vec3(ndc.x * distance_m, push.eye_height_m - distance_m, ndc.y * distance_m);
  vec3 normal_ws = vec3(0.0, 1.0, 0.0);  // All that is seen from above here.

  UmbrageFrame shadows = umbrage_frame(push.shadows);
  UmbrageCluster cluster = umbrage_cluster(shadows, pixel, depth);
  for (uint i = 0u; i < cluster.count; i++) {
    float visibility = umbrage_visibility(shadows, cluster, i, position_ws, normal_ws);
    if (visibility < 0.5) atomicAdd(Counter(push.counter).pixels_in_shadow, 1u);
  }
}
