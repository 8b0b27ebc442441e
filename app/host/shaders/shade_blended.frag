// Blended surfaces, back to front over the lit picture: lights through the cluster at the fragment's own position.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "material.glsl"
#include "lighting.glsl"

layout(push_constant, scalar) uniform Push { FramePush push; };
layout(location = 0) out vec4 out_color;  // Premultiplied.

void main() {
  Frame frame = Frame(push.frame);
  GpuMaterial material = Materials(frame.data.materials).at[material_index];
  vec4 base_color = base_color_of(material);
  Surface s = evaluate_material(frame, material, base_color);
  vec3 radiance = s.emissive;
  if (s.unlit) {
    radiance += base_color.rgb;
  } else {
    vec3 position_ws = frame.data.eye_ws + s.offset;
    UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
    UmbrageCluster cluster = umbrage_cluster_at(shadows, position_ws);
    Brdf brdf = make_brdf(base_color.rgb, s.metallic, s.roughness, s.normal, s.to_eye);
    radiance += shade(frame, shadows, cluster, position_ws, s.geometric_normal, s.normal, s.to_eye, brdf);
  }
  float alpha = clamp(base_color.a, 0.0, 1.0);
  out_color = vec4(radiance * alpha, alpha);
}
