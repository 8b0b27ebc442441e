// A face of the reflection cube map: what the mirror ball's middle sees, lit as the picture is. Fragments that are not those that
// the depth pass has found (hidden ones, and holes of masks) are dropped before they ask for shadows: no map was marked for them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_samplerless_texture_functions : require
#include "host.glsl"
#define SHADOWS_IN_POOL
#define UMBRAGE_COUNT_TAPS
#include "lighting.glsl"

layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) in vec2 uv;  // Of the base colour's texture.
layout(location = 3) flat in uint material_index;
layout(location = 4) flat in uint face;
layout(location = 0) out vec4 out_color;

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Reflection { GpuReflection data; };
layout(push_constant, scalar) uniform Push { uint64_t reflection; };
layout(set = 1, binding = 0) uniform texture2DArray depths;
layout(set = 1, binding = 1) uniform sampler2D textures[];

/// How far apart two pipelines may place the same vertex.
const float DepthSlack = 4e-6;

vec4 sampled(GpuTexture use) { return use.slot == NoTexture ? vec4(1.0) : texture(textures[nonuniformEXT(use.slot)], uv); }

void main() {
  GpuReflection data = Reflection(reflection).data;
  Frame frame = Frame(data.frame);
  GpuMaterial material = Materials(frame.data.materials).at[material_index];
  // All that takes derivatives comes before the first discard.
  vec4 base_color = material.base_color * sampled(material.base_color_texture);
  vec4 metal_rough = sampled(material.metallic_roughness_texture);
  vec3 emissive = material.emissive * sampled(material.emissive_texture).rgb;
  vec3 across = cross(dFdx(position_ws), dFdy(position_ws));

  float depth = texelFetch(depths, ivec3(gl_FragCoord.xy, face), 0).x;
  if (abs(gl_FragCoord.z - depth) > DepthSlack) discard;
  vec3 to_eye = normalize(data.eye_ws - position_ws);
  vec3 flat_normal = dot(across, across) > 0.0 ? normalize(across) : to_eye;
  if (dot(flat_normal, to_eye) < 0.0) flat_normal = -flat_normal;
  vec3 normal = dot(normal_ws, normal_ws) > 1e-20 ? normalize(normal_ws) : flat_normal;
  if (dot(normal, flat_normal) < 0.0) normal = -normal;

  vec3 radiance = emissive;
  if ((material.flags & MaterialUnlit) != 0u) {
    radiance += base_color.rgb;
  } else {
    UmbrageFrame shadows = umbrage_frame(data.shadows[face]);
    UmbrageCluster cluster = umbrage_cluster(shadows, gl_FragCoord.xy, depth);
    Brdf brdf = make_brdf(base_color.rgb, clamp(material.metallic * metal_rough.b, 0.0, 1.0),
                          clamp(material.roughness * metal_rough.g, 0.0, 1.0), normal, to_eye);
    radiance += shade(frame, shadows, cluster, position_ws, flat_normal, normal, to_eye, brdf);
  }
  out_color = vec4(radiance, 1.0);
}
