// A box from nothing but its index: 36 vertices, flat normals.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(push_constant, scalar) uniform Push {
  mat4 clip_from_world;
  vec3 center_ws;
  vec3 half_extent;
} push;
layout(location = 0) flat out vec3 normal_ws;

const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));

void main() {
  int face = gl_VertexIndex / 6;
  int axis = face >> 1;
  vec2 corner = corners[gl_VertexIndex % 6];
  vec3 unit;
  unit[axis] = (face & 1) == 0 ? -1.0 : 1.0;
  unit[(axis + 1) % 3] = corner.x;
  unit[(axis + 2) % 3] = corner.y;
  normal_ws = vec3(0.0);
  normal_ws[axis] = unit[axis];
  gl_Position = push.clip_from_world * vec4(push.center_ws + unit * push.half_extent, 1.0);
}
