#version 460
// Viewport atlas (R7): views of any size side by side in one layer, one draw with an instance a view.
#extension GL_GOOGLE_include_directive : require
#include "layered/layered_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
#include "layered/place_vertex.glsl"
#include "layered/instance_views.glsl"

void main() {
  uint caster = gl_InstanceIndex / MaxLayeredViews;
  place_vertex(caster, nth_view(caster, gl_InstanceIndex % MaxLayeredViews));
}
