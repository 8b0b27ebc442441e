// Which map answers for a cluster/light pair; a part of umbrage.glsl.

/// Where the system keeps its maps. Without the set of images that can only be the page pool.
UMB_FN uint store_of(Frame frame) {
#if defined(UMBRAGE_STORE)
  return UMBRAGE_STORE;
#elif defined(UMBRAGE_SET)
  return UmbrageFrames(frame.address).v[0].store;
#else
  return StorePool;
#endif
}

/// A light's map as the taps need it.
struct Map {
  uint first_view;
  uint resolution;
  float near_m;
  uint pages;        // page pool: along a view's side
  uint words;        // page words a view
  uint first_word;
  uint receivers;    // ReceiversInSight, …
  uint image;        // stores of images
  uint layer;        // of the first view
  uint faces;        // bit v: view v is drawn
  float depth_step;  // FrameRecord::depth_step
};

/// A light's map. NoIndex, there is none: resolution 0. (Record 0 is there in any case: no branch.)
UMB_FN Map map_of_record(Frame frame, uint index, float near_m) {
  UmbrageMapList maps = UmbrageMapList(frame.maps);
  uint at = index == NoIndex ? 0u : index;
  uint resolution = index == NoIndex ? 0u : maps.v[at].resolution;
  uint pages = store_of(frame) == StoreImages ? 0u : pages_of(resolution);
  return Map(maps.v[at].first_view, resolution, near_m, pages, page_words_of(pages), maps.v[at].first_word, maps.v[at].receivers,
             maps.v[at].image, maps.v[at].layer, maps.v[at].faces, frame.depth_step);
}

UMB_FN uint whole_map(Frame frame, uint slot) { return UmbrageLightMapList(UmbrageFrames(frame.address).v[0].light_maps).v[slot].whole; }

/// A pair has a map of its own unless it faces away: NoIndex. Points that no depth buffer saw: WholeMap.
UMB_FN uint pair_map(Frame frame, Cluster cluster, uint i) {
  uint map = WholeMap;
  if (store_of(frame) != StoreAtlas && cluster.is_sample != 0u) map = UmbrageUints(frame.pair_maps).v[cluster.first + i];
  return map;
}

/// The map with which a light's visibility is looked up; the whole one, if there is one, of what has none of its own.
UMB_FN Map map_of_light(Frame frame, Light light) {
  Map map = Map(light.first_view, light.resolution, light.near_m, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0.0f);
  if (store_of(frame) != StoreAtlas) {
    uint index = light.map;
    if (index == NoIndex || index == WholeMap) index = whole_map(frame, light.index);
    map = map_of_record(frame, index, light.near_m);
  }
  return map;
}
