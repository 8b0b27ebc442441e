// Buffers by address, the camera's geometry, octahedral normals: what every shader of the host shares.
#ifndef APP_HOST_GLSL
#define APP_HOST_GLSL
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "host.shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Frame { GpuFrame data; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Instances { GpuInstance at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Primitives { GpuPrimitive at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Materials { GpuMaterial at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Lights { GpuLight at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Counters { GpuCounters data; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Subject { GpuSubject data; GpuLightUse uses[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats { float at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Vec2s { vec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Vec3s { vec3 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Vec4s { vec4 at[]; };

/// Index of this invocation in a dispatch_items(); the local size is one-dimensional.
#define ITEM_INDEX \
  ((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x)

const float Pi = 3.14159265358979;

vec2 octahedral(vec3 n) {
  vec2 folded = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 signs = vec2(folded.x >= 0.0 ? 1.0 : -1.0, folded.y >= 0.0 ? 1.0 : -1.0);
  return n.z >= 0.0 ? folded : (1.0 - abs(folded.yx)) * signs;
}

vec3 from_octahedral(vec2 folded) {
  vec3 n = vec3(folded, 1.0 - abs(folded.x) - abs(folded.y));
  float below = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -below : below;
  n.y += n.y >= 0.0 ? -below : below;
  return normalize(n);
}

float luminance(vec3 linear) { return dot(linear, vec3(0.2126, 0.7152, 0.0722)); }

/// World position relative to the eye of a point of the picture. pixel: with the half. device_depth > 0.
vec3 offset_from_depth(Frame frame, vec2 pixel, float device_depth) {
  vec4 lens = frame.data.lens_depth;
  float z = (device_depth * lens.w - lens.y) / (device_depth * lens.z + lens.x);
  float w = lens.w - lens.z * z;
  vec2 clip = (2.0 * pixel / vec2(frame.data.width, frame.data.height) - 1.0) * w;
  vec2 xy = clip / frame.data.lens_scale;
  return frame.data.right_ws * xy.x + frame.data.up_ws * xy.y + frame.data.back_ws * z;
}

/// From a point towards the eye, unit length. offset: of the point from the eye.
vec3 to_eye(Frame frame, vec3 offset) {
  return frame.data.orthographic != 0u ? frame.data.back_ws : normalize(-offset);
}
#endif
