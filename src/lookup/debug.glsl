// What debug pictures ask of a frame: maps, pages and receivers of a light. A part of umbrage.glsl for hosts that define
// UMBRAGE_DEBUG before including it; nothing here is needed for shading.

/// One of a light's maps. resolution 0: there is none (the surface faces away, or the light casts no shadow).
struct DebugMap {
  uint index;        // among the frame's maps; NoIndex: fixed cubes
  uint slot;         // Light::index
  uint first_view;
  uint view_count;   // 6: cube faces +X, -X, +Y, -Y, +Z, -Z; or 1
  uint resolution;   // texels along a view's side
  uint pages;        // along a view's side; 0: not made of pages
  uint page_side;    // texels
  bool whole;        // every page is there, and nothing is known of the receivers
  uint triangles;    // (triangle, view) pairs drawn into it; fixed cubes: not counted
};

/// A place on a map. view NoIndex: the point is on none of its views.
struct DebugTexel {
  uint view;
  vec2 at;           // texels from the view's first corner
};

UMB_FN DebugMap debug_no_map(uint slot) { return DebugMap(NoIndex, slot, 0u, 0u, 0u, 0u, 0u, false, 0u); }

/// Map `index` of the frame, one of debug_light_maps.
UMB_FN DebugMap debug_map_at(Frame frame, uint index, uint slot) {
  MapRecord map = UmbrageMapList(UmbrageFrames(frame.address).v[0].maps).v[index];
  return DebugMap(index, slot, map.first_view, map.view_count, map.resolution, map.pages, page_side_of(map.resolution), map.receivers == ReceiversAnywhere,
                  map.triangles);
}

/// The map that umbrage_visibility looks up for light i of a cluster.
UMB_FN DebugMap debug_map(Frame frame, Cluster cluster, uint i) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  uint slot = light_slot(frame, cluster, i);
  LightRecord light = UmbrageLights(f.v[0].lights).v[slot];
  if (light.view_count == 0u) return debug_no_map(slot);
  if (store_of(frame) == StoreAtlas)
    return DebugMap(NoIndex, slot, light.first_view, light.view_count, light.resolution, 0u, light.resolution, false, 0u);
  uint index = cluster.is_sample == 0u ? NoIndex : UmbrageUints(f.v[0].pair_maps).v[cluster.first + i];
  if (index == NoIndex) index = whole_map(frame, slot);
  return index == NoIndex ? debug_no_map(slot) : debug_map_at(frame, index, slot);
}

/// A light's maps: x the first one, y how many, finest first. None with fixed cubes.
UMB_FN uvec2 debug_light_maps(Frame frame, uint slot) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  if (store_of(frame) == StoreAtlas) return uvec2(NoIndex, 0u);
  LightMaps maps = UmbrageLightMapList(f.v[0].light_maps).v[slot];
  return uvec2(maps.first, maps.count);
}

/// An occupied cluster by its number.
UMB_FN Cluster debug_cluster(Frame frame, uint index) {
  ClusterList list = UmbrageLists(UmbrageFrames(frame.address).v[0].cluster_lists).v[index];
  return Cluster(index, list.first, list.count, list.first == NoIndex ? 0u : 1u);
}

/// Where a point falls on a map.
UMB_FN DebugTexel debug_texel(Frame frame, DebugMap map, vec3 position_ws) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  LightRecord light = UmbrageLights(f.v[0].lights).v[map.slot];
  uint seen = 0u;
  vec2 st;
  if (light.views == ViewsCube) {
    seen = face_of_direction(position_ws - light.position_ws);
    vec3 place = face_coordinates(seen, position_ws - light.position_ws);
    st = place.xy / place.z;
  } else {
    vec4 clip = view_clip_position(UmbrageViews(f.v[0].views).v[map.first_view], position_ws);
    if (!(clip.w > 0.0f)) return DebugTexel(NoIndex, vec2(0.0f));
    st = clip.xy / clip.w;
  }
  if (!all(lessThanEqual(abs(st), vec2(1.0f)))) return DebugTexel(NoIndex, vec2(0.0f));
  return DebugTexel(seen, (st * 0.5f + 0.5f) * float(map.resolution));
}

/// Has a page memory and depths? map.pages > 0, page < map.pages.
UMB_FN bool debug_page_is_marked(Frame frame, DebugMap map, uint view, uvec2 page) {
  MapRecord record = UmbrageMapList(UmbrageFrames(frame.address).v[0].maps).v[map.index];
  PagePlace place = page_place(record, view, page * PageSide);
  return (UmbrageUints(UmbrageFrames(frame.address).v[0].page_bits).v[place.word] & 1u << place.bit) != 0u;
}

/// Row `row` of 32 of a view's projection map: bit x is set where tile x has receivers. map.pages > 0.
UMB_FN uint debug_receiver_row(Frame frame, DebugMap map, uint view, uint row) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  if (map.whole) return 0xffffffffu;
  uint first = UmbrageMapList(f.v[0].maps).v[map.index].first_receiver;
  return UmbrageUints(f.v[0].projection).v[(first + view) * ProjectionSide + row];
}

/// The farthest depth at which receivers are looked up around a place of a view (0…1 along its sides): metres along the
/// view's axis, ortho views 0…1; 0 without receivers. map.pages > 0.
UMB_FN float debug_receiver_depth(Frame frame, DebugMap map, uint view, vec2 place) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  uint side = f.v[0].receiver_grid;
  uvec2 cell = min(uvec2(place * float(side)), uvec2(side - 1u));
  uint first = UmbrageMapList(f.v[0].maps).v[map.index].first_receiver;
  return uintBitsToFloat(UmbrageUints(f.v[0].receiver_depth).v[((first + view) * side + cell.y) * side + cell.x]);
}

/// Cascades of a light, near to far; 0: the light has none. index: Light::index.
UMB_FN uint debug_cascade_count(Frame frame, uint index) {
  return first_cascade(frame, index) == NoIndex ? 0u : UmbrageCascadeTables(UmbrageFrames(frame.address).v[0].cascades).v[0].count;
}

/// Texels along a cascade's side.
UMB_FN uint debug_cascade_side(Frame frame, uint index, uint cascade) {
  UmbrageCascadeTables table = UmbrageCascadeTables(UmbrageFrames(frame.address).v[0].cascades);
  return table.v[0].records[first_cascade(frame, index) + cascade].side;
}

/// What a cascade's texel holds, as heights above the volume's far side in units of its width; below 0 where nothing is. x: the
/// finished map; y: the static one as it was taken over from the frame before; z: what was drawn onto that. Of a map that was
/// kept, y is all of it.
UMB_FN vec3 debug_cascade_heights(Frame frame, uint index, uint cascade, uvec2 texel) {
  UmbrageCascadeTables table = UmbrageCascadeTables(UmbrageFrames(frame.address).v[0].cascades);
  uint i = first_cascade(frame, index) + cascade;
  CascadeRecord record = table.v[0].records[i];
  CascadeState state = UmbrageCascadeStates(table.v[0].states).v[i];
  UmbrageUints words = UmbrageUints(table.v[0].maps);
  uint at = record.first_texel + texel.y * record.side + texel.x;
  uint front = words.v[state.front * table.v[0].texels + at];
  uint finished = state.shows_work != 0u ? words.v[2u * table.v[0].texels + at] : front;
  uint taken = state.action == MapIsKept ? front : ClearDepth;
  ivec2 from = ivec2(texel) + ivec2(record.origin.x - record.former.x, record.origin.y - record.former.y);
  if (state.action == MapIsScrolled && min(from.x, from.y) >= 0 && max(from.x, from.y) < int(record.side)) {
    uint back = (1u - state.front) * table.v[0].texels + record.first_texel + uint(from.y) * record.side + uint(from.x);
    taken = scrolled_depth(words.v[back], record.origin.z - record.former.z);
  }
  uint drawn = front == taken ? ClearDepth : front;
  vec3 heights = vec3(float(FarDepth) - vec3(float(finished), float(taken), float(drawn))) * record.unit_m / (float(record.side) * record.texel_m);
  return heights;
}
