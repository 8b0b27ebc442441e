// Which cluster a pixel or a point lies in; a part of umbrage.glsl.

UMB_FN Cluster cluster_of_cell(Frame frame, uvec2 tile, uint slice) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  uint tile_index = f.v[0].camera.first_tile + tile.y * f.v[0].camera.tiles.x + tile.x;
  ClusterWord word = UmbrageWords(f.v[0].cluster_words).v[tile_index * SliceWords + (slice >> 5u)];
  uint bit = 1u << (slice & 31u);
  uint index = word.first + uint(bitCount(word.occupied & (bit - 1u)));
  bool seen = (word.occupied & bit) != 0u && index < f.v[0].cluster_capacity;
  ClusterList list = UmbrageLists(f.v[0].cluster_lists).v[seen ? index : 0u];
  uint first = seen ? list.first : NoIndex;
  return Cluster(seen ? index : NoIndex, first, seen ? list.count : f.v[0].light_count, first == NoIndex ? 0u : 1u);
}

/// The cluster of a pixel (its centre: whole + 0.5) with a depth-buffer value. Background has no lights.
Cluster umbrage_cluster(Frame frame, vec2 pixel, float device_depth) {
  CameraRecord camera = UmbrageFrames(frame.address).v[0].camera;
  uvec2 tile = uvec2(floor_to_uint(pixel.x / float(TileSide), camera.tiles.x - 1u), floor_to_uint(pixel.y / float(TileSide), camera.tiles.y - 1u));
  Cluster cluster = cluster_of_cell(frame, tile, slice_of(camera, view_depth(camera, device_depth)));
  if (is_background(device_depth)) cluster = Cluster(NoIndex, NoIndex, 0u, 0u);
  return cluster;
}

/// The cluster of any point. Where the depth buffer showed nothing, and beside what it showed in a cell (the light lists know
/// of no more than that), the list holds all lights: right, and slower.
Cluster umbrage_cluster_at(Frame frame, vec3 position_ws) {
  CameraRecord camera = UmbrageFrames(frame.address).v[0].camera;
  vec4 clip = camera.clip_from_world * vec4(position_ws, 1.0f);
  vec2 pixel = (clip.xy / clip.w * 0.5f + 0.5f) * vec2(camera.size);
  if (!(clip.w > 0.0f) || any(lessThan(pixel, vec2(0.0f))) || any(greaterThanEqual(pixel, vec2(camera.size))))
    return Cluster(NoIndex, NoIndex, UmbrageFrames(frame.address).v[0].light_count, 0u);
  float t = dot(camera.t_row.xyz, position_ws) + camera.t_row.w;
  Cluster cluster = cluster_of_cell(frame, uvec2(pixel) / TileSide, slice_of(camera, t));
  if (cluster.index == NoIndex) return cluster;
  Box box = UmbrageBoxes(UmbrageFrames(frame.address).v[0].cluster_boxes).v[cluster.index];
  if (!all(lessThanEqual(box.lo, position_ws)) || !all(lessThanEqual(position_ws, box.hi)))
    return Cluster(NoIndex, NoIndex, UmbrageFrames(frame.address).v[0].light_count, 0u);
  cluster.is_sample = 1u - UmbrageFrames(frame.address).v[0].marks_blocks;
  return cluster;
}
