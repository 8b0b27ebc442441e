#version 460
// Is each static map kept, scrolled or cleared? Counters begin anew.
#extension GL_GOOGLE_include_directive : require
#include "cascades/cascade_buffers.glsl"
layout(local_size_x = MaxCascades) in;
layout(push_constant, scalar) uniform PushBlock { CascadePush push; };

uint area(TexelRect rect) { return rect_is_empty(rect) ? 0u : uint((rect.last.x - rect.first.x + 1) * (rect.last.y - rect.first.y + 1)); }

void main() {
  Table table = Table(push.table);
  uint i = gl_LocalInvocationIndex;
  if (i == 0u) Arguments(push.arguments).v.statics = Arguments(push.arguments).v.actives = 0u;
  if (i >= table.v.cascades) return;
  CascadeRecord cascade = table.v.records[i];
  CascadeState state = States(table.v.states).v[i];
  uint action = action_of(cascade, state.is_broken != 0u);
  uint exposed = 0u;
  if (action == MapIsCleared) exposed = area(region_rect(cascade, RegionWhole));
  if (action == MapIsScrolled) exposed = area(region_rect(cascade, RegionColumns)) + area(region_rect(cascade, RegionRows));
  uint front = action == MapIsScrolled ? 1u - state.front : state.front;
  States(table.v.states).v[i] = CascadeState(0u, front, action, 0u, 0u, 0u, 0u, 0u, exposed, 0u);
}
