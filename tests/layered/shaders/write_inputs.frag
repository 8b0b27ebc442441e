#version 460
// Everything that a host's fragment shader of a colour pass is given, as one colour.
layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint host_index;
layout(location = 4) flat in uint view;
layout(location = 0) out vec4 color;

void main() { color = vec4(dot(position_ws, vec3(1.0, 2.0, 4.0)), dot(normalize(normal_ws), vec3(1.0, 2.0, 4.0)), uv.x + 2.0 * uv.y, float(host_index * 1000u + view)); }
