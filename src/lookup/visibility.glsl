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

/// What the light's map says. Without one, and beside its marks, a point that no depth buffer saw is lit, and one of a cluster whose
/// normals face away is dark.
UMB_FN float visibility_mapped(Frame frame, Light light, vec3 position_ws, vec3 normal_ws) {
  Map map = map_of_light(frame, light);
  float visibility = light.map == NoIndex ? 0.0f : 1.0f;
  if (map.resolution != 0u) {
    uint missing = 0u;   // taps without a page
    float mapped = visibility_in_map(frame, light, map, position_ws, normal_ws, missing);
    if (map.receivers != ReceiversInSight) {
      if (light.map != NoIndex || missing == 0u) {
        visibility = mapped;
        count_taps(frame, missing, 9u - missing);
      }
    } else {
      visibility = mapped;
      if (missing != 0u) {
        // Outside of what the depth buffer showed: all nine taps from the light's whole map, if it has one.
        Map whole = map_of_record(frame, whole_map(frame, light.index), light.near_m);
        if (whole.resolution == 0u) {
          count_taps(frame, missing, 0u);
        } else {
          count_taps(frame, 0u, missing);
          missing = 0u;
          visibility = visibility_in_map(frame, light, whole, position_ws, normal_ws, missing);
          count_taps(frame, missing, 0u);
        }
      }
    }
  }
  return visibility;
}

/// How much of a light, umbrage_light(frame, cluster, i), reaches a point: 0 nothing, 1 all. normal_ws: the surface's geometric
/// normal, unit, on the side that is seen. Meaningful where normal · light > 0 and the light is in range, a spot's cone
/// included; lights that cast no shadow give 1, surfaces that the cluster's normals show to face away give 0, and so does what lies
/// beyond cube faces that a point light does not shine through. Of points that no depth buffer saw only those are shadowed of which
/// CameraDesc::other_receivers speaks.
float umbrage_visibility(Frame frame, Light light, vec3 position_ws, vec3 normal_ws) {
  float visibility = 1.0f;
  uint cascade = NoIndex;
  if (light.type == LightDirectional) cascade = first_cascade(frame, light.index);
  if (cascade != NoIndex) {
    visibility = visibility_cascades(frame, cascade, position_ws, normal_ws);
  } else if (light.faces != AllCubeFaces && (light.faces >> face_of_direction(position_ws - light.position_ws) & 1u) == 0u) {
    visibility = 0.0f;
  } else if (light.view_count != 0u) {
    visibility = visibility_mapped(frame, light, position_ws, normal_ws);
  }
  return visibility;
}

/// The same of light i of the cluster.
float umbrage_visibility(Frame frame, Cluster cluster, uint i, vec3 position_ws, vec3 normal_ws) {
  return umbrage_visibility(frame, umbrage_light(frame, cluster, i), position_ws, normal_ws);
}
