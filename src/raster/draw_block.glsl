// One thread draws a triangle's texels in a block of a page. Includer: `masked`, masks[], push.
#include "raster/page_raster_buffers.glsl"

/// The whole level nearest to the right one: half the work of two.
float mask_level(RasterTriangle t) {
  return roundEven(max(mask_level(t, textureSize(masks[nonuniformEXT(Batches(push.batches).v[t.batch].mask)], 0)), 0.0));
}

/// The mask at a texel.
bool is_cut_out(RasterTriangle t, vec3 weights, float level) {
  if (t.batch == NoIndex) return false;
  BatchRecord batch = Batches(push.batches).v[t.batch];
  return textureLod(masks[nonuniformEXT(batch.mask)], mask_coordinates(t, weights), level).a * batch.alpha_factor < batch.alpha_cutoff;
}

/// Are only texels drawn that are looked up? Small maps and those for points that no depth buffer saw are drawn whole.
bool draws_looked_up(MapRecord map) {
  return (push.flags & TestTexels) != 0u && map.resolution >= PageSide && map.receivers == ReceiversInSight;
}

/// Draws a triangle's texels first … last, which lie in one page that begins at `origin` in the pool; of those only what is
/// looked up. Rows are cut to where the edges can be inside; the exact test decides.
void draw_block(Pool pool, RasterTriangle t, uint page_side, uint origin, bool looked_up, ivec2 first, ivec2 last, ivec3 edges,
                vec3 fractions) {
  ivec3 step_x = steps_x(t);
  ivec3 step_y = steps_y(t);
  vec3 texels_per_unit = 1.0 / vec3(max(abs(step_x), ivec3(1)));
  float level = masked && t.batch != NoIndex ? mask_level(t) : 0.0;
  bvec3 rises = greaterThan(step_x, ivec3(0));
  bvec3 falls = lessThan(step_x, ivec3(0));
  float width = float(last.x - first.x + 1);
  int left = first.x % int(PageSide);
  uint columns = bits_between(left, left + last.x - first.x + 1);
  uint row = uint(first.y) % PageSide;
  for (int y = first.y; y <= last.y; ++y) {
    uint wanted = columns;
    if (looked_up) wanted &= pool.texel_bits.v[texel_word(origin, row)];
    if (wanted != 0u) {
      // An edge that rises is passed at -edge / step, one that falls is left there.
      vec3 crossing = vec3(edges) * texels_per_unit;
      vec3 enters = mix(vec3(0.0), -crossing, rises);
      vec3 leaves = mix(vec3(width), crossing, falls);
      int begin = round_to_int(clamp(max(enters.x, max(enters.y, enters.z)) - 0.5, 0.0, width));
      int end = round_to_int(clamp(min(leaves.x, min(leaves.y, leaves.z)) + 1.5, 0.0, width));
      wanted &= bits_between(left + begin, left + end);
      for (; wanted != 0u; wanted &= wanted - 1u) {
        int x = findLSB(wanted);
        ivec3 at = edges + step_x * (x - left);
        if ((at.x | at.y | at.z) >= 0) {
          uint key = depth_key(t, at, fractions);
          uint texel = origin + row * page_side + uint(x);
          if (key > pool.texels.v[texel] && !(masked && is_cut_out(t, vec3(at) + fractions, level))) atomicMax(pool.texels.v[texel], key);
        }
      }
    }
    edges += step_y;
    ++row;
  }
}
