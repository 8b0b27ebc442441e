#version 460
// Compute writer: a workgroup a queued triangle, a thread a block of 32×32 texels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "layered/layered_types.shared.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { ComputeWritePush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "layered/draw_texels.glsl"

void main() {
  uint queued = min(LayeredCounts(push.queue_count).v[0].padding, push.queue_room);
  first_block = gl_LocalInvocationIndex;
  block_step = 64u;
  scene = Scenes(push.scene).v[0];
  for (uint i = gl_WorkGroupID.x; i < queued; i += gl_NumWorkGroups.x) {
    LargeTriangle large = LargeTriangles(push.queue).v[i];
    batch = LayeredBatches(scene.batches).v[LayeredCasters(scene.casters).v[large.caster].batch];
    if ((batch.mask != NoIndex) != masked) continue;
    instance = instance_of(scene, large.caster);
    view = LayeredViews(scene.views).v[large.view];
    draw_in_view(fetch_triangle(large.triangle), false);
  }
}
