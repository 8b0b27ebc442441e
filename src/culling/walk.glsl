// Walks the caster tree (O6). The tree is implicit, so the walk needs no stack: down to the first child, on to the next
// sibling, up when a group of siblings ends. Each lowest node is one thread's of the workgroup, which looks only at what leads
// there; no barrier and no subgroup operation is needed, and the order is fixed.
// Expects `push` with casters, instances, order, leaves, nodes, shape and counters.

/// Views that leaf i (height 0) or something in a node may be drawn into, one bit each. One call for both: the threads of a
/// subgroup are at different heights most of the time.
uint views_of(Box box, uint height, uint i);
/// A leaf with views.
void visit(uint leaf, uint views);

/// Nodes i with i % stride == own are a thread's: lowest ones, and those above them that hold one.
uint stride_of(uint height) { return height == 1u ? TraverseThreads : height == 2u ? TraverseThreads / TreeWidth : 1u; }
uint own_of(uint height, uint thread) { return height == 1u ? thread : height == 2u ? thread / TreeWidth : 0u; }

void walk(uint thread) {
  TreeShape shape = Shape(push.shape).shape;
  uint height = shape.levels;   // 0: leaves
  if (height == 0u) return;
  uint i = own_of(height, thread);
  uint end = 1u;                // of the siblings
  while (true) {
    if (i >= end) {
      if (++height > shape.levels) return;
      i = (end - 1u) / TreeWidth;
      end = min((i / TreeWidth + 1u) * TreeWidth, shape.nodes[height - 1u]);
      i += stride_of(height);
      continue;
    }
    Box box;
    if (height == 0u) box = Boxes(push.leaves).v[i];
    else box = Boxes(push.nodes).v[shape.first[height - 1u] + i];
    uint views = views_of(box, height, i);
    if (views != 0u && height > 0u) {
      --height;
      uint begin = i * TreeWidth;
      end = min(begin + TreeWidth, height == 0u ? shape.count : shape.nodes[height - 1u]);
      i = begin + (own_of(height, thread) - begin) % stride_of(height);
      continue;
    }
    if (views != 0u) visit(i, views);
    i += stride_of(height);
  }
}

/// Casters of the finest level.
bool caster_is_lit_by(uint index, uint light_mask) {
  CasterRecord caster = Casters(push.casters).v[index];
  return caster.instance != NoIndex && (Instances(push.instances).v[caster.instance].light_mask & light_mask) != 0u &&
         is_finest(Batches(push.batches).v[caster.batch]);
}

void add_wide(uint value, bool triangles) {
  if (value == 0u) return;
  uint before = triangles ? atomicAdd(Counters(push.counters).counters.triangles_drawn_low, value)
                          : atomicAdd(Counters(push.counters).counters.batches_drawn_low, value);
  if (before + value >= before) return;
  if (triangles) atomicAdd(Counters(push.counters).counters.triangles_drawn_high, 1u);
  else atomicAdd(Counters(push.counters).counters.batches_drawn_high, 1u);
}
