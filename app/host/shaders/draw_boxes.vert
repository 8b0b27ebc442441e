// The twelve edges of one cluster's box an instance, a hair in front of the surface that they wrap.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#define UMBRAGE_SET 2
#include "umbrage/shaders/umbrage.glsl"
#include "palette.glsl"

layout(push_constant, scalar) uniform Push { ShowPush push; };
layout(location = 0) out vec3 color;

// Edge e runs along axis e / 4 from the corner that the two low bits of e choose on the other axes.
vec3 corner_of(uint vertex) {
  uint edge = vertex / 2u, axis = edge / 4u;
  vec3 corner;
  corner[axis] = float(vertex & 1u);
  corner[(axis + 1u) % 3u] = float(edge & 1u);
  corner[(axis + 2u) % 3u] = float(edge >> 1 & 1u);
  return corner;
}

void main() {
  Frame frame = Frame(push.frame);
  vec3 low, high;
  umbrage_cluster_box(umbrage_frame(frame.data.umbrage), gl_InstanceIndex, low, high);
  vec3 position_ws = mix(low, high, corner_of(gl_VertexIndex));
  gl_Position = frame.data.clip_from_offset * vec4(position_ws - frame.data.eye_ws, 1.0);
  gl_Position.z += 2e-3 * abs(gl_Position.z);
  color = hash_color(gl_InstanceIndex);
}
