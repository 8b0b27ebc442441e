// Texels of one layer of a sparse image of words, and whether each is resident, into a buffer: a word of both each.
#version 460
#extension GL_ARB_sparse_texture2 : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, r32ui) readonly uniform uimage2DArray words;
struct Texel {
  uint word;
  uint resident;
};
layout(buffer_reference, scalar) buffer Texels { Texel v[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t target;
  uint layer;
  uint side;      // texels read, from the corner
} push;

void main() {
  uvec2 texel = gl_GlobalInvocationID.xy;
  if (max(texel.x, texel.y) >= push.side) return;
  uvec4 loaded;
  int code = sparseImageLoadARB(words, ivec3(texel, push.layer), loaded);
  Texels(push.target).v[texel.y * push.side + texel.x] = Texel(loaded.x, uint(sparseTexelsResidentARB(code)));
}
