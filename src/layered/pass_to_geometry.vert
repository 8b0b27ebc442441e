#version 460
// Before a geometry shader: model and skin transforms, once a vertex whatever the number of views (R2).
#extension GL_GOOGLE_include_directive : require
#include "layered/layered_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
#include "layered/transform.glsl"
layout(location = 0) out vec3 out_world;
layout(location = 1) flat out uint out_caster;
#ifdef COLOR
layout(location = 2) out vec3 out_world_normal;
#endif
#if defined(COLOR) || defined(MASK)
layout(location = 3) out vec2 out_texture;
#endif

void main() {
  LayeredInstanceRecord instance = instance_of(push, gl_InstanceIndex);
  out_world = world_position(push, instance, gl_VertexIndex);
  out_caster = gl_InstanceIndex;
#ifdef COLOR
  out_world_normal = world_normal(push, instance, gl_VertexIndex);
#endif
#if defined(COLOR) || defined(MASK)
  out_texture = texture_coordinates(push, gl_VertexIndex);
#endif
}
