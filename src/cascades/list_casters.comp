#version 460
// The sets of C2 and C3: static casters that are drawn into static maps, each with its regions, and active ones. A workgroup a
// cascade walks the caster tree. S, S' and A are never stored: they are times and volume tests.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
#include "cascades/cascade_types.shared.h"
layout(local_size_x = TraverseThreads) in;
layout(push_constant, scalar) uniform PushBlock { ListCascadesPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Table { CascadeTable v; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Arguments { CascadeArguments v; };
UMB_ARRAY(States, CascadeState, 4);
UMB_ARRAY(CascadeItems, CascadeItem, 4);
#include "culling/walk.glsl"

Table table;
CascadeRecord cascade;
uint cascade_index;
uint action;

uint views_of(Box box, uint height, uint i) {
  return !box_is_empty(box) && box_meets_volume(grid_box(cascade, box), cascade.origin, cascade.side) ? 1u : 0u;
}

void visit(uint leaf, uint views) {
  uint caster = Uints(push.order).v[leaf];
  uint moved_at = Uints(table.v.moved_at).v[caster];
  bool all_static = (cascade.flags & CascadeAllStatic) != 0u;
  bool is_static = all_static || is_static_at(moved_at, table.v.now, table.v.static_after);
  uint regions = RegionWhole;
  if (is_static) {
    bool was_static = all_static || is_static_at(moved_at, table.v.before, table.v.static_after);
    if (action == MapIsKept && was_static) return;
    regions = static_regions(cascade, action, grid_box(cascade, Boxes(push.leaves).v[leaf]), was_static);
  }
  if (regions == 0u || !caster_is_lit_by(caster, cascade.light_mask)) return;
  Arguments arguments = Arguments(push.arguments);
  States states = States(table.v.states);
  uint place;
  if (is_static) {
    place = atomicAdd(arguments.v.statics, 1u);
    atomicAdd(states.v[cascade_index].statics, 1u);
  } else {
    place = push.capacity + atomicAdd(arguments.v.actives, 1u);
    atomicAdd(states.v[cascade_index].actives, 1u);
    states.v[cascade_index].shows_work = 1u;
  }
  CascadeItems(push.items).v[place] = CascadeItem(caster, cascade_index, regions);
}

void main() {
  cascade_index = gl_WorkGroupID.x;
  table = Table(push.table);
  cascade = table.v.records[cascade_index];
  action = States(table.v.states).v[cascade_index].action;
  walk(gl_LocalInvocationIndex);
}
