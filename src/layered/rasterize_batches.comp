#version 460
// Compute writer: a workgroup a listed caster, a thread a triangle, which it transforms once and draws into every view. What is
// large or crosses a plane is queued; what finds the queue full is drawn here all the same.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "layered/layered_types.shared.h"
layout(local_size_x = 128) in;
layout(push_constant, scalar) uniform PushBlock { ComputeWritePush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
#include "layered/draw_texels.glsl"

void main() {
  uint caster = Uints(push.list).v[gl_WorkGroupID.x];
  scene = Scenes(push.scene).v[0];
  batch = LayeredBatches(scene.batches).v[LayeredCasters(scene.casters).v[caster].batch];
  instance = instance_of(scene, caster);
  first_block = 0u;
  block_step = 1u;
  for (uint triangle = gl_LocalInvocationIndex; triangle < batch.triangle_count; triangle += 128u) {
    WorldTriangle world = fetch_triangle(triangle);
    for (uint v = push.first_view; v < push.first_view + push.view_count; ++v) {
      if (each_view && !sees(scene.visible, caster, v)) continue;
      view = LayeredViews(scene.views).v[v];
      if (draw_in_view(world, true)) continue;
      uint place = atomicAdd(LayeredCounts(push.queue_count).v[0].padding, 1u);
      if (place < push.queue_room) {
        LargeTriangles(push.queue).v[place] = LargeTriangle(caster, triangle, v);
        atomicMax(LayeredCounts(push.queue_count).v[0].x, min(place + 1u, 65535u));
      } else {
        draw_in_view(world, false);
      }
    }
  }
}
