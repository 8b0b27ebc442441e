#version 460
// A caster's vertex into a layer of an array of depth images (O12): the viewport covers an image.
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "scene/scene_buffers.glsl"
#include "raster/raster_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { CastPush push; };
layout(constant_id = 0) const bool masked = false;
#include "raster/cast_view.glsl"

layout(location = 0) out vec2 uv;
layout(location = 1) flat out uint batch_index;

void main() {
  gl_Position = clip_position_of_vertex(push.viewport_size);
  gl_Layer = int(y_row.w);
  batch_index = geometry.w;
  uv = masked ? uv_of_vertex() : vec2(0.0);
}
