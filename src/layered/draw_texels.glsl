// A batch's triangle into one view's texels, with the arithmetic of raster/triangle.shared.h: 8 sub-pixel bits, the top-left
// rule, depth from exact edge functions. Includer: push (ComputeWritePush), masks[].
#include "layered/transform.glsl"
#include "raster/triangle.glsl"
layout(constant_id = 4) const bool is_reversed = false;  // larger is nearer
layout(constant_id = 5) const bool masked = false;
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Scenes { LayeredPush v[]; };

/// Texels along a block's side, within which edge functions have 32 bits.
const int BlockSide = 32;
/// Boxes of more texels than this are left to a workgroup.
const int QueuedTexels = 2048;

LayeredPush scene;
LayeredBatch batch;
LayeredInstanceRecord instance;
LayeredViewRecord view;
uint first_block;   // of those that this thread draws
uint block_step;

struct WorldTriangle {
  vec3 position[3];
  vec2 uv[3];
};

WorldTriangle fetch_triangle(uint triangle) {
  WorldTriangle t;
  for (uint i = 0u; i < 3u; ++i) {
    uint vertex = Uints(push.indices).v[batch.first_index + 3u * triangle + i];
    t.position[i] = world_position(scene, instance, vertex);
    t.uv[i] = masked ? texture_coordinates(scene, vertex) : vec2(0.0);
  }
  return t;
}

bool is_cut_out(RasterTriangle t, vec3 weights, float level) {
  return textureLod(masks[nonuniformEXT(batch.mask)], mask_coordinates(t, weights), level).a * batch.alpha_factor < batch.alpha_cutoff;
}

void draw_block(RasterTriangle t, ivec2 lo, ivec2 hi) {
  ivec3 step_x = steps_x(t);
  ivec3 step_y = steps_y(t);
  ivec2 at = lo * SubTexels + SubTexels / 2;
  EdgeStart a = start_edge(step_x.x, step_y.x, at.x - t.x1, at.y - t.y1);
  EdgeStart b = start_edge(step_x.y, step_y.y, at.x - t.x2, at.y - t.y2);
  EdgeStart c = start_edge(step_x.z, step_y.z, at.x - t.x0, at.y - t.y0);
  ivec3 row_edges = ivec3(a.value, b.value, c.value);
  vec3 fractions = vec3(a.fraction, b.fraction, c.fraction);
  float level = masked ? mask_level(t, textureSize(masks[nonuniformEXT(batch.mask)], 0)) : 0.0;
  Uints keys = Uints(push.keys);
  uint row = ((view.layer - push.first_layer) * push.height + view.y + uint(lo.y)) * push.width + view.x + uint(lo.x);
  for (int y = lo.y; y <= hi.y; ++y, row_edges += step_y, row += push.width) {
    ivec3 edges = row_edges;
    for (int x = 0; x <= hi.x - lo.x; ++x, edges += step_x) {
      if ((edges.x | edges.y | edges.z) < 0) continue;
      uint key = depth_key(t, edges, fractions);
      uint texel = row + uint(x);
      bool nearer = is_reversed ? key > keys.v[texel] : key < keys.v[texel];
      if (!nearer || (masked && is_cut_out(t, vec3(edges) + fractions, level))) continue;
      if (is_reversed) atomicMax(keys.v[texel], key);
      else atomicMin(keys.v[texel], key);
    }
  }
}

/// False: too large for one thread, and nothing has been drawn.
bool draw_placed(ClipVertex a, ClipVertex b, ClipVertex c, bool may_refuse) {
  PlacedVertex p[3];
  ClipVertex v[3] = ClipVertex[3](a, b, c);
  for (uint i = 0u; i < 3u; ++i) {
    PlacedVertex down;
    if (!place_vertex(v[i].position, view.width, p[i]) || !place_vertex(v[i].position, view.height, down)) return true;
    p[i].y = down.y;
  }
  int64_t area = int64_t(p[1].x - p[0].x) * int64_t(p[2].y - p[0].y) - int64_t(p[1].y - p[0].y) * int64_t(p[2].x - p[0].x);
  if (area == 0l) return true;
  uint second = area > 0l ? 1u : 2u;
  uint third = 3u - second;
  RasterTriangle t;
  t.x0 = p[0].x, t.y0 = p[0].y, t.x1 = p[second].x, t.y1 = p[second].y, t.x2 = p[third].x, t.y2 = p[third].y;
  precise vec3 z = vec3(p[0].z, p[second].z, p[third].z) * (float(SubTexels) / abs(float(area)));
  t.z = z;
  t.z_min = min(p[0].z, min(p[1].z, p[2].z));
  t.z_max = max(p[0].z, max(p[1].z, p[2].z));
  t.q = vec3(p[0].reciprocal_w, p[second].reciprocal_w, p[third].reciprocal_w);
  t.u = vec3(a.uv.x, v[second].uv.x, v[third].uv.x) * t.q;
  t.v = vec3(a.uv.y, v[second].uv.y, v[third].uv.y) * t.q;
  ivec2 first = max(ivec2(first_texel(min(t.x0, min(t.x1, t.x2))), first_texel(min(t.y0, min(t.y1, t.y2)))), ivec2(0));
  ivec2 last = min(ivec2(last_texel(max(t.x0, max(t.x1, t.x2))), last_texel(max(t.y0, max(t.y1, t.y2)))),
                   ivec2(view.width, view.height) - 1);
  if (first.x > last.x || first.y > last.y) return true;
  ivec2 size = last - first + 1;
  if (may_refuse && size.x * size.y > QueuedTexels) return false;
  uvec2 blocks = uvec2(size + BlockSide - 1) / uint(BlockSide);
  for (uint i = first_block; i < blocks.x * blocks.y; i += block_step) {
    ivec2 lo = first + ivec2(i % blocks.x, i / blocks.x) * BlockSide;
    draw_block(t, lo, min(lo + BlockSide - 1, last));
  }
  return true;
}

/// False: left to a workgroup (only with may_refuse).
bool draw_in_view(WorldTriangle world, bool may_refuse) {
  if (is_culled_face(world.position[0], world.position[1], world.position[2], view.eye, instance.handedness, cull_faces)) return true;
  ClipVertex corner[9];
  for (uint i = 0u; i < 3u; ++i) corner[i] = ClipVertex(view_clip(view, world.position[i]), world.uv[i]);
  if (is_outside(corner[0].position, corner[1].position, corner[2].position)) return true;
  float guard = clip_guard(max(view.width, view.height));
  bool inside = is_inside_guard(corner[0].position, guard) && is_inside_guard(corner[1].position, guard) &&
                is_inside_guard(corner[2].position, guard);
  if (inside) return draw_placed(corner[0], corner[1], corner[2], may_refuse);
  if (may_refuse) return false;
  uint count = clip_triangle(corner, guard);
  for (uint next = 2u; next < count; ++next) draw_placed(corner[0], corner[next - 1u], corner[next], false);
  return true;
}
