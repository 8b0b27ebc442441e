#version 460
// Vertex-written layer: one draw with an instance a view.
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "layered/layered_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
#include "layered/place_vertex.glsl"
#include "layered/instance_views.glsl"

void main() {
  uint caster = gl_InstanceIndex / MaxLayeredViews;
  uint view = nth_view(caster, gl_InstanceIndex % MaxLayeredViews);
  place_vertex(caster, view);
  gl_Layer = int(LayeredViews(push.views).v[view].layer - push.first_layer);
}
