// Walks the caster tree (O6). The tree is implicit, so the walk needs no stack: down to the first child, on to the next
// sibling, up when a group of siblings ends. All threads of a workgroup walk the upper levels alike; of the lowest nodes each
// takes those that are its own, so that no barrier and no subgroup operation is needed and the order is fixed.
// Expects `push` with casters, instances, order, leaves, nodes, shape and counters.

/// Views that a leaf (height 0) or something in a node may be drawn into, one bit each. One call for both: the threads of a
/// subgroup are at different heights most of the time.
uint views_of(Box box, uint height);
/// A leaf with views.
void visit(uint leaf, uint views);

void walk(uint thread) {
  TreeShape shape = Shape(push.shape).shape;
  uint height = shape.levels;
  uint i = 0u;
  if (height == 0u) return;
  while (true) {
    uint views = 0u;
    if (height != 1u || i % TraverseThreads == thread) {
      Box box;
      if (height == 0u) box = Boxes(push.leaves).v[i];
      else box = Boxes(push.nodes).v[shape.first[height - 1u] + i];
      views = views_of(box, height);
    }
    if (views != 0u && height > 0u) {
      --height;
      i *= TreeWidth;
      continue;
    }
    if (views != 0u) visit(i, views);
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
