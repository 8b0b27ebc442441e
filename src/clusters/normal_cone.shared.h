// Normal cones of clusters: samples mark cells of an octahedral map of 8×8, one bit each; the cone holds the marked cells.
#ifndef UMBRAGE_CLUSTERS_NORMAL_CONE_SHARED_H
#define UMBRAGE_CLUSTERS_NORMAL_CONE_SHARED_H
#include "core/rounding.shared.h"

UMB_NAMESPACE_BEGIN

UMB_CONST uint NormalCellsSide = 8u;

UMB_FN vec2 octahedral(vec3 n) {
  float sum = abs(n.x) + abs(n.y) + abs(n.z);
  vec2 p = vec2(n.x / sum, n.y / sum);
  if (n.z >= 0.0f) return p;
  return vec2((1.0f - abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f), (1.0f - abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
}

UMB_FN vec3 from_octahedral(vec2 p) {
  vec3 n = vec3(p.x, p.y, 1.0f - abs(p.x) - abs(p.y));
  float fold = max(-n.z, 0.0f);
  n.x += n.x >= 0.0f ? -fold : fold;
  n.y += n.y >= 0.0f ? -fold : fold;
  return normalize(n);
}

UMB_FN uint normal_cell(vec3 normal) {
  vec2 p = octahedral(normal) * 4.0f + vec2(4.0f);
  return floor_to_uint(p.y, 7u) * NormalCellsSide + floor_to_uint(p.x, 7u);
}

UMB_FN vec3 normal_cell_corner(uint cell, uint corner) {
  return from_octahedral(vec2((float(cell % 8u + (corner & 1u)) - 4.0f) * 0.25f, (float(cell / 8u + (corner >> 1u)) - 4.0f) * 0.25f));
}

/// Axis and cosine of the half-angle of a cone that holds every normal of the marked cells; (0, 0, 1, -1) = any direction.
UMB_FN vec4 normal_cone(uint low, uint high) {
  vec3 sum = vec3(0.0f);
  for (uint cell = 0u; cell < 64u; ++cell) {
    uint word = cell < 32u ? low : high;
    if ((word & (1u << (cell & 31u))) == 0u) continue;
    for (uint corner = 0u; corner < 4u; ++corner) sum += normal_cell_corner(cell, corner);
  }
  float size = length(sum);
  if (size < 1e-3f) return vec4(0.0f, 0.0f, 1.0f, -1.0f);
  vec3 axis = sum / size;
  float cosine = 1.0f;
  for (uint cell = 0u; cell < 64u; ++cell) {
    uint word = cell < 32u ? low : high;
    if ((word & (1u << (cell & 31u))) == 0u) continue;
    for (uint corner = 0u; corner < 4u; ++corner) cosine = min(cosine, dot(axis, normal_cell_corner(cell, corner)));
  }
  return vec4(axis.x, axis.y, axis.z, max(cosine - 1e-4f, -1.0f));
}

UMB_NAMESPACE_END
#endif
