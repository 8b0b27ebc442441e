// Lights every pixel of the G-buffer; counts how many lights that took.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "host.glsl"
#include "targets.glsl"
#include "packed_surface.glsl"
#define UMBRAGE_COUNT_TAPS
#include "lighting.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FramePush push; };

layout(set = SetTargets, binding = 5) uniform samplerCube reflection_cube;

/// Of the mirror ball, looked up by direction: as if all that it shows were far away.
vec3 shade_mirror(Frame frame, vec3 position_ws, vec3 to_eye, vec3 base_color) {
  vec3 normal = normalize(position_ws - frame.data.mirror_ball.xyz);
  float grazing = clamp(1.0 - dot(to_eye, normal), 0.0, 1.0);
  vec3 share = mix(base_color, vec3(1.0), grazing * grazing * grazing * grazing * grazing);
  return share * textureLod(reflection_cube, reflect(-to_eye, normal), 0.0).rgb;
}

/// Close to the ball's surface, and as smooth as nothing else is.
bool is_mirror(Frame frame, vec3 position_ws, PackedSurface surface) {
  vec4 ball = frame.data.mirror_ball;
  return distance(position_ws, ball.xyz) < 1.01 * ball.w && surface.metallic == 1.0 && surface.roughness == 0.0;
}

vec3 shade_pixel(Frame frame, UmbrageFrame shadows, UmbrageCluster cluster, ivec2 pixel, float depth) {
  PackedSurface surface = unpack_surface(texelFetch(surface_target, pixel, 0));
  vec3 offset = offset_from_depth(frame, vec2(pixel) + 0.5, depth);
  vec3 position_ws = frame.data.eye_ws + offset;
  vec3 eye = to_eye(frame, offset);
  vec3 geometric_normal = from_octahedral(texelFetch(geometric_normal_target, pixel, 0).xy);
  Brdf brdf = make_brdf(surface.base_color, surface.metallic, surface.roughness, surface.normal, eye);
  bool mirror = is_mirror(frame, position_ws, surface);
  if (surface.unlit || mirror) cluster.count = 0u;
  vec3 lit = shade(frame, shadows, cluster, position_ws, geometric_normal, surface.normal, eye, brdf);
  vec3 radiance = surface.emissive + (surface.unlit ? vec3(0.0) : lit);
  if (mirror && !surface.unlit) radiance = shade_mirror(frame, position_ws, eye, surface.base_color);
  return radiance;
}

/// Of 8×8 pixels such that 4, 8, 16 or 32 invocations in a row lie together: they meet the same lights and read close texels.
uvec2 place_in_tile(uint i) {
  return uvec2((i & 3u) | (i >> 1u & 4u), (i >> 2u & 1u) | (i >> 3u & 6u));
}

/// Adds up what the picture took: once a subgroup, without a barrier.
void count_lights(Frame frame, uint lights) {
  uint sum = subgroupAdd(lights);
  uint most = subgroupMax(lights);
  if (subgroupElect()) {
    Counters counters = Counters(frame.data.counters);
    uint before = atomicAdd(counters.data.lighting_computations_low, sum);
    if (before + sum < before) atomicAdd(counters.data.lighting_computations_high, 1u);
    atomicMax(counters.data.most_lights_of_a_pixel, most);
  }
}

// Background, and what lies beyond the picture's edge, takes the same way as pixels with lights, and meets none: what is the same for
// all pixels can be read once for all where control flow is uniform.
void main() {
  Frame frame = Frame(push.frame);
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  ivec2 place = 8 * ivec2(gl_WorkGroupID.xy) + ivec2(place_in_tile(gl_LocalInvocationIndex));
  ivec2 size = ivec2(frame.data.width, frame.data.height);
  bool is_inside = all(lessThan(place, size));
  ivec2 pixel = min(place, size - 1);
  float depth = texelFetch(depth_target, pixel, 0).x;
  UmbrageCluster cluster = umbrage_cluster(shadows, vec2(pixel) + 0.5, depth);
  if (!is_inside) cluster.count = 0u;
  vec3 radiance = shade_pixel(frame, shadows, cluster, pixel, depth);
  if (is_inside) imageStore(color_target, pixel, depth > 0.0 ? vec4(radiance, 1.0) : vec4(0.0));
  count_lights(frame, cluster.count);
}
