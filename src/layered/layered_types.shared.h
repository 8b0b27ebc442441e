// What the device knows of a layered pass: geometry in batches, instances, views, and what selection hands to the writers.
#ifndef UMBRAGE_LAYERED_TYPES_SHARED_H
#define UMBRAGE_LAYERED_TYPES_SHARED_H
#include "core/limits.shared.h"

UMB_NAMESPACE_BEGIN

/// Views of one pass at most; a caster has a bit for each.
UMB_CONST uint MaxLayeredViews = 256u;
UMB_CONST uint ViewWords = 8u;
/// Bone index of a vertex that says "no bone" (listing 19.7).
UMB_CONST uint NoBone = 0xffu;

/// What the vertex shader does, as in the chapter's listings.
UMB_CONST uint VerticesSimple = 0u;       // 19.6: one model matrix
UMB_CONST uint VerticesInstanced = 1u;    // 19.8: a model matrix an instance
UMB_CONST uint VerticesSkinned = 2u;      // 19.7 as meant: 3x4 bones, then the model matrix (E12)
UMB_CONST uint VerticesSkinnedMat3 = 3u;  // 19.7 as printed: no translation, no model matrix

/// Which side of a triangle is dropped. Counter-clockwise in mesh space, seen from outside, is the front.
UMB_CONST uint CullNothing = 0u;
UMB_CONST uint CullBack = 1u;
UMB_CONST uint CullFront = 2u;

/// A vertex's bones, 8 bits each, and their weights: 20 bytes, as in the chapter.
struct LayeredSkinRecord {
  uint bones;
  vec4 weights;
};
UMB_ASSERT_SIZE(LayeredSkinRecord, 20);

struct LayeredBatch {
  vec3 box_min;           // mesh space
  uint first_index;       // into the indices of indexed draws
  vec3 box_max;
  uint triangle_count;
  uint first_vertex;      // into the batch vertices, for task and mesh shaders
  uint vertex_count;
  uint first_triangle;    // into the batch triangles: three 8-bit local indices a word
  uint mask;              // into the mask array, or NoIndex: opaque
  float alpha_cutoff;
  float alpha_factor;
};
UMB_ASSERT_SIZE(LayeredBatch, 56);

struct LayeredInstanceRecord {
  vec4 row0, row1, row2;  // world_from_mesh
  uint first_bone;        // NoIndex: rigid. Skinned batches have no box that holds them: they are always selected
  uint host_index;
  float handedness;       // -1: mirrored
  uint padding;
};
UMB_ASSERT_SIZE(LayeredInstanceRecord, 64);

/// A batch of an instance.
struct LayeredCaster {
  uint instance;
  uint batch;
};
UMB_ASSERT_SIZE(LayeredCaster, 8);

struct LayeredViewRecord {
  mat4 clip_from_world;
  vec4 eye;               // the point that the view looks from, or a direction (w = 0) towards it
  vec2 area_scale;        // clip space of the view -> clip space of the layer: xy * scale + w * offset
  vec2 area_offset;
  uint layer;
  uint x, y;              // texels of the layer that are the view's
  uint width, height;
  uint index;             // among the host's views; these are sorted by layer
};
UMB_ASSERT_SIZE(LayeredViewRecord, 120);

/// Views that are drawn together.
struct LayeredGroup {
  uint first_view;
  uint view_count;
};
UMB_ASSERT_SIZE(LayeredGroup, 8);

/// VkDrawIndexedIndirectCommand.
struct LayeredDraw {
  uint index_count;
  uint instance_count;
  uint first_index;
  int vertex_offset;
  uint first_instance;
};
UMB_ASSERT_SIZE(LayeredDraw, 20);

/// What selection found for one list of a group: the count of draws, which is also the first of three group counts.
struct LayeredCount {
  uint x, y, z;
  uint padding;
};
UMB_ASSERT_SIZE(LayeredCount, 16);

/// A triangle that the compute writer found too large for one thread.
struct LargeTriangle {
  uint caster;
  uint triangle;          // of the batch
  uint view;
};
UMB_ASSERT_SIZE(LargeTriangle, 12);

struct SelectPush {
  uint64_t casters;
  uint64_t batches;
  uint64_t instances;
  uint64_t views;
  uint64_t groups;
  uint64_t visible;       // ViewWords words a caster
  uint64_t counts;        // [group][list]
  uint64_t draws;         // [group][list][caster]
  uint64_t listed;        // [group][list][caster]: for writers without indexed draws
  uint caster_count;
  uint group_count;
  uint view_count;
  uint list_count;        // 1 opaque; 2 + masked; 4 + mirrored apart
  uint instance_per_view; // 1: a draw has an instance for each view (vertex-written layer, atlas)
  uint padding;
};
UMB_ASSERT_SIZE(SelectPush, 96);

/// What every writer draws with. `host` comes first: a fragment shader of the host's reads it.
struct LayeredPush {
  uint64_t host;
  uint64_t positions;
  uint64_t normals;
  uint64_t uvs;
  uint64_t skins;
  uint64_t bones;
  uint64_t instances;
  uint64_t batches;
  uint64_t casters;
  uint64_t views;
  uint64_t visible;
  uint64_t list;          // mesh: casters of the list
  uint64_t vertices;
  uint64_t triangles;
  uint first_view;
  uint view_count;
  uint first_layer;       // of the render pass, in the target
  uint padding;
};
UMB_ASSERT_SIZE(LayeredPush, 128);

struct ComputeWritePush {
  uint64_t scene;         // a LayeredPush in memory
  uint64_t list;
  uint64_t indices;
  uint64_t keys;          // of the group's layers
  uint64_t queue;         // LargeTriangle
  uint64_t queue_count;   // LayeredCount
  uint queue_room;
  uint first_view, view_count;
  uint first_layer;
  uint width, height;     // of a layer
};
UMB_ASSERT_SIZE(ComputeWritePush, 72);

struct PackPush {
  uint64_t keys;
  uint64_t halves;        // two 16-bit depths a word
  uint words;
  uint padding;
};
UMB_ASSERT_SIZE(PackPush, 24);

/// Towards the eye or not, from the world triangle: listing 19.10 with its sense made a parameter (E14).
UMB_FN bool is_culled_face(vec3 a, vec3 b, vec3 c, vec4 eye, float handedness, uint cull) {
  if (cull == CullNothing) return false;
  vec3 normal = cross(b - a, c - a) * handedness;
  vec3 to_eye = vec3(eye.x, eye.y, eye.z) - a * eye.w;
  float facing = dot(normal, to_eye);
  return cull == CullBack ? facing < 0.0f : facing > 0.0f;
}

/// Outside of one plane of the view with all three vertices: listing 19.9, with Vulkan's near plane z < 0 (E13).
UMB_FN bool is_outside(vec4 a, vec4 b, vec4 c) {
  if (a.x > a.w && b.x > b.w && c.x > c.w) return true;
  if (a.x < -a.w && b.x < -b.w && c.x < -c.w) return true;
  if (a.y > a.w && b.y > b.w && c.y > c.w) return true;
  if (a.y < -a.w && b.y < -b.w && c.y < -c.w) return true;
  if (a.z > a.w && b.z > b.w && c.z > c.w) return true;
  return a.z < 0.0f && b.z < 0.0f && c.z < 0.0f;
}

UMB_NAMESPACE_END
#endif
