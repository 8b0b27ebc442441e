// The depth atlas into a buffer, texel by texel.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) uniform texture2D atlas;
layout(buffer_reference, scalar) buffer Texels { float v[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t target;
  uint width;
  uint height;
} push;

void main() {
  uvec2 texel = gl_GlobalInvocationID.xy;
  if (texel.x >= push.width || texel.y >= push.height) return;
  Texels(push.target).v[texel.y * push.width + texel.x] = texelFetch(atlas, ivec2(texel), 0).x;
}
