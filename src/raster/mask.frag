#version 460
// Alpha-masked casters: what the mask cuts out casts nothing. The level of detail follows the shadow texel's footprint.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "scene/scene_buffers.glsl"
#include "raster/raster_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { CastPush push; };
layout(set = 1, binding = 0) uniform sampler2D masks[];
layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint batch_index;

void main() {
  BatchRecord batch = Batches(push.batches).v[batch_index];
  if (batch.mask != NoIndex && texture(masks[nonuniformEXT(batch.mask)], uv).a * batch.alpha_factor < batch.alpha_cutoff) discard;
}
