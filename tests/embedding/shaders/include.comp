// umbrage.glsl in this stage, next to nothing else.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define UMBRAGE_DEBUG
#define UMBRAGE_SET 1
#include "umbrage/shaders/umbrage.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { float value[]; };
layout(push_constant) uniform Push { uint64_t shadows; } push;

void main() {
  UmbrageFrame shadows = umbrage_frame(push.shadows);
  vec3 position_ws = vec3(gl_GlobalInvocationID);
  UmbrageCluster near = umbrage_cluster_at(shadows, position_ws);
  UmbrageCluster seen = umbrage_cluster(shadows, position_ws.xy, 0.5);
  float lit = 0.0;
  for (uint i = 0u; i < near.count; i++) lit += umbrage_visibility(shadows, near, i, position_ws, vec3(0.0, 1.0, 0.0));
  for (uint i = 0u; i < seen.count; i++) {
    UmbrageLight light = umbrage_light(shadows, seen, i);
    lit += float(light.host_index) * umbrage_visibility(shadows, light, position_ws, vec3(0.0, 1.0, 0.0));
  }
  value[gl_GlobalInvocationID.x] = lit;
}
