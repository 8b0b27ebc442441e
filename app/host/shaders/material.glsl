// glTF metallic-roughness materials, evaluated in fragment shaders of the G-buffer and of blended surfaces.
#extension GL_EXT_nonuniform_qualifier : require
layout(constant_id = 2) const uint reads = ReadsAll;
layout(set = SetTextures, binding = 0) uniform sampler2D textures[];

layout(location = 0) in vec3 offset_ws;  // From the eye.
layout(location = 1) in vec3 normal_ws;
layout(location = 2) in vec4 tangent_ws; // w = handedness, 0 = none
layout(location = 3) in vec4 uv_sets;
layout(location = 4) in vec4 color;
layout(location = 5) flat in uint material_index;

struct Surface {
  vec3 offset;            // From the eye, world.
  vec3 geometric_normal;  // Faces the eye.
  vec3 normal;
  vec3 to_eye;
  vec4 base_color;
  float metallic, roughness;
  vec3 emissive;
  bool unlit;
};

vec2 texture_uv(GpuTexture use) {
  vec2 uv = use.uv_set == 0u ? uv_sets.xy : uv_sets.zw;
  return use.u_axis * uv.x + use.v_axis * uv.y + use.offset;
}

/// kind: its bit in `reads`.
bool has_texture(GpuTexture use, uint kind) { return (reads & kind) != 0u && use.slot != NoTexture; }

vec4 sampled(GpuTexture use, uint kind, vec4 without) {
  return has_texture(use, kind) ? texture(textures[nonuniformEXT(use.slot)], texture_uv(use)) : without;
}

/// Of the flat triangle, towards the eye.
vec3 flat_normal(Frame frame) {
  vec3 n = cross(dFdx(offset_ws), dFdy(offset_ws));
  float size = length(n);
  vec3 unit = size > 0.0 ? n / size : frame.data.back_ws;
  return dot(unit, to_eye(frame, offset_ws)) < 0.0 ? -unit : unit;
}

/// World direction of a normal map's texel. uv runs down the image while the map's y runs up: hence -dp/dv.
vec3 mapped_normal(GpuMaterial material, vec3 normal) {
  vec3 texel = sampled(material.normal_texture, ReadsNormalTexture, vec4(0.5, 0.5, 1.0, 0.0)).xyz * 2.0 - 1.0;
  texel.xy *= material.normal_scale;
  vec3 tangent, bitangent;
  if (tangent_ws.w != 0.0) {
    tangent = tangent_ws.xyz;
    bitangent = cross(normal_ws, tangent) * tangent_ws.w;
  } else {
    vec2 uv = texture_uv(material.normal_texture);
    vec3 dx = dFdx(offset_ws), dy = dFdy(offset_ws);
    vec2 uv_dx = dFdx(uv), uv_dy = dFdy(uv);
    float area = uv_dx.x * uv_dy.y - uv_dx.y * uv_dy.x;
    tangent = (dx * uv_dy.y - dy * uv_dx.y) * sign(area);
    bitangent = (dx * uv_dy.x - dy * uv_dx.x) * sign(area);
    tangent -= normal * dot(tangent, normal);
    bitangent -= normal * dot(bitangent, normal);
  }
  if (!gl_FrontFacing) {
    tangent = -tangent;
    bitangent = -bitangent;
  }
  float tangent_size = length(tangent), bitangent_size = length(bitangent);
  if (tangent_size < 1e-20 || bitangent_size < 1e-20) return normal;
  vec3 mapped = tangent / tangent_size * texel.x + bitangent / bitangent_size * texel.y + normal * texel.z;
  return dot(mapped, mapped) > 1e-12 ? normalize(mapped) : normal;
}

Surface evaluate_material(Frame frame, GpuMaterial material, vec4 base_color) {
  Surface s;
  s.offset = offset_ws;
  s.geometric_normal = flat_normal(frame);
  s.to_eye = to_eye(frame, offset_ws);
  vec3 normal = dot(normal_ws, normal_ws) > 1e-20 ? normalize(normal_ws) : s.geometric_normal;
  if (!gl_FrontFacing) normal = -normal;
  s.normal = has_texture(material.normal_texture, ReadsNormalTexture) ? mapped_normal(material, normal) : normal;
  s.base_color = base_color;
  vec4 metal_rough = sampled(material.metallic_roughness_texture, ReadsMetallicRoughnessTexture, vec4(1.0));
  s.metallic = clamp(material.metallic * metal_rough.b, 0.0, 1.0);
  s.roughness = clamp(material.roughness * metal_rough.g, 0.0, 1.0);
  s.emissive = material.emissive * sampled(material.emissive_texture, ReadsEmissiveTexture, vec4(1.0)).rgb;
  s.unlit = (material.flags & MaterialUnlit) != 0u;
  return s;
}

vec4 base_color_of(GpuMaterial material) {
  vec4 base_color = material.base_color * sampled(material.base_color_texture, ReadsBaseColorTexture, vec4(1.0));
  return (reads & ReadsVertexColors) != 0u ? base_color * color : base_color;
}
