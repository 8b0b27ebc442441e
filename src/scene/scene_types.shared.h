// What the device knows of the scene: lights, casters and the trees over them.
#ifndef UMBRAGE_SCENE_TYPES_SHARED_H
#define UMBRAGE_SCENE_TYPES_SHARED_H
#include "core/limits.shared.h"
#include "views/cube_projection.shared.h"
#include "views/shadow_view.shared.h"

UMB_NAMESPACE_BEGIN

UMB_CONST uint LightPoint = 0u;
UMB_CONST uint LightSpot = 1u;
UMB_CONST uint LightDirectional = 2u;
/// Of LightRecord::faces.
UMB_CONST uint AllCubeFaces = 63u;

/// A light as the host described it, and where its map lies. One per slot; dead slots have type = NoIndex.
struct LightRecord {
  vec3 position_ws;
  float range_m;
  vec3 direction_ws;       // unit
  uint type;
  float cos_inner;
  float cos_outer;
  float outer_cone_rad;
  float near_m;
  uint host_index;
  uint light_mask;
  uint views;              // ViewsCube, …
  uint view_count;         // 6, 1 or 0 (casts no shadow)
  uint first_view;         // into the views; tiles of the atlas have the same numbers
  uint resolution;         // texels along a side
  uint faces;              // of the cube around a point light, those that it shines through; others have AllCubeFaces
};
UMB_ASSERT_SIZE(LightRecord, 76);

struct Box {
  vec3 lo;
  vec3 hi;
};
UMB_ASSERT_SIZE(Box, 24);

/// One instance of a mesh.
struct InstanceRecord {
  vec4 row0, row1, row2;   // world_from_mesh
  uint64_t positions;      // address
  uint64_t uvs;            // address or 0
  uint position_stride;    // in floats
  uint uv_stride;          // in floats
  uint light_mask;
  uint flags;              // InstanceIsFixed
  Box box;                 // world space, of all levels
  float stretch;           // lengths of the mesh are at most so many times as long in the world; NoLevels: deformed
};
UMB_ASSERT_SIZE(InstanceRecord, 112);

/// InstanceRecord::stretch of deformed instances, and the end of the coarsest level's errors: more than any.
UMB_CONST float NoLevels = 1e30f;

/// Mobility::fixed.
UMB_CONST uint InstanceIsFixed = 1u;

/// A batch of a mesh (O4): a range of the shared index buffer.
struct BatchRecord {
  vec3 box_min;            // mesh space
  uint first_index;
  vec3 box_max;
  uint triangle_count;
  uint mask;               // into the mask array, or NoIndex = opaque
  float alpha_cutoff;
  float alpha_factor;
  uint index_count;
  float least_error_m;     // mesh space: drawn where the surface may be off by least_error_m …
  float end_error_m;       // … and not where it may be by end_error_m; 0 … NoLevels: always
};
UMB_ASSERT_SIZE(BatchRecord, 56);

/// A batch of an instance: the unit of culling.
struct CasterRecord {
  uint instance;
  uint batch;
};
UMB_ASSERT_SIZE(CasterRecord, 8);

/// A 32-way left-balanced implicit tree (O5) over `count` leaves in Morton order. Level 0 groups the leaves, node i of a
/// level covers i*32 … i*32+31 of the level below; the last level is one node. Nodes of all levels lie in one array.
struct TreeShape {
  uint count;
  uint levels;             // 0 when there is no leaf
  uint first[6];           // where a level's nodes begin
  uint nodes[6];
};
UMB_ASSERT_SIZE(TreeShape, 56);

/// Of the levels of detail of an instance's batches one is drawn: the coarsest that is off by no more than error_ws metres.
UMB_FN bool is_at_level(BatchRecord batch, InstanceRecord instance, float error_ws) {
  float error_m = min(error_ws / instance.stretch, 0.5f * NoLevels);
  return error_m >= batch.least_error_m && error_m < batch.end_error_m;
}
/// The finest level.
UMB_FN bool is_finest(BatchRecord batch) { return batch.least_error_m == 0.0f; }

UMB_FN bool box_is_empty(Box box) { return box.lo.x > box.hi.x; }

UMB_FN bool boxes_meet(Box a, Box b) {
  return a.lo.x <= b.hi.x && a.lo.y <= b.hi.y && a.lo.z <= b.hi.z && b.lo.x <= a.hi.x && b.lo.y <= a.hi.y && b.lo.z <= a.hi.z;
}

UMB_FN float squared_distance_to_box(vec3 point, Box box) {
  vec3 outside = max(max(box.lo - point, point - box.hi), vec3(0.0f));
  return dot(outside, outside);
}

/// Spreads the low 10 bits to every third bit.
UMB_FN uint spread_bits(uint x) {
  x = (x | (x << 16u)) & 0x030000ffu;
  x = (x | (x << 8u)) & 0x0300f00fu;
  x = (x | (x << 4u)) & 0x030c30c3u;
  return (x | (x << 2u)) & 0x09249249u;
}

/// 30-bit Morton code of a point within a box; a flat or empty box counts as one cell along that axis.
UMB_FN uint morton_code(vec3 point, Box bounds) {
  vec3 extent = bounds.hi - bounds.lo;
  vec3 scale = vec3(extent.x > 0.0f ? 1024.0f / extent.x : 0.0f, extent.y > 0.0f ? 1024.0f / extent.y : 0.0f,
                    extent.z > 0.0f ? 1024.0f / extent.z : 0.0f);
  vec3 cell = clamp((point - bounds.lo) * scale, vec3(0.0f), vec3(1023.0f));
  return spread_bits(uint(cell.x)) | (spread_bits(uint(cell.y)) << 1u) | (spread_bits(uint(cell.z)) << 2u);
}

/// Order-preserving map of floats to unsigned integers, so that atomicMin and atomicMax work on them.
UMB_FN uint ordered_bits(float value) {
  uint bits = floatBitsToUint(value);
  return (bits & 0x80000000u) != 0u ? ~bits : (bits | 0x80000000u);
}
UMB_FN float from_ordered_bits(uint bits) {
  return uintBitsToFloat((bits & 0x80000000u) != 0u ? (bits & 0x7fffffffu) : ~bits);
}

/// The smallest box we could name around what a spot or point light reaches.
UMB_FN Box light_box(LightRecord light) {
  Box box;
  box.lo = light.position_ws - vec3(light.range_m);
  box.hi = light.position_ws + vec3(light.range_m);
  if (light.type != LightSpot) return box;
  // The cone's rim is a circle of radius range*sin around position + direction*range*cos; the cap reaches at most range
  // along any axis that lies inside the cone.
  float sine = sin(light.outer_cone_rad);
  vec3 centre = light.position_ws + light.direction_ws * (light.range_m * light.cos_outer);
  vec3 rim = light.range_m * sine * sqrt(max(vec3(0.0f), vec3(1.0f) - light.direction_ws * light.direction_ws));
  vec3 lo = min(light.position_ws, centre - rim);
  vec3 hi = max(light.position_ws, centre + rim);
  for (int axis = 0; axis < 3; ++axis) {
    if (light.direction_ws[axis] >= light.cos_outer) hi[axis] = box.hi[axis];
    if (-light.direction_ws[axis] >= light.cos_outer) lo[axis] = box.lo[axis];
  }
  box.lo = lo;
  box.hi = hi;
  return box;
}

/// True unless the light certainly reaches nothing in the box. Conservative: sphere, and for spots the cone against the
/// box's bounding sphere.
UMB_FN bool light_meets_box(LightRecord light, Box box) {
  if (light.type == LightDirectional) return true;
  float reach = light.range_m * 1.0001f;
  if (squared_distance_to_box(light.position_ws, box) > reach * reach) return false;
  if (light.type == LightPoint) return true;
  vec3 to_centre = (box.lo + box.hi) * 0.5f - light.position_ws;
  float radius = length(box.hi - box.lo) * 0.5f + reach * 1e-4f;
  float along = dot(to_centre, light.direction_ws);
  float across = sqrt(max(dot(to_centre, to_centre) - along * along, 0.0f));
  // Signed distance of the sphere's centre to the cone's surface, for half-angles up to 90 degrees.
  float sine = sqrt(max(0.0f, 1.0f - light.cos_outer * light.cos_outer));
  return across * light.cos_outer - along * sine <= radius && along >= -radius;
}

/// The same of receivers, which a light may be cut off from (O22): true unless it certainly shines on nothing in the box. Casters are
/// not asked: taps at the border of a face that the light shines through read texels of the next one.
UMB_FN bool light_shines_on(LightRecord light, Box box) {
  if (!light_meets_box(light, box)) return false;
  if (light.faces == AllCubeFaces) return true;
  float slack = light.range_m * 1e-4f;
  return (face_mask(box.lo - light.position_ws - slack, box.hi - light.position_ws + slack) & light.faces) != 0u;
}

UMB_NAMESPACE_END
#endif
