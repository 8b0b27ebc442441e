// Visibility from nine taps of a shadow map (O16); a part of umbrage.glsl.
//
// Each tap compares the stored depth at a texel's centre with the depth at which the direction through that centre meets
// the receiver's tangent plane, so that a flat receiver cannot shadow itself at any slope. What remains to be biased away is
// the curvature within a tap's reach, in texels: the plane is moved NormalOffset texels towards the light's side.

const float UmbrageNormalOffset = 0.5f;

/// A light's map as the taps need it.
struct Map {
  uint first_view;
  uint views;
  uint resolution;
  float near_m;
};

UMB_FN float stored_depth(Frame frame, uint view, uvec2 texel) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  uvec2 tile = atlas_tile(view, f.v[0].atlas_columns, f.v[0].atlas_resolution);
  return texelFetch(umbrage_atlas, ivec2(tile + texel), 0).x;
}

/// How far the receiver's plane is moved: at most a tenth of the way to the light, or grazing planes would lose what stands on
/// them.
UMB_FN float normal_offset(float texel_m, vec3 relative, vec3 normal) {
  return clamp(UmbrageNormalOffset * texel_m, 0.0f, max(-0.1f * dot(normal, relative), 0.0f));
}

/// Adds (visibility, weight) of a tap along a direction whose axis depth is 1: visible when nothing nearer than the plane is
/// stored. Where a grazing plane cuts the tap's way to less than half of the receiver's, the tap counts for less.
UMB_FN void add_tap(Frame frame, Map map, uint view, uvec2 texel, vec3 normal, vec3 relative, vec3 direction, float weight, inout vec2 sum) {
  float depth = receiver_plane_depth(normal, relative, direction);
  float key = min(map.near_m / (depth * (1.0f - 4e-6f)), 1.0f);
  weight *= clamp(2.0f * depth * dot(direction, direction) / dot(relative, direction), 1e-6f, 1.0f);
  sum += weight * vec2(stored_depth(frame, view, texel) <= key ? 1.0f : 0.0f, 1.0f);
}

UMB_FN float visibility_cube(Frame frame, Map map, vec3 relative, vec3 normal) {
  uint face = face_of_direction(relative);
  vec3 place = face_coordinates(face, relative);
  relative += normal * normal_offset(texel_size_m(place.z, 1.0f, map.resolution), relative, normal);
  vec2 texels = (place.xy / place.z * 0.5f + 0.5f) * float(map.resolution);
  vec2 base = floor(texels);
  vec2 fraction = texels - base;
  vec2 sum = vec2(0.0f);
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      vec2 st = (base + vec2(x, y) + 0.5f) / float(map.resolution) * 2.0f - 1.0f;
      CubeTap tap = cube_tap(face, st.x, st.y);
      uvec2 texel = uvec2(texel_of(tap.s, map.resolution), texel_of(tap.t, map.resolution));
      if (tap.face != face) {
        tap.s = texel_centre(texel.x, map.resolution);
        tap.t = texel_centre(texel.y, map.resolution);
      }
      float weight = (x < 0 ? 1.0f - fraction.x : x > 0 ? fraction.x : 1.0f) * (y < 0 ? 1.0f - fraction.y : y > 0 ? fraction.y : 1.0f);
      add_tap(frame, map, map.first_view + tap.face, texel, normal, relative, face_direction(tap.face, tap.s, tap.t), weight, sum);
    }
  }
  return sum.x / sum.y;
}

UMB_FN float visibility_spot(Frame frame, Map map, vec3 relative, vec3 normal) {
  ShadowView view = UmbrageViews(UmbrageFrames(frame.address).v[0].views).v[map.first_view];
  float depth = dot(view.w_row, relative);
  if (!(depth > 0.0f)) return 1.0f;
  vec2 texels = (vec2(dot(view.x_row, relative), dot(view.y_row, relative)) / depth * 0.5f + 0.5f) * float(map.resolution);
  relative += normal * normal_offset(texel_size_m(depth, view.tangent, map.resolution), relative, normal);
  vec2 base = floor(texels);
  vec2 fraction = texels - base;
  vec2 sum = vec2(0.0f);
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      vec2 texel = clamp(base + vec2(x, y), vec2(0.0f), vec2(float(map.resolution - 1u)));
      vec2 st = ((texel + 0.5f) / float(map.resolution) * 2.0f - 1.0f) * (view.tangent * view.tangent);
      float weight = (x < 0 ? 1.0f - fraction.x : x > 0 ? fraction.x : 1.0f) * (y < 0 ? 1.0f - fraction.y : y > 0 ? fraction.y : 1.0f);
      add_tap(frame, map, map.first_view, uvec2(texel), normal, relative, view.w_row + view.x_row * st.x + view.y_row * st.y, weight, sum);
    }
  }
  return sum.x / sum.y;
}

UMB_FN float visibility_ortho(Frame frame, Map map, vec3 position_ws, vec3 normal) {
  ShadowView view = UmbrageViews(UmbrageFrames(frame.address).v[0].views).v[map.first_view];
  vec4 clip = view_clip_position(view, position_ws + normal * (UmbrageNormalOffset * view.side_m / float(map.resolution)));
  vec4 own = view_clip_position(view, position_ws);
  if (any(greaterThan(abs(own.xy), vec2(1.0f)))) return 1.0f;   // beyond every caster
  float half_side = view.side_m * 0.5f;
  vec3 forward = normalize(-view.z_row);
  float slope = min(dot(normal, forward), -0.02f);
  // Depth gained along the receiver's plane with each unit of clip x and y.
  vec2 gain = -vec2(dot(normal, view.x_row), dot(normal, view.y_row)) * half_side * half_side / slope * -length(view.z_row);
  vec2 texels = (own.xy * 0.5f + 0.5f) * float(map.resolution);
  vec2 base = floor(texels);
  vec2 fraction = texels - base;
  float sum = 0.0f;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      vec2 texel = clamp(base + vec2(x, y), vec2(0.0f), vec2(float(map.resolution - 1u)));
      vec2 st = (texel + 0.5f) / float(map.resolution) * 2.0f - 1.0f;
      float depth = max(clip.z + dot(gain, st - clip.xy) + 1e-6f, 0.0f);   // 0: behind every caster
      float weight = (x < 0 ? 1.0f - fraction.x : x > 0 ? fraction.x : 1.0f) * (y < 0 ? 1.0f - fraction.y : y > 0 ? fraction.y : 1.0f);
      sum += weight * (stored_depth(frame, map.first_view, uvec2(texel)) <= depth ? 1.0f : 0.0f);
    }
  }
  return sum * 0.25f;
}
