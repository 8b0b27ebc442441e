// A geometry shader's triangle into one view: listings 19.5, 19.9 and 19.10 in one, each culling on or off.
#include "layered/transform.glsl"
#include "layered/place.glsl"
layout(location = 0) in vec3 in_world[];
layout(location = 1) flat in uint in_caster[];
#ifdef COLOR
layout(location = 2) in vec3 in_world_normal[];
#endif
#if defined(COLOR) || defined(MASK)
layout(location = 3) in vec2 in_texture[];
#endif
#ifdef AREAS
out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[4];
};
#endif

void emit_triangle(uint view_index) {
  if (each_view && !sees(push.visible, in_caster[0], view_index)) return;
  LayeredViewRecord view = LayeredViews(push.views).v[view_index];
  if (cull_faces != CullNothing) {
    float handedness = instance_of(push, in_caster[0]).handedness;
    if (is_culled_face(in_world[0], in_world[1], in_world[2], view.eye, handedness, cull_faces)) return;
  }
  vec4 clip[3];
  for (int i = 0; i < 3; ++i) clip[i] = view_clip(view, in_world[i]);
  if (cull_frustum && is_outside(clip[0], clip[1], clip[2])) return;
  for (int i = 0; i < 3; ++i) {
#ifdef AREAS
    gl_ClipDistance[0] = clip[i].w - clip[i].x;
    gl_ClipDistance[1] = clip[i].w + clip[i].x;
    gl_ClipDistance[2] = clip[i].w - clip[i].y;
    gl_ClipDistance[3] = clip[i].w + clip[i].y;
#endif
    gl_Position = in_area(view, clip[i]);
    gl_Layer = int(view.layer - push.first_layer);
#ifdef COLOR
    out_position_ws = in_world[i];
    out_normal_ws = in_world_normal[i];
    out_host_index = instance_of(push, in_caster[0]).host_index;
    out_view = view.index;
#endif
#if defined(COLOR) || defined(MASK)
    out_uv = in_texture[i];
#endif
#if defined(MASK) && !defined(COLOR)
    out_batch = LayeredCasters(push.casters).v[in_caster[0]].batch;
#endif
    EmitVertex();
  }
  EndPrimitive();
}
