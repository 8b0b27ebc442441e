// Visibility from the cascades of a directional light; a part of umbrage.glsl.

UMBRAGE_REFERENCE(UmbrageCascadeTables, CascadeTable, 8);
UMBRAGE_REFERENCE(UmbrageCascadeStates, CascadeState, 4);

/// Of depths that were rounded, as was the plane that they are compared with.
UMB_CONST float CascadeBiasUnits = 1.5f;

/// First of a light's cascades; NoIndex: it has none.
UMB_FN uint first_cascade(Frame frame, uint slot) {
  if (frame.cascades == 0ul) return NoIndex;
  UmbrageCascadeTables table = UmbrageCascadeTables(frame.cascades);
  for (uint i = 0u; i < table.v[0].cascades; i += table.v[0].count)
    if (table.v[0].records[i].light == slot) return i;
  return NoIndex;
}

/// Where a point lies on a cascade's map: texels and depth units from its origin.
UMB_FN vec3 place_on_cascade(CascadeRecord cascade, vec3 position_ws) {
  return grid_position(cascade, position_ws) - vec3(float(cascade.origin.x), float(cascade.origin.y), float(cascade.origin.z));
}

/// The point with all nine taps.
UMB_FN bool cascade_holds(CascadeRecord cascade, vec3 place) {
  float last = float(cascade.side) - 1.0f;
  return min(place.x, place.y) >= 1.0f && max(place.x, place.y) < last && place.z >= 0.0f && place.z <= float(FarDepth);
}

/// Nine taps (O16), each compared with the receiver's plane at its texel's centre.
UMB_FN float visibility_cascade(UmbrageCascadeTables table, uint index, vec3 position_ws, vec3 normal) {
  CascadeRecord cascade = table.v[0].records[index];
  CascadeState state = UmbrageCascadeStates(table.v[0].states).v[index];
  vec3 own = place_on_cascade(cascade, position_ws);
  vec3 plane = place_on_cascade(cascade, position_ws + normal * (NormalOffsetTexels * cascade.texel_m));
  float slope = min(dot(normal, cascade.z_row) * cascade.unit_m, -0.02f);
  float units = cascade.texel_m / cascade.unit_m;   // of depth, in a texel's length
  // Depth gained along the receiver's plane with each texel.
  vec2 gain = vec2(dot(normal, cascade.x_row), dot(normal, cascade.y_row)) * (-cascade.texel_m * units / slope);
  float deepest = TapDepthTexels * units;
  vec2 base = floor(vec2(own.x, own.y));
  vec3 columns = tap_weights(own.x - base.x);
  vec3 rows = tap_weights(own.y - base.y);
  uint which = state.shows_work != 0u ? 2u : state.front;
  uint first = which * table.v[0].texels + cascade.first_texel;
  UmbrageUints words = UmbrageUints(table.v[0].maps);
  float sum = 0.0f;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      vec2 texel = base + vec2(x, y);
      float depth = plane.z + min(dot(gain, texel + 0.5f - vec2(plane.x, plane.y)), deepest) - CascadeBiasUnits;
      uint stored = words.v[first + uint(round_to_int(texel.y)) * cascade.side + uint(round_to_int(texel.x))];
      sum += float(stored) >= depth ? columns[x + 1] * rows[y + 1] : 0.0f;
    }
  }
  return sum * 0.25f;
}

/// The cascade that answers for a point: that of its depth, or a farther one that holds it. NoIndex: beyond all.
UMB_FN uint cascade_at(UmbrageCascadeTables table, uint first, float t, vec3 position_ws) {
  uint count = table.v[0].count;
  for (uint i = 0u; i < count; ++i) {
    CascadeRecord cascade = table.v[0].records[first + i];
    if (t > cascade.end_m && i + 1u < count) continue;
    if (cascade_holds(cascade, place_on_cascade(cascade, position_ws))) return first + i;
  }
  return NoIndex;
}

/// From the first camera, whose view the cascades divide.
UMB_FN float camera_depth(Frame frame, vec3 position_ws) {
  vec4 row = UmbrageCameras(UmbrageFrames(frame.address).v[0].cameras).v[0].t_row;
  return dot(vec3(row.x, row.y, row.z), position_ws) + row.w;
}

/// first: first_cascade of the light. Towards its far end a cascade fades into the next, the last one into light.
UMB_FN float visibility_cascades(Frame frame, uint first, vec3 position_ws, vec3 normal) {
  UmbrageCascadeTables table = UmbrageCascadeTables(frame.cascades);
  float t = camera_depth(frame, position_ws);
  uint index = cascade_at(table, first, t, position_ws);
  if (index == NoIndex) return 1.0f;
  float near = visibility_cascade(table, index, position_ws, normal);
  CascadeRecord cascade = table.v[0].records[index];
  float fade_m = (cascade.end_m - cascade.begin_m) * table.v[0].blend;
  float share = fade_m > 0.0f ? clamp((t - cascade.end_m) / fade_m + 1.0f, 0.0f, 1.0f) : 0.0f;
  if (share == 0.0f) return near;
  if (index + 1u == first + table.v[0].count) return mix(near, 1.0f, share);
  if (!cascade_holds(table.v[0].records[index + 1u], place_on_cascade(table.v[0].records[index + 1u], position_ws))) return near;
  return mix(near, visibility_cascade(table, index + 1u, position_ws, normal), share);
}
