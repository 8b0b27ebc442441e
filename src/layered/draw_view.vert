#version 460
// Traditional (R1): one view a render pass.
#extension GL_GOOGLE_include_directive : require
#include "layered/layered_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
#include "layered/place_vertex.glsl"

void main() { place_vertex(gl_InstanceIndex, push.first_view); }
