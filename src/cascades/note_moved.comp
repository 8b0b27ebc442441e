#version 460
// Casters that moved, came or went → when they did, and which static maps that breaks. A thread a caster; CPU and GPU cost
// follow the edits.
#extension GL_GOOGLE_include_directive : require
#include "cascades/cascade_buffers.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { CascadePush push; };

bool is_fixed(uint caster) {
  uint instance = Casters(push.casters).v[caster].instance;
  return instance != NoIndex && (Instances(push.instances).v[instance].flags & InstanceIsFixed) != 0u;
}

void main() {
  if (gl_GlobalInvocationID.x >= push.count) return;
  bool begins = push.moved == 0ul;   // nothing is known of any caster
  uint caster = begins ? gl_GlobalInvocationID.x : Uints(push.moved).v[gl_GlobalInvocationID.x];
  Table table = Table(push.table);
  Uints moved_at = Uints(table.v.moved_at);
  Boxes known = Boxes(table.v.known_boxes);
  Box former = known.v[caster];
  if (!begins && !box_is_empty(former) && is_static_at(moved_at.v[caster], table.v.before, table.v.static_after)) {
    for (uint i = 0u; i < table.v.cascades; ++i) {
      CascadeRecord cascade = table.v.records[i];
      if (move_breaks_map(cascade, grid_box(cascade, former))) States(table.v.states).v[i].is_broken = 1u;
    }
  }
  known.v[caster] = Boxes(push.boxes).v[caster];
  moved_at.v[caster] = table.v.now | (is_fixed(caster) ? NeverMoves : 0u);
}
