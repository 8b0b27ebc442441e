#version 460
// All views of the group from one invocation: what OpenGL 3 hardware could do. The number of vertices is patched likewise.
#extension GL_GOOGLE_include_directive : require
#include "layered/layered_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
#include "layered/emit_triangle.glsl"

void main() {
  for (uint i = 0u; i < push.view_count; ++i) emit_triangle(push.first_view + i);
}
