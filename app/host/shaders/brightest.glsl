// The light that matters most to a point.
#define UMBRAGE_DEBUG
#include "lighting.glsl"

struct Point {
  bool exists;
  vec2 pixel;
  float depth;
  vec3 position_ws, normal;   // Geometric.
};

/// What the depth buffer shows at a pixel of the picture; beyond its border nothing.
Point point_at(Frame frame, ivec2 pixel) {
  Point p;
  p.exists = false;
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.data.width, frame.data.height)))) return p;
  p.pixel = vec2(pixel) + 0.5;
  p.depth = texelFetch(depth_target, pixel, 0).x;
  if (p.depth <= 0.0) return p;
  p.exists = true;
  p.position_ws = frame.data.eye_ws + offset_from_depth(frame, p.pixel, p.depth);
  p.normal = from_octahedral(texelFetch(geometric_normal_target, pixel, 0).xy);
  return p;
}

/// Of the cluster's lights the one that would give the point the most irradiance if nothing stood between; with `wanted`
/// (a host index) that one alone. NoLight: none reaches it. placed: directional lights do not count.
uint brightest(Frame frame, UmbrageFrame shadows, UmbrageCluster cluster, Point p, uint wanted, bool placed) {
  uint best = NoLight;
  float most = 0.0;
  Lights lights = Lights(frame.data.lights);
  for (uint i = 0u; i < cluster.count; ++i) {
    UmbrageLight light = umbrage_light(shadows, cluster, i);
    if (wanted != NoLight && light.host_index != wanted) continue;
    if (placed && light.type == LightDirectional) continue;
    Incidence incidence;
    if (!reaches(lamp_of(light), p.position_ws, p.normal, p.normal, incidence)) continue;
    float irradiance = luminance(lights.at[light.host_index].intensity) * incidence.attenuation * dot(p.normal, incidence.to_light);
    if (irradiance <= most) continue;
    most = irradiance;
    best = i;
  }
  return best;
}
