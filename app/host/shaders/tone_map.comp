// Linear radiance to the picture: exposure, background, AgX (T. Sobotka; polynomial fit by B. Wrensch), sRGB bytes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { FramePush push; };

const mat3 agx_inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                            0.0784335999999992, 0.878468636469772, 0.0784336,
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const mat3 agx_outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
const float first_stop = -12.47393;
const float last_stop = 4.026069;
const vec3 background = vec3(0.018, 0.019, 0.022);  // After exposure.

vec3 agx_contrast(vec3 x) {
  vec3 x2 = x * x, x4 = x2 * x2;
  return 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
}

/// Display-encoded, with saturation lifted a little: AgX alone greys coloured lamps.
vec3 agx(vec3 linear) {
  vec3 stops = log2(max(agx_inset * linear, vec3(1e-10)));
  vec3 encoded = agx_contrast(clamp((stops - first_stop) / (last_stop - first_stop), 0.0, 1.0));
  encoded = mix(vec3(luminance(encoded)), encoded, 1.15);
  return clamp(agx_outset * encoded, 0.0, 1.0);
}

void main() {
  Frame frame = Frame(push.frame);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(frame.data.width) || pixel.y >= int(frame.data.height)) return;
  vec4 color = imageLoad(color_target, pixel);
  vec3 exposed = color.rgb * Counters(frame.data.counters).data.exposure + (1.0 - color.a) * background;
  imageStore(picture_target, pixel, vec4(agx(exposed), 1.0));
}
