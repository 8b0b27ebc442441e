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
  uint whole;        // 1: answers for points that nobody marked
  uint image;        // stores of images
  uint layer;        // of the first view
  uint faces;        // bit v: view v is drawn
  float depth_step;  // FrameRecord::depth_step
};

/// The map with which a light's visibility is looked up, where there is none: resolution 0.
UMB_FN Map map_of_record(Frame frame, uint index, float near_m) {
  if (index == NoIndex) return Map(0u, 0u, near_m, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0.0f);
  MapRecord record = UmbrageMapList(UmbrageFrames(frame.address).v[0].maps).v[index];
  return Map(record.first_view, record.resolution, near_m, record.pages, record.words, record.first_word, record.whole, record.image,
             record.layer, record.faces, UmbrageFrames(frame.address).v[0].depth_step);
}

UMB_FN uint whole_map(Frame frame, uint slot) { return UmbrageLightMapList(UmbrageFrames(frame.address).v[0].light_maps).v[slot].whole; }

/// A pair has a map of its own unless it faces away; points that no depth buffer saw have the light's whole map.
UMB_FN Map map_of_pair(Frame frame, Cluster cluster, uint i, uint slot) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  LightRecord light = UmbrageLights(f.v[0].lights).v[slot];
  if (store_of(frame) == StoreAtlas) return Map(light.first_view, light.resolution, light.near_m, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0.0f);
  uint index = cluster.is_sample == 0u ? NoIndex : UmbrageUints(f.v[0].pair_maps).v[cluster.first + i];
  return map_of_record(frame, index == NoIndex ? whole_map(frame, slot) : index, light.near_m);
}
