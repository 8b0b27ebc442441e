// Depth, geometric and shading normal, material of what is opaque or cut out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "material.glsl"

layout(constant_id = 0) const bool masked = false;
layout(push_constant, scalar) uniform Push { FramePush push; };

layout(location = 0) out vec2 out_geometric_normal;
layout(location = 1) out vec2 out_normal;
layout(location = 2) out vec4 out_base_color;
layout(location = 3) out vec2 out_metal_rough;
layout(location = 4) out vec4 out_emissive;

void main() {
  Frame frame = Frame(push.frame);
  GpuMaterial material = Materials(frame.data.materials).at[material_index];
  vec4 base_color = base_color_of(material);
  Surface s = evaluate_material(frame, material, base_color);
  if (masked && base_color.a < material.alpha_cutoff) discard;
  out_geometric_normal = octahedral(s.geometric_normal);
  out_normal = octahedral(s.normal);
  out_base_color = vec4(base_color.rgb, s.unlit ? 0.0 : 1.0);
  out_metal_rough = vec2(s.metallic, s.roughness);
  out_emissive = vec4(min(s.unlit ? s.emissive + base_color.rgb : s.emissive, vec3(65000.0)), 0.0);
}
