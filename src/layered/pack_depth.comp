#version 460
// Depth keys of the compute writer → 16-bit depths, as they are copied into a D16 image. A thread two texels.
#extension GL_GOOGLE_include_directive : require
#include "layered/layered_buffers.glsl"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform PushBlock { PackPush push; };

uint half_of(uint key) { return uint(roundEven(uintBitsToFloat(key) * 65535.0)); }

void main() {
  for (uint word = gl_GlobalInvocationID.x; word < push.words; word += gl_NumWorkGroups.x * 256u)
    Uints(push.halves).v[word] = half_of(Uints(push.keys).v[2u * word]) | (half_of(Uints(push.keys).v[2u * word + 1u]) << 16u);
}
