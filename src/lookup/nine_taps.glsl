// Visibility from nine taps of a shadow map (O16); a part of umbrage.glsl.
//
// Each tap compares the stored depth at a texel's centre with the depth at which the direction through that centre meets
// the receiver's tangent plane, so that a flat receiver cannot shadow itself at any slope. What remains to be biased away is
// the curvature within a tap's reach, in texels: the plane is moved NormalOffset texels towards the light's side.

#include "lookup/stored_depth.glsl"

/// How far the receiver's plane is moved: along the way to the light by eight texels at most, and by a twentieth of it, or
/// grazing planes would lose what stands on them.
UMB_FN float normal_offset(float texel_m, vec3 relative, vec3 normal) {
  float share = min(0.05f, 8.0f * texel_m / length(relative));
  return clamp(NormalOffsetTexels * texel_m, 0.0f, max(-share * dot(normal, relative), 0.0f));
}

/// Adds (visibility, weight) of a tap along a direction whose axis depth is 1: visible when nothing nearer than the plane is
/// stored. No tap compares deeper than `deepest`. Where a grazing plane cuts the tap's way to less than half of the
/// receiver's, the tap counts for less.
UMB_FN void add_tap(Map map, float stored, vec3 normal, vec3 relative, vec3 direction, float deepest, float weight, inout vec2 sum) {
  float depth = receiver_plane_depth(normal, relative, direction);
  weight *= clamp(2.0f * depth * dot(direction, direction) / dot(relative, direction), 1e-6f, 1.0f);
  float key = min(map.near_m / (min(depth, deepest) * (1.0f - 4e-6f)) + map.depth_step, 1.0f);
  sum += weight * vec2(stored <= key ? 1.0f : 0.0f, 1.0f);
}

/// Of three texels along an axis: how much of the middle texel's width around the point each covers.
UMB_FN vec3 tap_weights(float fraction) { return vec3(1.0f - fraction, 1.0f, fraction); }

/// A texel (whole, counted from the view's border) and its neighbours, within the view.
UMB_FN Nine texels_around(vec2 base, uint resolution) {
  float last = float(resolution - 1u);
  vec3 x = clamp(base.x + vec3(-1.0f, 0.0f, 1.0f), 0.0f, last);
  vec3 y = clamp(base.y + vec3(-1.0f, 0.0f, 1.0f), 0.0f, last);
  return Nine(uvec3(round_to_int(x.x), round_to_int(x.y), round_to_int(x.z)), uvec3(round_to_int(y.x), round_to_int(y.y), round_to_int(y.z)));
}

/// When all nine taps lie on the receiver's own face: everything in the face's frame, where a direction is
/// (s, t, 1). The same comparison as add_tap's with its divisions multiplied out, three taps of a row at a time.
UMB_FN float visibility_face(Frame frame, Map map, uint face, vec3 relative, vec3 normal, vec2 base, vec2 fraction, inout uint missing) {
  uvec2 middle = uvec2(round_to_int(base.x), round_to_int(base.y));
  vec3 depths[3];
  nine_of_pages(frame, map, face, Nine(middle.x + uvec3(-1, 0, 1), middle.y + uvec3(-1, 0, 1)), missing, depths);
  float side = 2.0f / float(map.resolution);
  float plane_distance = dot(normal, relative);
  float deepest = relative.z * (1.0f + TapDepthTexels * side);
  vec3 s = (base.x + vec3(-0.5f, 0.5f, 1.5f)) * side - 1.0f;
  vec3 t = (base.y + vec3(-0.5f, 0.5f, 1.5f)) * side - 1.0f;
  vec3 columns = tap_weights(fraction.x);
  vec3 rows = tap_weights(fraction.y);
  vec2 sum = vec2(0.0f);
  for (uint y = 0u; y < 3u; ++y) {
    // Products with the directions (s, t, 1).
    vec3 square = s * s + (t[y] * t[y] + 1.0f);
    vec3 along = s * relative.x + (t[y] * relative.y + relative.z);
    vec3 slope = s * normal.x + (t[y] * normal.y + normal.z);
    // The plane's depth over the receiver's own along this direction: receiver_plane_depth.
    vec3 ratio = plane_distance * square / (slope * along);
    for (uint x = 0u; x < 3u; ++x) ratio[x] = ratio[x] > 0.0f && ratio[x] <= 4.0f ? ratio[x] : 1.0f;
    vec3 weight = columns * rows[y] * min(2.0f * ratio, 1.0f);
    vec3 stored = depths[y] - map.depth_step;
    bvec3 lit = lessThanEqual(stored * min(ratio * along, deepest * square) * (1.0f - 4e-6f), map.near_m * square);
    sum += vec2(dot(weight, vec3(lit)), weight.x + weight.y + weight.z);
  }
  return sum.x / sum.y;
}

/// The same with taps that may lie on other faces.
UMB_FN float visibility_faces(Frame frame, Map map, uint face, vec3 relative, vec3 normal, vec2 base, vec2 fraction, inout uint missing) {
  float reach = 1.0f + TapDepthTexels * 2.0f / float(map.resolution);
  vec3 columns = tap_weights(fraction.x);
  vec3 rows = tap_weights(fraction.y);
  vec2 sum = vec2(0.0f);
  for (uint y = 0u; y < 3u; ++y) {
    for (uint x = 0u; x < 3u; ++x) {
      vec2 st = (base + vec2(x, y) - 0.5f) / float(map.resolution) * 2.0f - 1.0f;
      CubeTap tap = cube_tap(face, st.x, st.y);
      uvec2 texel = uvec2(texel_of(tap.s, map.resolution), texel_of(tap.t, map.resolution));
      if (tap.face != face) {
        tap.s = texel_centre(texel.x, map.resolution);
        tap.t = texel_centre(texel.y, map.resolution);
      }
      float stored = stored_depth(frame, map, tap.face, texel, missing);
      float deepest = face_coordinates(tap.face, relative).z * reach;
      add_tap(map, stored, normal, relative, face_direction(tap.face, tap.s, tap.t), deepest, columns[x] * rows[y], sum);
    }
  }
  return sum.x / sum.y;
}

UMB_FN float visibility_cube(Frame frame, Map map, vec3 relative, vec3 normal, inout uint missing) {
  uint face = face_of_direction(relative);
  vec3 place = face_coordinates(face, relative);
  vec2 texels = (place.xy / place.z * 0.5f + 0.5f) * float(map.resolution);
  vec2 base = floor(texels);
  vec2 fraction = texels - base;
  relative += normal * normal_offset(texel_size_m(place.z, 1.0f, map.resolution), relative, normal);
  float visibility;
  if (map.pages != 0u && all(greaterThanEqual(base, vec2(1.0f))) && all(lessThan(base, vec2(float(map.resolution) - 1.0f)))) {
    visibility = visibility_face(frame, map, face, face_coordinates(face, relative), face_coordinates(face, normal), base, fraction, missing);
  } else {
    visibility = visibility_faces(frame, map, face, relative, normal, base, fraction, missing);
  }
  return visibility;
}

UMB_FN float visibility_spot(Frame frame, Map map, vec3 relative, vec3 normal, inout uint missing) {
  ShadowView view = UmbrageViews(frame.views).v[map.first_view];
  float depth = dot(view.w_row, relative);
  if (!(depth > 0.0f)) return 1.0f;
  vec2 texels = (vec2(dot(view.x_row, relative), dot(view.y_row, relative)) / depth * 0.5f + 0.5f) * float(map.resolution);
  relative += normal * normal_offset(texel_size_m(depth, view.tangent, map.resolution), relative, normal);
  vec2 base = floor(texels);
  vec3 columns = tap_weights(texels.x - base.x);
  vec3 rows = tap_weights(texels.y - base.y);
  float deepest = dot(view.w_row, relative) * (1.0f + TapDepthTexels * 2.0f * view.tangent / float(map.resolution));
  Nine nine = texels_around(base, map.resolution);
  vec3 depths[3];
  nine_depths(frame, map, 0u, nine, missing, depths);
  vec2 sum = vec2(0.0f);
  for (uint y = 0u; y < 3u; ++y) {
    for (uint x = 0u; x < 3u; ++x) {
      vec2 st = ((vec2(nine.columns[x], nine.rows[y]) + 0.5f) / float(map.resolution) * 2.0f - 1.0f) * (view.tangent * view.tangent);
      vec3 direction = view.w_row + view.x_row * st.x + view.y_row * st.y;
      add_tap(map, depths[y][x], normal, relative, direction, deepest, columns[x] * rows[y], sum);
    }
  }
  return sum.x / sum.y;
}

UMB_FN bool is_beyond(vec2 clip) { return any(greaterThan(abs(clip), vec2(1.0f))); }

/// casters: the light's view that holds every caster.
UMB_FN float visibility_ortho(Frame frame, Map map, uint casters, vec3 position_ws, vec3 normal, inout uint missing) {
  ShadowView view = UmbrageViews(frame.views).v[map.first_view];
  vec4 clip = view_clip_position(view, position_ws + normal * (NormalOffsetTexels * view.side_m / float(map.resolution)));
  vec4 own = view_clip_position(view, position_ws);
  if (is_beyond(own.xy)) {
    // Beyond every caster; or beside a level's window, in what no depth buffer showed.
    if (map.first_view != casters && !is_beyond(view_clip_position(UmbrageViews(frame.views).v[casters], position_ws).xy))
      missing += 9u;
    return 1.0f;
  }
  float half_side = view.side_m * 0.5f;
  vec3 forward = normalize(-view.z_row);
  float slope = min(dot(normal, forward), -0.02f);
  float deepest = TapDepthTexels * view.side_m / float(map.resolution) * length(view.z_row);
  // Depth gained along the receiver's plane with each unit of clip x and y.
  vec2 gain = -vec2(dot(normal, view.x_row), dot(normal, view.y_row)) * half_side * half_side / slope * -length(view.z_row);
  vec2 texels = (own.xy * 0.5f + 0.5f) * float(map.resolution);
  vec2 base = floor(texels);
  vec3 columns = tap_weights(texels.x - base.x);
  vec3 rows = tap_weights(texels.y - base.y);
  Nine nine = texels_around(base, map.resolution);
  vec3 depths[3];
  nine_depths(frame, map, 0u, nine, missing, depths);
  float sum = 0.0f;
  for (uint y = 0u; y < 3u; ++y) {
    for (uint x = 0u; x < 3u; ++x) {
      vec2 st = (vec2(nine.columns[x], nine.rows[y]) + 0.5f) / float(map.resolution) * 2.0f - 1.0f;
      float depth = max(clip.z + max(dot(gain, st - clip.xy), -deepest) + 1e-6f + map.depth_step, 0.0f);   // 0: behind every caster
      sum += depths[y][x] <= depth ? columns[x] * rows[y] : 0.0f;
    }
  }
  return sum * 0.25f;
}
