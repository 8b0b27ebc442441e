// Clusters: 32×32-pixel tiles × depth slices (O1), their boxes (O9) and light lists, and the record of a frame from which a
// shading shader reaches them.
#ifndef UMBRAGE_CLUSTERS_TYPES_SHARED_H
#define UMBRAGE_CLUSTERS_TYPES_SHARED_H
#include "clusters/frame_report.shared.h"
#include "scene/scene_types.shared.h"

UMB_NAMESPACE_BEGIN

/// A camera, whatever its projection. The point seen at normalised device coordinates (x, y) and view depth t is
/// origin + x origin_x + y origin_y + t (ray + x ray_x + y ray_y).
struct CameraRecord {
  vec3 origin, origin_x, origin_y;
  vec3 ray, ray_x, ray_y;
  vec4 depth_to_t;         // t = (x + y d) / (z + w d) for a depth-buffer value d
  vec4 t_row;              // t = xyz · world + w
  mat4 clip_from_world;
  uvec2 size;              // pixels
  uvec2 tiles;
  float slice_origin;      // t of the first slice's near side
  float slice_scale;       // slices per log2 of t (perspective) or per unit of t (orthographic)
  uint slices_are_logarithmic;
  uint slice_count;
  uint first_tile;         // tiles are numbered on from camera to camera
  uint end_tile;
};
UMB_ASSERT_SIZE(CameraRecord, 208);

/// Of a frame.
UMB_CONST uint MaxCameras = 8u;

/// 32 slices of a tile: which are occupied, and the number of the first one's cluster.
struct ClusterWord {
  uint occupied;
  uint first;
};
UMB_ASSERT_SIZE(ClusterWord, 8);

/// A cluster's lights: cluster_lights[first … first + count-1]. first = NoIndex: all lights, in the order of light_order.
struct ClusterList {
  uint first;
  uint count;
};
UMB_ASSERT_SIZE(ClusterList, 8);

/// Everything that a lookup needs, at one address. Each camera has such a record; they differ in `camera` alone, and the passes
/// read the first.
struct FrameRecord {
  CameraRecord camera;
  uint64_t cameras;          // CameraRecord
  uint64_t lights;           // LightRecord
  uint64_t light_order;      // slots of the lights alive, directional ones first
  uint64_t cluster_words;    // ClusterWord [tile][SliceWords]
  uint64_t cluster_cells;    // tile * MaxSlices + slice
  uint64_t cluster_boxes;    // Box
  uint64_t cluster_cones;    // vec4: axis, cosine of the half-angle
  uint64_t cluster_lists;    // ClusterList
  uint64_t cluster_lights;   // slots
  uint64_t counters;         // FrameCounters
  uint64_t views;            // ShadowView
  uint64_t tap_counts;       // TapCounts
  uint light_count;          // alive
  uint directional_count;
  uint cluster_capacity;
  uint pair_capacity;
  uint atlas_columns;        // tiles along the atlas' side
  uint atlas_resolution;     // texels along a tile's side
  uint explicit_bounds;      // ClusterBounds
  uint store;                // StoreAtlas, …
  // Virtual shadow maps (maps/map_types.shared.h); 0 with fixed cubes.
  uint64_t maps;             // MapRecord
  uint64_t light_maps;       // LightMaps per light slot
  uint64_t pair_maps;        // map of each cluster/light pair, or NoIndex: it faces away
  uint64_t page_bits;        // words: which pages there are
  uint64_t page_first;       // words: where they begin in the pool, in PoolUnit texels
  uint64_t pool;             // depth keys
  uint64_t texel_bits;       // of pages of PageSide a bit a texel (texel_word): lookups of samples read it; or 0
  uint64_t projection;       // receivers: ProjectionSide words a view
  uint64_t receiver_depth;   // bits of the farthest receiver depth, receiver_grid² a view
  uint receiver_grid;        // cells along a view's side: 1 (PMCD), 2 … 32
  uint map_capacity;
  float depth_step;          // of stored depths: what rounding may make of one more than it is; 0: 32 bits
  uint marks_blocks;         // 1: what the maps know of a cluster's receivers holds for the depth buffer's samples alone
  uint64_t cascades;         // CascadeTable, or 0
  uint camera_count;
  uint tile_count;           // of all cameras
  float caster_error;        // texels that simplified casters may lie off
  uint reserved;
};
UMB_ASSERT_SIZE(FrameRecord, 448);

/// FrameRecord::store.
UMB_CONST uint StoreAtlas = 0u;
UMB_CONST uint StorePool = 1u;
UMB_CONST uint StoreImages = 2u;      // whole maps in images of D16 depth
UMB_CONST uint StoreSparseWords = 3u; // pages of sparse images, depth keys
UMB_CONST uint StoreSparseDepth = 4u; // pages of sparse images, D16 depth

// --- Camera ---------------------------------------------------------------------------------------------------------

UMB_FN bool is_background(float device_depth) { return device_depth <= 0.0f || device_depth >= 1.0f; }

UMB_FN float view_depth(CameraRecord camera, float device_depth) {
  return (camera.depth_to_t.x + camera.depth_to_t.y * device_depth) / (camera.depth_to_t.z + camera.depth_to_t.w * device_depth);
}

UMB_FN vec2 ndc_of_pixel(CameraRecord camera, vec2 pixel) {
  return vec2(pixel.x / float(camera.size.x) * 2.0f - 1.0f, pixel.y / float(camera.size.y) * 2.0f - 1.0f);
}

UMB_FN vec3 world_position(CameraRecord camera, vec2 ndc, float t) {
  return camera.origin + camera.origin_x * ndc.x + camera.origin_y * ndc.y + (camera.ray + camera.ray_x * ndc.x + camera.ray_y * ndc.y) * t;
}

// --- Slices and cells -----------------------------------------------------------------------------------------------

UMB_FN uint slice_of(CameraRecord camera, float t) {
  float steps;
  if (camera.slices_are_logarithmic != 0u) {
    steps = t > camera.slice_origin ? log2(t / camera.slice_origin) * camera.slice_scale : 0.0f;
  } else {
    steps = (t - camera.slice_origin) * camera.slice_scale;
  }
  return floor_to_uint(steps, camera.slice_count - 1u);
}

/// View depth where a slice begins; slice_count: where the last one ends.
UMB_FN float slice_begin(CameraRecord camera, uint slice) {
  if (camera.slices_are_logarithmic != 0u) return camera.slice_origin * exp2(float(slice) / camera.slice_scale);
  return camera.slice_origin + float(slice) / camera.slice_scale;
}

/// World box of a cell (E4), from its eight corners: origin and ray are linear in the tile's corners, t adds them.
UMB_FN Box cell_box(CameraRecord camera, uvec2 tile, uint slice) {
  // log2 and exp2 round: a sample may sit a little outside of its slice.
  float t_near = slice_begin(camera, slice);
  float t_far = slice_begin(camera, slice + 1u);
  float slack = (t_far - t_near) * 0.01f;
  t_near -= slack;
  t_far += slack;
  Box box;
  box.lo = vec3(1e30f);
  box.hi = vec3(-1e30f);
  for (uint corner = 0u; corner < 4u; ++corner) {
    vec2 pixel = vec2(float((tile.x + (corner & 1u)) * TileSide), float((tile.y + (corner >> 1u)) * TileSide));
    vec2 ndc = ndc_of_pixel(camera, pixel);
    vec3 near_corner = world_position(camera, ndc, t_near);
    vec3 far_corner = world_position(camera, ndc, t_far);
    box.lo = min(box.lo, min(near_corner, far_corner));
    box.hi = max(box.hi, max(near_corner, far_corner));
  }
  return box;
}

// --- Explicit bounds (O9, E5): three 10-bit number lines inside the cell's box --------------------------------------

UMB_FN uint line_bit(float value, float lo, float hi) {
  float t = hi > lo ? (value - lo) / (hi - lo) : 0.0f;
  return floor_to_uint(10.0f * t, 9u);
}

/// The word that a sample ors into its cluster's; never 0, so that it marks the cluster as occupied too.
UMB_FN uint sample_bits(vec3 position, Box cell) {
  return (1u << line_bit(position.x, cell.lo.x, cell.hi.x)) | (1u << (10u + line_bit(position.y, cell.lo.y, cell.hi.y))) |
         (1u << (20u + line_bit(position.z, cell.lo.z, cell.hi.z)));
}

UMB_FN Box explicit_box(uint bits, Box cell) {
  Box box = cell;
  vec3 step_size = (cell.hi - cell.lo) * 0.1f;
  for (int axis = 0; axis < 3; ++axis) {
    uint line = (bits >> uint(10 * axis)) & 0x3ffu;
    float magnitude = max(abs(cell.lo[axis]), abs(cell.hi[axis]));
    float slack = step_size[axis] * 0.01f + magnitude * 1e-6f;
    // The outermost lines take what lies beyond them, so they end where the cell's box ends.
    box.lo[axis] = cell.lo[axis] + step_size[axis] * float(findLSB(line)) - slack;
    box.hi[axis] = cell.lo[axis] + step_size[axis] * float(findMSB(line) + 1) + slack;
  }
  return box;
}

UMB_NAMESPACE_END
#endif
