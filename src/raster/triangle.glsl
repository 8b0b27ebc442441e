// What shaders do with the triangles of triangle.shared.h: step along their edges, clip them, find texels on their masks.
#include "raster/triangle.shared.h"

/// Steps of the three edge functions along x and y.
ivec3 steps_x(RasterTriangle t) { return ivec3(t.y1 - t.y2, t.y2 - t.y0, t.y0 - t.y1); }
ivec3 steps_y(RasterTriangle t) { return ivec3(t.x2 - t.x1, t.x0 - t.x2, t.x1 - t.x0); }

/// Cuts the triangle to the planes that it crosses; the rest is a fan around corner[0].
uint clip_triangle(inout ClipVertex corner[9], float guard) {
  uint count = 3u;
  for (uint plane = 0u; plane < ClipPlanes; ++plane) {
    ClipVertex former[9] = corner;
    uint kept = 0u;
    for (uint i = 0u; i < count; ++i) {
      ClipVertex from = former[i];
      ClipVertex to = former[i + 1u == count ? 0u : i + 1u];
      float from_distance = clip_distance(from.position, plane, guard);
      float to_distance = clip_distance(to.position, plane, guard);
      if (from_distance >= 0.0) corner[kept++] = from;
      if (from_distance >= 0.0 && to_distance < 0.0) corner[kept++] = clip_edge(from, to, from_distance, to_distance);
      if (from_distance < 0.0 && to_distance >= 0.0) corner[kept++] = clip_edge(to, from, to_distance, from_distance);
    }
    count = kept;
    if (count == 0u) break;
  }
  return count;
}

/// Perspective texture coordinates at a texel, from its edge functions.
vec2 mask_coordinates(RasterTriangle t, vec3 weights) { return vec2(dot(weights, t.u), dot(weights, t.v)) / dot(weights, t.q); }

/// Level of detail of a triangle's mask: that of a texel at its middle.
float mask_level(RasterTriangle t, ivec2 mask_size) {
  float q = t.q.x + t.q.y + t.q.z;
  vec2 uv = vec2(t.u.x + t.u.y + t.u.z, t.v.x + t.v.y + t.v.z) / q;
  vec3 x = vec3(steps_x(t));
  vec3 y = vec3(steps_y(t));
  // Weights change by a step from texel to texel; at the middle each is a third of their constant sum.
  float third = (float(t.x1 - t.x0) * float(t.y2 - t.y0) - float(t.y1 - t.y0) * float(t.x2 - t.x0)) / (3.0 * float(SubTexels));
  vec2 size = vec2(mask_size) / (q * third);
  vec2 across = (vec2(dot(x, t.u), dot(x, t.v)) - uv * dot(x, t.q)) * size;
  vec2 down = (vec2(dot(y, t.u), dot(y, t.v)) - uv * dot(y, t.q)) * size;
  return 0.5 * log2(max(max(dot(across, across), dot(down, down)), 1e-12));
}
