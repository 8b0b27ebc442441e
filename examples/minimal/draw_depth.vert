// Depth of the scene, for the camera.
#version 460
layout(location = 0) in vec3 position_ws;
layout(push_constant) uniform Push { mat4 clip_from_world; } push;
void main() { gl_Position = push.clip_from_world * vec4(position_ws, 1.0); }
