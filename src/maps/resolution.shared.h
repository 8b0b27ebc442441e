// How many texels a cluster wants of a light's map (O2), in the paper's form and corrected (E1…E4).
#ifndef UMBRAGE_MAPS_RESOLUTION_SHARED_H
#define UMBRAGE_MAPS_RESOLUTION_SHARED_H
#include "maps/map_types.shared.h"

UMB_NAMESPACE_BEGIN

/// Solid angle of a square perspective view; 4 pi / 6 on a cube face.
UMB_FN float view_solid_angle(float tangent) {
  float square = tangent * tangent;
  return 4.0f * asin(square / (1.0f + square));
}

/// O2: so many texels that S of them fall on what spans the solid angle alpha, if all texels spanned the same.
UMB_FN float paper_resolution(float pixels, float alpha, float tangent) { return sqrt(pixels * view_solid_angle(tangent) / alpha); }

/// A texel at the face's centre covers 1.91 times the mean solid angle (E3).
UMB_CONST float CentreTexelScale = 1.3819766f;

/// Texels no larger than `pixel_m` at an axis depth: what the corrected form asks for at least (E2).
UMB_FN float matching_resolution(float depth_m, float tangent, float pixel_m) { return 2.0f * tangent * depth_m / pixel_m; }

/// The level nearest to a resolution: its texels are at most 1.42 times as wide as those asked for.
UMB_FN uint level_of_resolution(float resolution) {
  float level = ceil(log2(max(resolution, 1.0f)) - 0.5f);
  return max(floor_to_uint(level, MaxLevel), MinLevel);
}

/// The least side of maps of which the store backs whole blocks.
UMB_FN uint least_backed(uint block) { return block == PageSide ? PageSide : LeastSparseSide; }

/// Whole blocks of what the store backs at once (O13); smaller maps stay as they are.
UMB_FN uint backed_resolution(uint texels, uint block) { return texels >= least_backed(block) ? (texels + block - 1u) / block * block : texels; }

/// The paper's R as the exact layout allocates it: whole blocks, or below what it backs a power of two.
UMB_FN uint exact_resolution(float resolution, uint block) {
  uint texels = max(floor_to_uint(ceil(resolution), 1u << MaxLevel), 1u);
  if (texels >= least_backed(block)) return backed_resolution(texels, block);
  uint side = 1u << MinLevel;
  while (side < texels) side *= 2u;
  return backed_resolution(side, block);   // 17 … 31 texels make 32
}

/// A map's place among its light's, finest first: its level, or its bucket of the histogram (O8, E8). `bit` numbers the
/// places that a light could have, `kept` has the bits of those that start a map; coarser requests than any go to the last.
UMB_FN uint map_of_place(uint kept, uint bit) { return uint(bitCount(kept & (0xffffffffu >> (31u - bit)))) - 1u; }
UMB_FN uint place_of_level(uint level) { return MaxLevel - level; }
UMB_FN uint level_of_place(uint place) { return MaxLevel - place; }

/// O8, E8: bucket of a request below the light's finest one, of `buckets`; steps of a factor of two, or equal steps.
UMB_FN uint bucket_of_request(float resolution, float finest, uint buckets, bool logarithmic) {
  float ratio = max(finest / max(resolution, 1e-6f), 1.0f);
  float at = logarithmic ? log2(ratio) : (1.0f - 1.0f / ratio) * float(buckets);
  return floor_to_uint(at, buckets - 1u);
}

/// Twice the area of a quad's picture.
UMB_FN float doubled_area(vec2 a, vec2 b, vec2 c, vec2 d) {
  vec2 p = c - a;
  vec2 q = d - b;
  return abs(p.x * q.y - p.y * q.x);
}

/// Pixels that a box covers (half of what its six faces cover), at most the tile's: S of explicit bounds (E1). A box that
/// reaches behind the camera counts as the whole tile.
UMB_FN float box_pixels(CameraRecord camera, Box box) {
  vec2 at[8];
  for (uint i = 0u; i < 8u; ++i) {
    vec3 corner = vec3((i & 1u) != 0u ? box.hi.x : box.lo.x, (i & 2u) != 0u ? box.hi.y : box.lo.y, (i & 4u) != 0u ? box.hi.z : box.lo.z);
    vec4 clip = camera.clip_from_world * vec4(corner.x, corner.y, corner.z, 1.0f);
    if (!(clip.w > 1e-6f)) return float(TileSide * TileSide);
    at[i] = vec2(clip.x / clip.w * 0.5f * float(camera.size.x), clip.y / clip.w * 0.5f * float(camera.size.y));
  }
  float doubled = doubled_area(at[0], at[1], at[3], at[2]) + doubled_area(at[4], at[5], at[7], at[6]) +
                  doubled_area(at[0], at[1], at[5], at[4]) + doubled_area(at[2], at[3], at[7], at[6]) +
                  doubled_area(at[0], at[2], at[6], at[4]) + doubled_area(at[1], at[3], at[7], at[5]);
  return clamp(doubled * 0.25f, 1.0f, float(TileSide * TileSide));
}

/// World size of a pixel where a box is nearest to the camera.
UMB_FN float nearest_pixel_m(CameraRecord camera, Box box, uint slice) {
  vec3 centre = (box.lo + box.hi) * 0.5f;
  vec3 row = vec3(camera.t_row.x, camera.t_row.y, camera.t_row.z);
  float nearest = dot(row, centre) + camera.t_row.w - dot(abs(row), (box.hi - box.lo) * 0.5f);
  float t = max(nearest, slice_begin(camera, slice));
  float width = length(camera.origin_x + camera.ray_x * t) * 2.0f / float(camera.size.x);
  float height = length(camera.origin_y + camera.ray_y * t) * 2.0f / float(camera.size.y);
  return min(width, height);
}

/// A sphere around what a cluster may hold: of its cell's eight true corners (E4), or of its tight box.
UMB_FN vec4 cell_sphere(CameraRecord camera, uvec2 tile, uint slice) {
  vec3 corners[8];
  vec3 sum = vec3(0.0f);
  for (uint i = 0u; i < 8u; ++i) {
    vec2 pixel = vec2(float((tile.x + (i & 1u)) * TileSide), float((tile.y + ((i >> 1u) & 1u)) * TileSide));
    corners[i] = world_position(camera, ndc_of_pixel(camera, pixel), slice_begin(camera, slice + (i >> 2u)));
    sum += corners[i];
  }
  vec3 centre = sum * 0.125f;
  float radius = 0.0f;
  for (uint i = 0u; i < 8u; ++i) radius = max(radius, distance(centre, corners[i]));
  return vec4(centre.x, centre.y, centre.z, radius);
}

/// True when no surface of the cluster (a cone of normals, a sphere of places) can face the light.
UMB_FN bool faces_away(vec4 cone, vec3 centre, float radius, LightRecord light) {
  if (cone.w <= 0.0f) return false;
  vec3 axis = vec3(cone.x, cone.y, cone.z);
  float spread = 0.0f;
  vec3 to_light = vec3(0.0f) - light.direction_ws;
  if (light.type != LightDirectional) {
    to_light = light.position_ws - centre;
    float size = length(to_light);
    if (size <= radius * 1.001f) return false;
    to_light = to_light / size;
    spread = asin(min(radius / size, 1.0f));
  }
  // The nearest that a normal and a direction to the light can come: the axes' angle less both spreads.
  return acos(clamp(dot(axis, to_light), -1.0f, 1.0f)) - acos(cone.w) - spread > Pi * 0.5f + 1e-3f;
}

UMB_NAMESPACE_END
#endif
