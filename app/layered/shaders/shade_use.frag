#version 460
// Colour of the layered uses: textured, lit by a sun with shadows; the mirror ball looks its surroundings up in the cube map.
#extension GL_GOOGLE_include_directive : require
#include "uses.glsl"
layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint host_index;
layout(location = 4) flat in uint view;
layout(location = 0) out vec4 color;

void main() {
  Uses data = Uses(uses);
  vec3 normal = normalize(normal_ws);
  if (host_index == data.ball_index) {
    vec3 from_eye = normalize(position_ws - data.eyes[min(view, 5u)].xyz);
    vec3 seen = textureLod(reflection, reflect(from_eye, normal), 0.0).rgb;
    float grazing = 1.0 - max(-dot(from_eye, normal), 0.0);
    color = vec4(mix(0.92, 1.0, grazing * grazing) * seen, 1.0);
    return;
  }
  Material material = Materials(data.materials).v[host_index];
  vec4 base = material.base_color;
  if (material.texture_slot != 0xffffffffu) base *= texture(textures[nonuniformEXT(material.texture_slot)], uv);
  if (base.a < material.alpha_cutoff) discard;
  float facing = max(dot(normal, data.to_sun.xyz), 0.0);
  float sun = facing > 0.0 ? facing * sun_visibility(data, position_ws, normal) : 0.0;
  vec3 light = 1.5 * sun * vec3(1.0, 0.95, 0.85) + 0.45 * sky(normal);
  color = vec4(base.rgb * light, 1.0);
}
