// One thread draws a triangle's texels in a block of a page. Includer: `masked`, masks[], push.
#include "raster/page_raster_buffers.glsl"

/// Perspective texture coordinates at a texel, with the footprint of the texel for the level of detail.
bool is_cut_out(RasterTriangle t, vec3 weights) {
  if (t.batch == NoIndex) return false;
  BatchRecord batch = Batches(push.batches).v[t.batch];
  float q = dot(weights, t.q);
  vec2 uv = vec2(dot(weights, t.u), dot(weights, t.v)) / q;
  vec3 x = vec3(steps_x(t));
  vec3 y = vec3(steps_y(t));
  vec2 across = (vec2(dot(x, t.u), dot(x, t.v)) - uv * dot(x, t.q)) / q;
  vec2 down = (vec2(dot(y, t.u), dot(y, t.v)) - uv * dot(y, t.q)) / q;
  float alpha = textureGrad(masks[nonuniformEXT(batch.mask)], uv, across, down).a;
  return alpha * batch.alpha_factor < batch.alpha_cutoff;
}

/// Texels first … last, which lie in one page that begins at `origin` in the pool.
void draw_block(Uints pool, RasterTriangle t, uint page_side, uint origin, ivec2 first, ivec2 last, ivec3 edges, vec3 fractions) {
  ivec3 step_x = steps_x(t);
  int width = last.x - first.x + 1;
  ivec3 step_row = steps_y(t) - step_x * (width - 1);
  uint at = origin + uint(first.y) % PageSide * page_side + uint(first.x) % PageSide;
  int column = 0;
  for (int left = width * (last.y - first.y + 1); left > 0; --left) {
    if ((edges.x | edges.y | edges.z) >= 0) {
      uint key = depth_key(t, edges, fractions);
      if (key > pool.v[at] && !(masked && is_cut_out(t, vec3(edges) + fractions))) atomicMax(pool.v[at], key);
    }
    bool turns = ++column == width;
    if (turns) column = 0;
    edges += turns ? step_row : step_x;
    at += turns ? page_side - uint(width) + 1u : 1u;
  }
}
