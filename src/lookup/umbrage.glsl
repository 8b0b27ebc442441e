// umbrage in a shading shader: clusters, lights and visibility in one file without includes. Callable from vertex, fragment,
// compute and ray generation shaders: no derivatives, no subgroup operations. Include it first. With the page pool
// it needs one address and no descriptor; for the other stores define UMBRAGE_SET as the set number at which
// ShadowSystem::descriptor_set_layout() is bound.
//
//   Frame frame = umbrage_frame(address);                     // ShaderInterface::frame; once, outside of loops and branches
//   Cluster cluster = umbrage_cluster(frame, pixel, depth);   // or umbrage_cluster_at(frame, position_ws)
//   for (uint i = 0u; i < cluster.count; ++i) {
//     Light light = umbrage_light(frame, cluster, i);         // light.host_index finds colour and intensity
//     radiance += … * umbrage_visibility(frame, light, position_ws, geometric_normal_ws);
//   }
// A system keeps its store for life: define UMBRAGE_STORE as a specialization constant that is ShadowSystem::shader_store(), and
// the code for other stores is gone.
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_samplerless_texture_functions : require

#include "clusters/cluster_types.shared.h"
#include "maps/map_types.shared.h"
#include "cascades/cascade_table.shared.h"

#define UMBRAGE_REFERENCE(name, type, align) \
  layout(buffer_reference, scalar, buffer_reference_align = align) readonly buffer name { type v[]; }
UMBRAGE_REFERENCE(UmbrageFrames, FrameRecord, 8);
UMBRAGE_REFERENCE(UmbrageCameras, CameraRecord, 4);
UMBRAGE_REFERENCE(UmbrageLights, LightRecord, 4);
UMBRAGE_REFERENCE(UmbrageViews, ShadowView, 4);
UMBRAGE_REFERENCE(UmbrageWords, ClusterWord, 4);
UMBRAGE_REFERENCE(UmbrageLists, ClusterList, 4);
UMBRAGE_REFERENCE(UmbrageBoxes, Box, 4);
UMBRAGE_REFERENCE(UmbrageCones, vec4, 4);
UMBRAGE_REFERENCE(UmbrageUints, uint, 4);
UMBRAGE_REFERENCE(UmbrageCounters, FrameCounters, 4);
UMBRAGE_REFERENCE(UmbrageMapList, MapRecord, 4);
UMBRAGE_REFERENCE(UmbrageLightMapList, LightMaps, 4);
#ifdef UMBRAGE_COUNT_TAPS   // needs stores and atomics in the host's stage
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer UmbrageTapCounter { TapCounts taps; };
#endif

#ifdef UMBRAGE_SET
#extension GL_EXT_nonuniform_qualifier : require
layout(set = UMBRAGE_SET, binding = 0) uniform texture2D umbrage_atlas;
layout(set = UMBRAGE_SET, binding = 1) uniform texture2DArray umbrage_images[MaxMapImages];
layout(set = UMBRAGE_SET, binding = 2) uniform utexture2DArray umbrage_words[MaxMapImages];
#endif

// --- What a host sees -----------------------------------------------------------------------------------------------

struct Frame {
  uint64_t address;
  // For the library: what lookups read of the frame's record.
  uint64_t lights;
  uint64_t light_order;
  uint64_t cluster_lights;
  uint64_t pair_maps;
  uint64_t maps;
  uint64_t page_bits;
  uint64_t page_first;
  uint64_t pool;
  uint64_t views;
  uint64_t cascades;
  float depth_step;
};

struct Cluster {
  uint index;        // among the occupied ones; NoIndex: a cell that the depth buffer never showed
  uint first;        // of its list; NoIndex: all lights
  uint count;        // lights
  uint is_sample;    // 0: a point that the depth buffer may not hold; answered by the lights' whole maps
};

struct Light {
  vec3 position_ws;
  uint type;         // 0 point, 1 spot, 2 directional
  vec3 direction_ws; // where it shines, unit
  float range_m;
  float cos_inner;
  float cos_outer;
  uint host_index;   // LightDesc::host_index
  uint index;        // the library's slot
  // For the library: what visibility takes besides.
  uint views;        // ViewsCube, …
  uint view_count;   // 0: casts no shadow
  uint first_view;
  uint resolution;
  float near_m;
  uint faces;        // LightDesc::faces
  uint map;          // of the pair of cluster and light; NoIndex: it faces away; WholeMap
};

Frame umbrage_frame(uint64_t address) {
  UmbrageFrames f = UmbrageFrames(address);
  return Frame(address, f.v[0].lights, f.v[0].light_order, f.v[0].cluster_lights, f.v[0].pair_maps, f.v[0].maps, f.v[0].page_bits,
               f.v[0].page_first, f.v[0].pool, f.v[0].views, f.v[0].cascades, f.v[0].depth_step);
}

#include "lookup/find_cluster.glsl"

UMB_FN uint light_slot(Frame frame, Cluster cluster, uint i) {
  bool listed = cluster.first != NoIndex;
  return UmbrageUints(listed ? frame.cluster_lights : frame.light_order).v[listed ? cluster.first + i : i];
}

#include "lookup/find_map.glsl"

/// i < cluster.count.
Light umbrage_light(Frame frame, Cluster cluster, uint i) {
  uint slot = light_slot(frame, cluster, i);
  UmbrageLights lights = UmbrageLights(frame.lights);
  return Light(lights.v[slot].position_ws, lights.v[slot].type, lights.v[slot].direction_ws, lights.v[slot].range_m,
               lights.v[slot].cos_inner, lights.v[slot].cos_outer, lights.v[slot].host_index, slot, lights.v[slot].views,
               lights.v[slot].view_count, lights.v[slot].first_view, lights.v[slot].resolution, lights.v[slot].near_m,
               lights.v[slot].faces, pair_map(frame, cluster, i));
}

uint umbrage_light_count(Frame frame) { return UmbrageFrames(frame.address).v[0].light_count; }

uint umbrage_cluster_count(Frame frame) {
  return UmbrageCounters(UmbrageFrames(frame.address).v[0].counters).v[0].clusters;
}

/// World box of an occupied cluster.
void umbrage_cluster_box(Frame frame, uint index, out vec3 lo, out vec3 hi) {
  Box box = UmbrageBoxes(UmbrageFrames(frame.address).v[0].cluster_boxes).v[index];
  lo = box.lo;
  hi = box.hi;
}

/// Axis and cosine of the half-angle of a cone with all normals of an occupied cluster.
vec4 umbrage_cluster_cone(Frame frame, uint index) {
  return UmbrageCones(UmbrageFrames(frame.address).v[0].cluster_cones).v[index];
}

/// Tile (counted row by row) and depth slice of a cluster; NoIndex for cells that the depth buffer never showed.
uvec2 umbrage_cluster_cell(Frame frame, Cluster cluster) {
  if (cluster.index == NoIndex) return uvec2(NoIndex);
  uint cell = UmbrageUints(UmbrageFrames(frame.address).v[0].cluster_cells).v[cluster.index];
  return uvec2(cell / MaxSlices - UmbrageFrames(frame.address).v[0].camera.first_tile, cell % MaxSlices);
}

#include "lookup/visibility.glsl"
#include "lookup/footprint.glsl"
#ifdef UMBRAGE_DEBUG
#include "lookup/debug.glsl"
#endif
