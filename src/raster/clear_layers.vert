#version 460
// Empties the layers that this frame's maps use: a square over a map's texels, at depth 0, an instance a layer.
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "gpu/buffers.glsl"
#include "raster/raster_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { ClearLayersPush push; };

void main() {
  uint entry = Uints(push.layers).v[gl_InstanceIndex];   // layer, and texels along the map's side
  float side = float(entry >> 16u) / push.image_side;
  vec2 corner = vec2(gl_VertexIndex == 1 || gl_VertexIndex == 4 || gl_VertexIndex == 5, gl_VertexIndex == 2 || gl_VertexIndex == 3 || gl_VertexIndex == 5);
  gl_Position = vec4(corner * 2.0 * side - 1.0, 0.0, 1.0);
  gl_Layer = int(entry & 0xffffu);
}
