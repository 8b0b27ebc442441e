// What a depth-buffer sample is: its place, and its normal if the host has any. Includer: push with normal_encoding.
#extension GL_EXT_samplerless_texture_functions : require
#include "clusters/normal_cone.shared.h"
layout(set = 0, binding = 0) uniform texture2D depth_image;
layout(set = 0, binding = 1) uniform texture2D normal_image;

/// False for background.
bool read_sample(CameraRecord camera, ivec2 pixel, out uint slice, out vec3 position) {
  float depth = texelFetch(depth_image, pixel, 0).x;
  if (is_background(depth)) return false;
  float t = view_depth(camera, depth);
  slice = slice_of(camera, t);
  position = world_position(camera, ndc_of_pixel(camera, vec2(pixel) + 0.5), t);
  return true;
}

/// False when the host has no normals or this one is not a direction.
bool read_normal(ivec2 pixel, out vec3 normal) {
  if (push.normal_encoding == 0u) return false;
  vec3 texel = texelFetch(normal_image, pixel, 0).xyz;
  normal = push.normal_encoding == 1u ? from_octahedral(texel.xy) : push.normal_encoding == 2u ? texel * 2.0 - 1.0 : texel;
  float size = dot(normal, normal);
  return size > 0.25 && size < 4.0;
}
