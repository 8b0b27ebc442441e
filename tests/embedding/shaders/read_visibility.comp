// Writes what umbrage_visibility() says, for every pixel and light; -1 stays where the light is not in the pixel's
// list or not in front of the surface, where the include promises nothing.
// Behind a pixel's lights: the cosine of its cluster's normal cone, or -2 where the cone misses the pixel's normal.
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
layout(set = 0, binding = 1) uniform texture2D normal_image;
layout(buffer_reference, scalar) buffer Visibility { float of[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t shadows;
  uint64_t visibility;
  mat4 world_from_clip;
  float clip_depth_scale;  // Clip depth = scale * (what the buffer holds) + bias.
  float clip_depth_bias;
  float background;
  uint lights;
} push;

void main() {
  ivec2 size = textureSize(depth_image, 0);
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  float depth = texelFetch(depth_image, texel, 0).x;
  if (depth == push.background) return;

  vec2 pixel = vec2(texel) + 0.5;
  float clip_depth = push.clip_depth_scale * depth + push.clip_depth_bias;
  vec4 position = push.world_from_clip * vec4(pixel / vec2(size) * 2.0 - 1.0, clip_depth, 1.0);
  vec3 position_ws = position.xyz / position.w;
  vec3 normal_ws = texelFetch(normal_image, texel, 0).xyz;

  UmbrageFrame shadows = umbrage_frame(push.shadows);
  UmbrageCluster cluster = umbrage_cluster(shadows, pixel, depth);
  uint first = uint(texel.y * size.x + texel.x) * (push.lights + 1u);
  for (uint i = 0u; i < cluster.count; i++) {
    UmbrageLight light = umbrage_light(shadows, cluster, i);
    vec3 to_light = light.type == 2u ? -light.direction_ws : light.position_ws - position_ws;
    if (dot(normal_ws, to_light) <= 0.01 * length(to_light)) continue;   // some surfaces lie in a light's own plane
    if (light.type != 2u && dot(to_light, to_light) > light.range_m * light.range_m) continue;
    if (light.type == 1u && dot(light.direction_ws, -to_light) <= light.cos_outer * length(to_light)) continue;   // beside its cone
    Visibility(push.visibility).of[first + light.host_index] = umbrage_visibility(shadows, cluster, i, position_ws, normal_ws);
  }
  if (cluster.count == 0u) return;
  vec4 cone = umbrage_cluster_cone(shadows, cluster.index);
  bool inside = dot(cone.xyz, normal_ws) > cone.w - 1e-3;
  Visibility(push.visibility).of[first + push.lights] = inside ? cone.w : -2.0;
}
