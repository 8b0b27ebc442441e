// Depth, geometric and shading normal, material of what is opaque or cut out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "material.glsl"
#include "packed_surface.glsl"

layout(constant_id = 0) const bool masked = false;
layout(push_constant, scalar) uniform Push { FramePush push; };

layout(location = 0) out vec2 out_geometric_normal;
layout(location = 1) out uvec4 out_surface;

void main() {
  Frame frame = Frame(push.frame);
  GpuMaterial material = Materials(frame.data.materials).at[material_index];
  vec4 base_color = base_color_of(material);
  Surface s = evaluate_material(frame, material, base_color);
  if (masked && base_color.a < material.alpha_cutoff) discard;
  out_geometric_normal = octahedral(s.geometric_normal);
  vec3 emissive = clamp(s.unlit ? s.emissive + base_color.rgb : s.emissive, 0.0, 65000.0);
  out_surface = pack_surface(PackedSurface(s.normal, base_color.rgb, s.metallic, s.roughness, emissive, s.unlit));
}
