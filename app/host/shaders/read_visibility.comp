// Visibility of lights first … first + count - 1 as bytes, light by light; a thread has four neighbouring pixels. Whether
// a pair is evaluated follows from the light alone: a light that umbrage leaves out of the pixel's cluster reads as 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#include "packed_surface.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FramePush push; };

void visit_texel(uint texel) {
  if (push.looked_up != 0ul) atomicOr(Words(push.looked_up).at[texel / 32u], 1u << texel % 32u);
}
#define UMBRAGE_VISIT_TEXEL(texel) visit_texel(texel)
#define UMBRAGE_COUNT_TAPS
#define UMBRAGE_CHECK_TEXELS
#include "lighting.glsl"

struct Receiver {
  bool exists;
  vec3 position_ws, geometric_normal, normal;
  float depth;
  vec2 pixel;
};

Receiver receiver_at(Frame frame, uint index) {
  Receiver r;
  r.exists = false;
  if (index >= frame.data.width * frame.data.height) return r;
  ivec2 pixel = ivec2(index % frame.data.width, index / frame.data.width);
  r.depth = texelFetch(depth_target, pixel, 0).x;
  if (r.depth <= 0.0) return r;
  r.exists = true;
  r.pixel = vec2(pixel) + 0.5;
  r.position_ws = frame.data.eye_ws + offset_from_depth(frame, r.pixel, r.depth);
  r.geometric_normal = from_octahedral(texelFetch(geometric_normal_target, pixel, 0).xy);
  r.normal = unpack_normal(texelFetch(surface_target, pixel, 0));
  return r;
}

vec2 pixel_of(Frame frame, vec3 position_ws) {
  vec4 clip = frame.data.clip_from_offset * vec4(position_ws - frame.data.eye_ws, 1.0);
  return (clip.xy / max(clip.w, 1e-9) * 0.5 + 0.5) * vec2(frame.data.width, frame.data.height);
}

/// Twice the larger extent in pixels of a shadow texel on the receiver.
uint band_px(Frame frame, UmbrageFrame shadows, UmbrageCluster cluster, uint i, Receiver r) {
  vec3 du_ws, dv_ws;
  umbrage_texel_footprint(shadows, cluster, i, r.position_ws, r.geometric_normal, du_ws, dv_ws);
  vec2 du = abs(pixel_of(frame, r.position_ws + du_ws) - r.pixel);
  vec2 dv = abs(pixel_of(frame, r.position_ws + dv_ws) - r.pixel);
  float extent = max(max(du.x, du.y), max(dv.x, dv.y));
  return uint(clamp(ceil(2.0 * extent), 1.0, 255.0));
}

/// Replaces one byte of a word that no other thread touches.
void put_byte(uint64_t address, uint word, uint lane, uint value) {
  Words words = Words(address);
  words.at[word] = bitfieldInsert(words.at[word], value, int(8u * lane), 8);
}

void main() {
  Frame frame = Frame(push.frame);
  uint quad = ITEM_INDEX;
  uint quads = (frame.data.width * frame.data.height + 3u) / 4u;
  if (quad >= quads) return;
  Receiver receivers[4];
  for (uint lane = 0u; lane < 4u; ++lane) receivers[lane] = receiver_at(frame, 4u * quad + lane);

  Lights lights = Lights(frame.data.lights);
  for (uint l = 0u; l < push.count; ++l) {
    Lamp lamp = lamp_of(lights.at[push.first + l]);
    uint bytes = 0xffffffffu;
    for (uint lane = 0u; lane < 4u; ++lane) {
      Receiver r = receivers[lane];
      Incidence incidence;
      if (r.exists && reaches(lamp, r.position_ws, r.geometric_normal, r.normal, incidence)) {
        bytes = bitfieldInsert(bytes, 0u, int(8u * lane), 8);
      }
    }
    Words(push.output_buffer).at[l * quads + quad] = bytes;
    if (push.output_band != 0ul) Words(push.output_band).at[l * quads + quad] = 0u;
  }

  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  for (uint lane = 0u; lane < 4u; ++lane) {
    Receiver r = receivers[lane];
    if (!r.exists) continue;
    UmbrageCluster cluster = umbrage_cluster(shadows, r.pixel, r.depth);
    for (uint i = 0u; i < cluster.count; ++i) {
      uint l = umbrage_light(shadows, cluster, i).host_index - push.first;
      if (l >= push.count) continue;
      Incidence incidence;
      if (!reaches(lamp_of(lights.at[push.first + l]), r.position_ws, r.geometric_normal, r.normal, incidence)) continue;
      float visibility = umbrage_visibility(shadows, cluster, i, r.position_ws, r.geometric_normal);
      put_byte(push.output_buffer, l * quads + quad, lane, uint(round(clamp(visibility, 0.0, 1.0) * 254.0)));
      if (push.output_band != 0ul) {
        put_byte(push.output_band, l * quads + quad, lane, band_px(frame, shadows, cluster, i, r));
      }
    }
  }
}
