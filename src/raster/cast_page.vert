#version 460
// A caster's vertex into a view whose texels fragments find themselves: through the page table, or in an image.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "raster/raster_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { CastPagePush push; };
layout(constant_id = 0) const bool masked = false;
#include "raster/cast_view.glsl"

layout(location = 0) out vec2 uv;
layout(location = 1) flat out uvec4 place;          // batch, first word, resolution, layer

void main() {
  gl_Position = clip_position_of_vertex(push.viewport_size);
  place = uvec4(geometry.w, texture_coordinates.w, uint(x_row.w), uint(y_row.w));
  uv = masked ? uv_of_vertex() : vec2(0.0);
}
