#version 460
// Multiview: the driver runs the draw once a layer.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
#include "layered/layered_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
#include "layered/place_vertex.glsl"

void main() { place_vertex(gl_InstanceIndex, push.first_view + gl_ViewIndex); }
