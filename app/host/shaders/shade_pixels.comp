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

vec3 shade_pixel(Frame frame, UmbrageFrame shadows, ivec2 pixel, float depth, out uint lights) {
  PackedSurface surface = unpack_surface(texelFetch(surface_target, pixel, 0));
  UmbrageCluster cluster = umbrage_cluster(shadows, vec2(pixel) + 0.5, depth);
  lights = cluster.count;
  if (surface.unlit) return surface.emissive;

  vec3 offset = offset_from_depth(frame, vec2(pixel) + 0.5, depth);
  vec3 eye = to_eye(frame, offset);
  vec3 geometric_normal = from_octahedral(texelFetch(geometric_normal_target, pixel, 0).xy);
  if (is_mirror(frame, frame.data.eye_ws + offset, surface))
    return shade_mirror(frame, frame.data.eye_ws + offset, eye, surface.base_color);
  Brdf brdf = make_brdf(surface.base_color, surface.metallic, surface.roughness, surface.normal, eye);
  return surface.emissive +
         shade(frame, shadows, cluster, frame.data.eye_ws + offset, geometric_normal, surface.normal, eye, brdf);
}

/// Of 8×8 pixels such that 4, 8, 16 or 32 invocations in a row lie together: they meet the same lights and read close texels.
uvec2 place_in_tile(uint i) {
  return uvec2((i & 3u) | (i >> 1u & 4u), (i >> 2u & 1u) | (i >> 3u & 6u));
}

/// Adds up what the picture took: once a subgroup, without a barrier.
void count_lights(Frame frame, uint lights) {
  uint sum = subgroupAdd(lights);
  uint most = subgroupMax(lights);
  if (!subgroupElect()) return;
  Counters counters = Counters(frame.data.counters);
  uint before = atomicAdd(counters.data.lighting_computations_low, sum);
  if (before + sum < before) atomicAdd(counters.data.lighting_computations_high, 1u);
  atomicMax(counters.data.most_lights_of_a_pixel, most);
}

void main() {
  Frame frame = Frame(push.frame);
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  ivec2 pixel = 8 * ivec2(gl_WorkGroupID.xy) + ivec2(place_in_tile(gl_LocalInvocationIndex));
  if (pixel.x >= int(frame.data.width) || pixel.y >= int(frame.data.height)) return;
  float depth = texelFetch(depth_target, pixel, 0).x;
  uint lights = 0u;
  vec4 color = vec4(0.0);
  if (depth > 0.0) color = vec4(shade_pixel(frame, shadows, pixel, depth, lights), 1.0);
  imageStore(color_target, pixel, color);
  count_lights(frame, lights);
}
