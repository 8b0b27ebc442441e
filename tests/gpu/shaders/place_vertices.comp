// Rounding and placing of vertices as the page rasteriser does them, for comparison with the same functions on the CPU.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference2 : require
#include "raster/triangle.shared.h"
layout(local_size_x = 64) in;
layout(buffer_reference, scalar) readonly buffer Positions { vec4 v[]; };
layout(buffer_reference, scalar) buffer Places { ivec4 v[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t positions;
  uint64_t places;
  uint count;
  uint resolution;
} push;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= push.count) return;
  vec4 position = Positions(push.positions).v[i];
  PlacedVertex placed;
  bool valid = place_vertex(position, push.resolution, placed);
  Places(push.places).v[i] = ivec4(placed.x, placed.y, round_to_int(position.x * 4096.0), valid ? 1 : 0);
}
