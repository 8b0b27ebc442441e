// What a stage hands to the rasteriser. Variants: AREAS (views that are parts of a layer, cut out by clip distances);
// MASK (what cut_mask.frag needs); COLOR (what a host's fragment shader gets). A mesh shader defines PER_VERTEX as [].
#ifndef PER_VERTEX
#define PER_VERTEX
#endif
#ifdef COLOR
layout(location = 0) out vec3 out_position_ws PER_VERTEX;
layout(location = 1) out vec3 out_normal_ws PER_VERTEX;
layout(location = 4) flat out uint out_view PER_VERTEX;
layout(location = 3) flat out uint out_host_index PER_VERTEX;
#elif defined(MASK)
layout(location = 3) flat out uint out_batch PER_VERTEX;
#endif
#if defined(COLOR) || defined(MASK)
layout(location = 2) out vec2 out_uv PER_VERTEX;
#endif

/// Into the view's area of the layer.
vec4 in_area(LayeredViewRecord view, vec4 clip) {
#ifdef AREAS
  precise vec2 moved = clip.xy * view.area_scale + clip.w * view.area_offset;
  clip.xy = moved;
#endif
  return clip;
}
