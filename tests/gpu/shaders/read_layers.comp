// Some layers of one of the images that maps lie in, into a buffer, texel by texel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1) uniform texture2DArray images[24];
layout(buffer_reference, scalar) buffer Texels { float v[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t target;
  uint image;
  uint first_layer;
  uint side;      // texels read, from the corner
} push;

void main() {
  uvec3 texel = gl_GlobalInvocationID;
  if (max(texel.x, texel.y) >= push.side) return;
  float depth = texelFetch(images[nonuniformEXT(push.image)], ivec3(texel.xy, texel.z + push.first_layer), 0).x;
  Texels(push.target).v[(texel.z * push.side + texel.y) * push.side + texel.x] = depth;
}
