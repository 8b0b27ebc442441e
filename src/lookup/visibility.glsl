// How much of a light reaches a point; a part of umbrage.glsl.

#include "lookup/nine_taps.glsl"
#include "lookup/cascades.glsl"

UMB_FN float visibility_in_map(Frame frame, Light light, Map map, vec3 position_ws, vec3 normal_ws, inout uint missing) {
  vec3 relative = position_ws - light.position_ws;
  float visibility;
  if (light.views == ViewsCube) {
    visibility = visibility_cube(frame, map, relative, normal_ws, missing);
  } else if (light.views == ViewsSpot) {
    visibility = visibility_spot(frame, map, relative, normal_ws, missing);
  } else {
    visibility = visibility_ortho(frame, map, light.first_view, position_ws, normal_ws, missing);
  }
  return visibility;
}

UMB_FN void count_taps(Frame frame, uint unbacked, uint unmarked) {
#ifdef UMBRAGE_COUNT_TAPS
  UmbrageTapCounter counts = UmbrageTapCounter(UmbrageFrames(frame.address).v[0].tap_counts);
  if (unbacked > 0u) atomicAdd(counts.taps.unbacked, unbacked);
  if (unmarked > 0u) atomicAdd(counts.taps.unmarked, unmarked);
#endif
}

/// What the light's map says.
UMB_FN float visibility_mapped(Frame frame, Light light, vec3 position_ws, vec3 normal_ws) {
  Map map = map_of_light(frame, light);
  float visibility = 0.0f;
  if (map.resolution != 0u) {
    uint missing = 0u;   // taps without a page
    visibility = visibility_in_map(frame, light, map, position_ws, normal_ws, missing);
    if (missing != 0u) {
      // Outside of what the depth buffer showed: all nine taps from the light's whole map, if it has one.
      Map whole = map_of_record(frame, whole_map(frame, light.index), light.near_m);
      if (whole.resolution == 0u) {
        count_taps(frame, missing, 0u);
      } else {
        count_taps(frame, 0u, missing);
        visibility = visibility_in_map(frame, light, whole, position_ws, normal_ws, missing);
      }
    } else if (map.whole != 0u) {
      count_taps(frame, 0u, 9u);
    }
  }
  return visibility;
}

/// How much of a light, umbrage_light(frame, cluster, i), reaches a point: 0 nothing, 1 all. normal_ws: the surface's geometric
/// normal, unit, on the side that is seen. Meaningful where normal · light > 0 and the light is in range, a spot's cone
/// included; lights that cast no shadow give 1, surfaces that the cluster's normals show to face away give 0.
float umbrage_visibility(Frame frame, Light light, vec3 position_ws, vec3 normal_ws) {
  float visibility = 1.0f;
  uint cascade = NoIndex;
  if (light.type == LightDirectional) cascade = first_cascade(frame, light.index);
  if (cascade != NoIndex) {
    visibility = visibility_cascades(frame, cascade, position_ws, normal_ws);
  } else if (light.view_count != 0u) {
    visibility = visibility_mapped(frame, light, position_ws, normal_ws);
  }
  return visibility;
}

/// The same of light i of the cluster.
float umbrage_visibility(Frame frame, Cluster cluster, uint i, vec3 position_ws, vec3 normal_ws) {
  return umbrage_visibility(frame, umbrage_light(frame, cluster, i), position_ws, normal_ws);
}
