// The last step of writers whose vertex shader places a vertex in one view. Includer: #version, push.
#include "layered/transform.glsl"
#include "layered/place.glsl"
#ifdef AREAS
out float gl_ClipDistance[4];
#endif

void place_vertex(uint caster, uint view_index) {
  LayeredViewRecord view = LayeredViews(push.views).v[view_index];
  LayeredInstanceRecord instance = instance_of(push, caster);
  vec3 world = world_position(push, instance, gl_VertexIndex);
  vec4 clip = view_clip(view, world);
#ifdef AREAS
  gl_ClipDistance[0] = clip.w - clip.x;
  gl_ClipDistance[1] = clip.w + clip.x;
  gl_ClipDistance[2] = clip.w - clip.y;
  gl_ClipDistance[3] = clip.w + clip.y;
#endif
  gl_Position = in_area(view, clip);
#ifdef COLOR
  out_position_ws = world;
  out_normal_ws = world_normal(push, instance, gl_VertexIndex);
  out_host_index = instance.host_index;
  out_view = view.index;
#endif
#if defined(COLOR) || defined(MASK)
  out_uv = texture_coordinates(push, gl_VertexIndex);
#endif
#if defined(MASK) && !defined(COLOR)
  out_batch = LayeredCasters(push.casters).v[caster].batch;
#endif
}
