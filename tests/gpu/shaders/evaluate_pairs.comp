// What a host's shading asks of umbrage.glsl: the visibility of every light of every pixel's cluster, where the light is in range
// and in front. Taps are counted. A negative answer: not asked.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UMBRAGE_SET 0
#define UMBRAGE_COUNT_TAPS
#define UMBRAGE_CHECK_TEXELS
#include "umbrage/shaders/umbrage.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
struct Sample {
  vec3 position_ws;
  vec3 normal_ws;
  float depth;
};
layout(buffer_reference, scalar) readonly buffer Samples { Sample v[]; };
layout(buffer_reference, scalar) writeonly buffer Floats { float v[]; };
layout(buffer_reference, scalar) writeonly buffer Words { uint v[]; };
layout(push_constant, scalar) uniform Push {
  uint64_t shadows;
  uint64_t samples;
  uint64_t visibility;   // [pixel][host_index]
  uint64_t clusters;     // of each pixel
  uint width;
  uint height;
  uint lights;
} push;

bool is_lit(UmbrageLight light, Sample point) {
  if (light.type == UmbrageLightDirectional) return dot(point.normal_ws, light.direction_ws) < 0.0;
  vec3 to_light = light.position_ws - point.position_ws;
  if (dot(to_light, to_light) > light.range_m * light.range_m || dot(point.normal_ws, to_light) <= 0.0) return false;
  return light.type == UmbrageLightPoint || -dot(to_light, light.direction_ws) > light.cos_outer * length(to_light);
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= push.width || pixel.y >= push.height) return;
  uint i = pixel.y * push.width + pixel.x;
  Sample point = Samples(push.samples).v[i];
  UmbrageFrame frame = umbrage_frame(push.shadows);
  UmbrageCluster cluster = umbrage_cluster(frame, vec2(pixel) + 0.5, point.depth);
  Words(push.clusters).v[i] = cluster.index;
  for (uint light = 0u; light < push.lights; ++light) Floats(push.visibility).v[i * push.lights + light] = -1.0;
  for (uint k = 0u; k < cluster.count; ++k) {
    UmbrageLight light = umbrage_light(frame, cluster, k);
    if (!is_lit(light, point)) continue;
    Floats(push.visibility).v[i * push.lights + light.host_index] = umbrage_visibility(frame, cluster, k, point.position_ws, point.normal_ws);
  }
}
