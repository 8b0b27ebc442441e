// Walks the caster tree for one light (O6). The tree is implicit, so the walk needs no stack: down to the first child, on to
// the next sibling, up when a group of siblings ends. All threads of a light walk the upper levels alike; of the lowest nodes
// each takes those that are its own, so that no barrier and no subgroup operation is needed and the order is fixed.
#extension GL_EXT_buffer_reference : require
#include "clusters/cluster_buffers.glsl"
#include "culling/culling_types.shared.h"
#include "views/cube_projection.shared.h"

UMB_ARRAY(Views, ShadowView, 4);
UMB_ARRAY(Drawn, CasterInstance, 8);
UMB_ARRAY(Commands, DrawCommand, 4);
UMB_ARRAY(DrawCountList, DrawCounts, 4);
layout(push_constant, scalar) uniform PushBlock { TraversePush push; };

/// true: of a light's views only those that the batch's box meets (CFM); false: all.
layout(constant_id = 0) const bool masks_views = false;

/// A caster that the light reaches.
void visit(uint caster, Box box);

/// Views of the light into which a box is drawn, one bit each.
uint view_mask(LightRecord light, Box box) {
  uint all = (1u << light.view_count) - 1u;
  if (light.views != ViewsCube || !masks_views) return all;
  // The projection of the vertices rounds differently from that of the box.
  vec3 slack = max(abs(box.lo - light.position_ws), abs(box.hi - light.position_ws)) * 1e-5;
  return face_mask(box.lo - light.position_ws - slack, box.hi - light.position_ws + slack) & all;
}

void walk(LightRecord light, uint thread) {
  TreeShape shape = Shape(push.shape).shape;
  uint height = shape.levels;   // 0 = leaves
  uint i = 0u;
  if (height == 0u) return;
  while (true) {
    if (height == 0u) {
      Box box = Boxes(push.leaves).v[i];
      if (light_meets_box(light, box)) visit(Uints(push.order).v[i], box);
    } else if ((height > 1u || i % TraverseThreads == thread) && light_meets_box(light, Boxes(push.nodes).v[shape.first[height - 1u] + i])) {
      --height;
      i *= TreeWidth;
      continue;
    }
    ++i;
    while (height < shape.levels && (i % TreeWidth == 0u || i >= (height == 0u ? shape.count : shape.nodes[height - 1u]))) {
      i = (i - 1u) / TreeWidth + 1u;
      ++height;
    }
    if (height >= shape.levels) return;
  }
}

bool caster_is_lit_by(uint caster, uint light_mask) {
  uint instance = Casters(push.casters).v[caster].instance;
  return instance != NoIndex && (Instances(push.instances).v[instance].light_mask & light_mask) != 0u;
}

void add_wide(uint value, bool triangles) {
  if (value == 0u) return;
  uint before = triangles ? atomicAdd(Counters(push.counters).counters.triangles_drawn_low, value)
                          : atomicAdd(Counters(push.counters).counters.batches_drawn_low, value);
  if (before + value >= before) return;
  if (triangles) atomicAdd(Counters(push.counters).counters.triangles_drawn_high, 1u);
  else atomicAdd(Counters(push.counters).counters.batches_drawn_high, 1u);
}
