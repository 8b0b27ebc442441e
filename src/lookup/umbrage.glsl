// umbrage in a shading shader: clusters, lights and visibility in one file without includes. Callable from vertex, fragment,
// compute and ray generation shaders: no derivatives, no subgroup operations. Include it first. With the page pool
// it needs one address and no descriptor; for the other stores define UMBRAGE_SET as the set number at which
// ShadowSystem::descriptor_set_layout() is bound.
//
//   Frame frame = umbrage_frame(address);                     // ShaderInterface::frame
//   Cluster cluster = umbrage_cluster(frame, pixel, depth);   // or umbrage_cluster_at(frame, position_ws)
//   for (uint i = 0u; i < cluster.count; ++i) {
//     Light light = umbrage_light(frame, cluster, i);         // light.host_index finds colour and intensity
//     radiance += … * umbrage_visibility(frame, cluster, i, position_ws, geometric_normal_ws);
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
};

Frame umbrage_frame(uint64_t address) { return Frame(address); }

#include "lookup/find_cluster.glsl"

UMB_FN uint light_slot(Frame frame, Cluster cluster, uint i) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  if (cluster.first == NoIndex) return UmbrageUints(f.v[0].light_order).v[i];
  return UmbrageUints(f.v[0].cluster_lights).v[cluster.first + i];
}

/// i < cluster.count.
Light umbrage_light(Frame frame, Cluster cluster, uint i) {
  uint slot = light_slot(frame, cluster, i);
  LightRecord record = UmbrageLights(UmbrageFrames(frame.address).v[0].lights).v[slot];
  return Light(record.position_ws, record.type, record.direction_ws, record.range_m, record.cos_inner, record.cos_outer,
               record.host_index, slot);
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

#include "lookup/find_map.glsl"
#include "lookup/nine_taps.glsl"
#include "lookup/cascades.glsl"

UMB_FN float visibility_in_map(Frame frame, LightRecord light, Map map, vec3 position_ws, vec3 normal_ws, inout TapPage last) {
  if (light.views == ViewsOrtho) return visibility_ortho(frame, map, light.first_view, position_ws, normal_ws, last);
  vec3 relative = position_ws - light.position_ws;
  if (light.views == ViewsSpot) return visibility_spot(frame, map, relative, normal_ws, last);
  return visibility_cube(frame, map, relative, normal_ws, last);
}

UMB_FN void count_taps(Frame frame, uint unbacked, uint unmarked) {
#ifdef UMBRAGE_COUNT_TAPS
  UmbrageTapCounter counts = UmbrageTapCounter(UmbrageFrames(frame.address).v[0].tap_counts);
  if (unbacked > 0u) atomicAdd(counts.taps.unbacked, unbacked);
  if (unmarked > 0u) atomicAdd(counts.taps.unmarked, unmarked);
#endif
}

/// How much of light i of the cluster reaches a point: 0 nothing, 1 all. normal_ws: the surface's geometric normal, unit,
/// on the side that is seen. Meaningful where normal · light > 0 and the light is in range; lights that cast no shadow give
/// 1, surfaces that the cluster's normals show to face away give 0.
float umbrage_visibility(Frame frame, Cluster cluster, uint i, vec3 position_ws, vec3 normal_ws) {
  uint slot = light_slot(frame, cluster, i);
  LightRecord light = UmbrageLights(UmbrageFrames(frame.address).v[0].lights).v[slot];
  if (light.type == LightDirectional) {
    uint cascade = first_cascade(frame, slot);
    if (cascade != NoIndex) return visibility_cascades(frame, cascade, position_ws, normal_ws);
  }
  if (light.view_count == 0u) return 1.0f;
  Map map = map_of_pair(frame, cluster, i, slot);
  if (map.resolution == 0u) return 0.0f;
  TapPage last = TapPage(NoIndex, NoIndex, 0u);
  float visibility = visibility_in_map(frame, light, map, position_ws, normal_ws, last);
  if (last.missing == 0u) {
    if (map.whole != 0u) count_taps(frame, 0u, 9u);
    return visibility;
  }
  // Outside of what the depth buffer showed: all nine taps from the light's whole map, if it has one.
  Map whole = map_of_record(frame, whole_map(frame, slot), light.near_m);
  if (whole.resolution == 0u) {
    count_taps(frame, last.missing, 0u);
    return visibility;
  }
  count_taps(frame, 0u, last.missing);
  last = TapPage(NoIndex, NoIndex, 0u);
  return visibility_in_map(frame, light, whole, position_ws, normal_ws, last);
}

#include "lookup/footprint.glsl"
#ifdef UMBRAGE_DEBUG
#include "lookup/debug.glsl"
#endif
