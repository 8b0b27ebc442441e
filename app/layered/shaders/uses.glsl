// A scene's surfaces under a sun with a shadow map and a sky: what the pictures of layered uses show.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

/// As app::UseMaterial.
struct Material {
  vec4 base_color;
  uint texture_slot;   // ~0: none
  float alpha_cutoff;  // 0: opaque
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Materials { Material v[]; };
/// As app::UseData.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Uses {
  mat4 sun_from_world;
  vec4 to_sun;
  vec4 ball;           // middle and radius; 0: none
  vec4 eyes[6];        // a view's eye, for the mirror ball
  uint64_t materials;
  uint ball_index;     // host_index of the ball's instance
};

layout(push_constant, scalar) uniform Push { uint64_t uses; };
layout(set = 1, binding = 0) uniform sampler2DShadow sun_map;
layout(set = 1, binding = 1) uniform samplerCube reflection;
layout(set = 1, binding = 2) uniform sampler2D textures[];

vec3 sky(vec3 direction) { return mix(vec3(0.55, 0.6, 0.68), vec3(0.25, 0.42, 0.75), clamp(direction.y, 0.0, 1.0)); }

float sun_visibility(Uses data, vec3 position_ws, vec3 normal) {
  vec4 clip = data.sun_from_world * vec4(position_ws + 0.004 * data.to_sun.w * normal, 1.0);
  vec2 uv = clip.xy * 0.5 + 0.5;
  vec2 texel = 1.0 / vec2(textureSize(sun_map, 0));
  float lit = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) lit += textureLod(sun_map, vec3(uv + vec2(x, y) * texel, clip.z - 0.0005), 0.0);
  return lit / 9.0;
}
