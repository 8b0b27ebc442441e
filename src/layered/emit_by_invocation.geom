#version 460
// An invocation a view (R2, listing 19.5); where there are more views than invocations, each draws several. The host writes the
// number of invocations into the SPIR-V (patch_spirv.cpp): no specialization constant can stand there.
#extension GL_GOOGLE_include_directive : require
#include "layered/layered_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
layout(triangles, invocations = 32) in;
layout(triangle_strip, max_vertices = 3) out;
layout(constant_id = 4) const uint invocations = 32u;
#include "layered/emit_triangle.glsl"

void main() {
  for (uint i = gl_InvocationID; i < push.view_count; i += invocations) emit_triangle(push.first_view + i);
}
