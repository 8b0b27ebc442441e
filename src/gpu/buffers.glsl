// Arrays by address. A push constant's uint64_t becomes one of these at the point of use: Uints(push.words).v[i].
#ifndef UMBRAGE_GPU_BUFFERS_GLSL
#define UMBRAGE_GPU_BUFFERS_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#define UMB_ARRAY(name, type, align) \
  layout(buffer_reference, scalar, buffer_reference_align = align) buffer name { type v[]; }

UMB_ARRAY(Uints, uint, 4);
UMB_ARRAY(Uvec2s, uvec2, 4);
UMB_ARRAY(Uvec3s, uvec3, 4);
UMB_ARRAY(Floats, float, 4);

#endif
