// A triangle's texels on a cascade's map. Edge functions are exact integers and depths follow from them, so a texel gets the same
// depth whatever rectangle it is drawn in and wherever the map lies. Includer: `masked`, masks[], push with table and batches.
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "cascades/cascade_buffers.glsl"
#include "raster/triangle.shared.h"

ivec3 grid_steps_x(GridTriangle t) { return ivec3(t.y1 - t.y2, t.y2 - t.y0, t.y0 - t.y1); }
ivec3 grid_steps_y(GridTriangle t) { return ivec3(t.x2 - t.x1, t.x0 - t.x2, t.x1 - t.x0); }

/// Top-left rule: 1 where a texel's centre on the edge is outside.
int edge_rule(int step_x, int step_y) { return step_x > 0 || (step_x == 0 && step_y > 0) ? 0 : 1; }

/// Level of the mask at which a step of a texel is about a texel of it.
float grid_mask_level(GridTriangle t) {
  vec2 size = vec2(textureSize(masks[nonuniformEXT(Batches(push.batches).v[t.batch].mask)], 0));
  vec3 x = vec3(grid_steps_x(t)) * float(SubTexels);
  vec3 y = vec3(grid_steps_y(t)) * float(SubTexels);
  vec2 across = vec2(dot(x, t.u), dot(x, t.v)) * size;
  vec2 down = vec2(dot(y, t.u), dot(y, t.v)) * size;
  return roundEven(max(0.5 * log2(max(max(dot(across, across), dot(down, down)), 1e-12)), 0.0));
}

bool is_cut_out(GridTriangle t, vec3 weights, float level) {
  if (t.batch == NoIndex) return false;
  BatchRecord batch = Batches(push.batches).v[t.batch];
  vec2 uv = vec2(dot(weights, t.u), dot(weights, t.v));
  return textureLod(masks[nonuniformEXT(batch.mask)], uv, level).a * batch.alpha_factor < batch.alpha_cutoff;
}

void draw_texel(Uints maps, uint word, GridTriangle t, vec3 weights, float level) {
  precise float above = weights.x * t.z.x + weights.y * t.z.y + weights.z * t.z.z;
  int depth = t.z_base + round_to_int(clamp(above, 0.0, t.z_most));
  if (depth > FarDepth) return;
  uint key = uint(max(depth, 0));
  if (key < maps.v[word] && !(masked && is_cut_out(t, weights, level))) atomicMin(maps.v[word], key);
}

/// Texels first … last, at most CellTexels wide and high. Edge functions start from 64 bits and step in 32.
void draw_block(GridTriangle t, uint side, ivec2 first, ivec2 last) {
  ivec3 step_x = grid_steps_x(t);
  ivec3 step_y = grid_steps_y(t);
  Uints maps = Uints(Table(push.table).v.maps);
  float level = masked && t.batch != NoIndex ? grid_mask_level(t) : 0.0;
  ivec2 at = first * SubTexels + SubTexels / 2;
  EdgeStart a = start_edge(step_x.x, step_y.x, at.x - t.x1, at.y - t.y1);
  EdgeStart b = start_edge(step_x.y, step_y.y, at.x - t.x2, at.y - t.y2);
  EdgeStart c = start_edge(step_x.z, step_y.z, at.x - t.x0, at.y - t.y0);
  ivec3 row = ivec3(a.value, b.value, c.value);
  vec3 fractions = vec3(a.fraction, b.fraction, c.fraction);
  for (int y = first.y; y <= last.y; ++y) {
    ivec3 edges = row;
    uint word = t.target + uint(y) * side + uint(first.x);
    for (int x = first.x; x <= last.x; ++x) {
      if ((edges.x | edges.y | edges.z) >= 0) draw_texel(maps, word, t, (vec3(edges) + fractions) * float(SubTexels), level);
      edges += step_x;
      ++word;
    }
    row += step_y;
  }
}

/// Sub-texels along an edge with which 32 bits last for a block.
const int MostStep = 1 << 25;

/// Texels first … last, at most CellTexels wide and high, of a triangle of any size.
void draw_cell(GridTriangle t, uint side, ivec2 first, ivec2 last) {
  ivec3 most = max(abs(grid_steps_x(t)), abs(grid_steps_y(t)));
  if (max(most.x, max(most.y, most.z)) <= MostStep) {
    draw_block(t, side, first, last);
    return;
  }
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) draw_block(t, side, ivec2(x, y), ivec2(x, y));
}

/// The same with 32 bits, for triangles of up to SmallTexels texels.
void draw_small(GridTriangle t, uint side, ivec2 first, ivec2 last) {
  ivec3 step_x = grid_steps_x(t);
  ivec3 step_y = grid_steps_y(t);
  Uints maps = Uints(Table(push.table).v.maps);
  float level = masked && t.batch != NoIndex ? grid_mask_level(t) : 0.0;
  ivec2 at = first * SubTexels + SubTexels / 2;
  ivec3 rule = ivec3(edge_rule(step_x.x, step_y.x), edge_rule(step_x.y, step_y.y), edge_rule(step_x.z, step_y.z));
  ivec3 row = step_x * (at.x - ivec3(t.x1, t.x2, t.x0)) + step_y * (at.y - ivec3(t.y1, t.y2, t.y0)) - rule;
  for (int y = first.y; y <= last.y; ++y) {
    ivec3 edges = row;
    uint word = t.target + uint(y) * side + uint(first.x);
    for (int x = first.x; x <= last.x; ++x) {
      if ((edges.x | edges.y | edges.z) >= 0) draw_texel(maps, word, t, vec3(edges), level);
      edges += step_x * SubTexels;
      ++word;
    }
    row += step_y * SubTexels;
  }
}

/// First and last texel whose centre lies in the triangle's box, within a rectangle.
TexelRect covered_rect(GridTriangle t, TexelRect within) {
  ivec2 lo = ivec2(min(t.x0, min(t.x1, t.x2)), min(t.y0, min(t.y1, t.y2)));
  ivec2 hi = ivec2(max(t.x0, max(t.x1, t.x2)), max(t.y0, max(t.y1, t.y2)));
  TexelRect rect;
  rect.first = max(ivec2(first_texel(lo.x), first_texel(lo.y)), within.first);
  rect.last = min(ivec2(last_texel(hi.x), last_texel(hi.y)), within.last);
  return rect;
}
