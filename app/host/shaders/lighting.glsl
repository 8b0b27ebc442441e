// Punctual lights (KHR_lights_punctual) on metallic-roughness surfaces (glTF 2.0, appendix B) with umbrage's visibility.
#ifndef SHADOWS_IN_POOL  // The includer knows: no descriptors are needed.
#define UMBRAGE_SET 2
layout(constant_id = 1) const uint shadow_store = 0u;
#define UMBRAGE_STORE shadow_store
#endif
#include "umbrage/shaders/umbrage.glsl"

/// A light without its colour.
struct Lamp {
  vec3 position_ws;
  uint type;
  vec3 direction_ws;
  float range_m, cos_inner, cos_outer;
  uint faces;
};

Lamp lamp_of(GpuLight light) {
  return Lamp(light.position_ws, light.type, light.direction_ws, light.range_m, light.cos_inner, light.cos_outer, light.faces);
}
/// The library's record has all of it, too, and is at hand where visibility is asked for.
Lamp lamp_of(UmbrageLight light) {
  return Lamp(light.position_ws, light.type, light.direction_ws, light.range_m, light.cos_inner, light.cos_outer, light.faces);
}

/// What of a light arrives at a point before visibility and material.
struct Incidence {
  vec3 to_light;      // Unit length.
  float attenuation;  // Distance and cone.
};

/// False: the pair is not evaluated (out of range, cone or faces, or either normal faces away).
bool reaches(Lamp lamp, vec3 position_ws, vec3 geometric_normal, vec3 normal, out Incidence incidence) {
  vec3 path = lamp.position_ws - position_ws;
  float squared = dot(path, path);
  float relative = squared / (lamp.range_m * lamp.range_m);
  bool reached = squared < lamp.range_m * lamp.range_m;
  incidence.to_light = path * inversesqrt(max(squared, 1e-12));
  incidence.attenuation = (1.0 - relative * relative) / max(squared, 1e-6);
  if (lamp.type == LightDirectional) {
    reached = true;
    incidence = Incidence(-lamp.direction_ws, 1.0);
  } else if (lamp.type == LightSpot) {
    float cosine = dot(-incidence.to_light, lamp.direction_ws);
    reached = reached && cosine > lamp.cos_outer;
    float cone = clamp((cosine - lamp.cos_outer) / max(lamp.cos_inner - lamp.cos_outer, 1e-3), 0.0, 1.0);
    incidence.attenuation *= cone * cone;
  } else if (lamp.faces != UmbrageAllCubeFaces) {
    reached = reached && (lamp.faces >> umbrage_face_of_direction(-path) & 1u) != 0u;
  }
  return reached && dot(geometric_normal, incidence.to_light) > 0.0 && dot(normal, incidence.to_light) > 0.0;
}

struct Brdf {
  vec3 diffuse_color, f0;
  float alpha_squared, n_dot_v;
  float view_term;  // Of the shadowing function: what does not depend on the light.
};

Brdf make_brdf(vec3 base_color, float metallic, float roughness, vec3 normal, vec3 to_eye) {
  // A lower bound on roughness keeps highlights of ideal mirrors finite under point lights.
  float alpha = max(roughness * roughness, 2e-3);
  float a2 = alpha * alpha;
  float n_dot_v = max(dot(normal, to_eye), 1e-4);
  return Brdf(base_color * (1.0 - metallic), mix(vec3(0.04), base_color, metallic), a2, n_dot_v,
              sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2));
}

/// Reflected radiance per unit of irradiance on a plane that faces the light, times N·L.
vec3 reflect_light(Brdf brdf, vec3 normal, vec3 to_eye, vec3 to_light) {
  vec3 middle = normalize(to_light + to_eye);
  float n_dot_l = dot(normal, to_light);
  float n_dot_h = clamp(dot(normal, middle), 0.0, 1.0);
  float v_dot_h = clamp(dot(to_eye, middle), 0.0, 1.0);
  float a2 = brdf.alpha_squared;
  float d = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
  float distribution = a2 / (Pi * d * d);
  float shadowing = n_dot_l * brdf.view_term + brdf.n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - a2) + a2);
  float grazing = 1.0 - v_dot_h;
  vec3 fresnel = brdf.f0 + (1.0 - brdf.f0) * (grazing * grazing * grazing * grazing * grazing);
  vec3 diffuse = (1.0 - fresnel) * brdf.diffuse_color / Pi;
  return (diffuse + fresnel * (distribution * 0.5 / shadowing)) * n_dot_l;
}

/// All lights of a cluster on one surface point.
vec3 shade(Frame frame, UmbrageFrame shadows, UmbrageCluster cluster, vec3 position_ws, vec3 geometric_normal,
           vec3 normal, vec3 to_eye, Brdf brdf) {
  // Bounced light, more from above (ambient_irradiance in frame_data.cpp).
  vec3 sum = frame.data.ambient * (0.75 + 0.25 * normal.y) * (brdf.diffuse_color + 0.5 * brdf.f0) / Pi;
  Lights lights = Lights(frame.data.lights);
  for (uint i = 0u; i < cluster.count; ++i) {
    UmbrageLight light = umbrage_light(shadows, cluster, i);
    Incidence incidence;
    if (reaches(lamp_of(light), position_ws, geometric_normal, normal, incidence)) {
      float visibility = umbrage_visibility(shadows, light, position_ws, geometric_normal);
      if (visibility > 0.0)
        sum += lights.at[light.host_index].intensity * (visibility * incidence.attenuation) *
               reflect_light(brdf, normal, to_eye, incidence.to_light);
    }
  }
  return sum;
}
