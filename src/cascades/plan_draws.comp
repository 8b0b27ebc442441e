#version 460
// Counts → arguments of the next indirect dispatch.
#extension GL_GOOGLE_include_directive : require
#include "cascades/cascade_buffers.glsl"
#include "gpu/groups.glsl"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform PushBlock { CascadePush push; };

void main() {
  Arguments arguments = Arguments(push.arguments);
  if (push.step == PlanLarges) {
    uvec3 groups = groups_for(min(arguments.v.larges, push.count));
    arguments.v.large_groups = uint[](groups.x, groups.y, groups.z);
    return;
  }
  uvec3 groups = groups_for(push.step == PlanStatics ? arguments.v.statics : arguments.v.actives);
  if (push.step == PlanStatics) arguments.v.static_groups = uint[](groups.x, groups.y, groups.z);
  else arguments.v.active_groups = uint[](groups.x, groups.y, groups.z);
  arguments.v.larges = 0u;
}
