#version 460
// Alpha-masked batches of a depth-only pass: what the mask cuts out is not drawn.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "layered/layered_buffers.glsl"
layout(push_constant, scalar) uniform PushBlock { LayeredPush push; };
layout(set = 0, binding = 0) uniform sampler2D masks[];
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint batch_index;

void main() {
  LayeredBatch batch = LayeredBatches(push.batches).v[batch_index];
  if (batch.mask != NoIndex && texture(masks[nonuniformEXT(batch.mask)], uv).a * batch.alpha_factor < batch.alpha_cutoff) discard;
}
