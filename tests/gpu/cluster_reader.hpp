// Clusters and their light lists as the device made them, read back.
#pragma once
#include <cmath>

#include "system_rig.hpp"

namespace umbrage::test {

struct DeviceClusters {
  shared::FrameRecord record;
  shared::FrameCounters counters;
  std::vector<shared::ClusterWord> words;
  std::vector<uint32_t> cells;
  std::vector<shared::Box> boxes;
  std::vector<glm::vec4> cones;
  std::vector<shared::ClusterList> lists;
  std::vector<uint32_t> lights, light_order;

  explicit DeviceClusters(SystemRig& rig) : record(rig.record()), counters(rig.counters()) {
    Gpu& gpu = rig.gpu();
    const auto buffers = rig.stages().clusters.published();
    const uint32_t tiles = record.camera.tiles.x * record.camera.tiles.y;
    words = gpu.download<shared::ClusterWord>(*buffers[0], tiles * shared::SliceWords);
    cells = gpu.download<uint32_t>(*buffers[1], counters.clusters);
    boxes = gpu.download<shared::Box>(*buffers[2], counters.clusters);
    cones = gpu.download<glm::vec4>(*buffers[3], counters.clusters);
    lists = gpu.download<shared::ClusterList>(*buffers[4], counters.clusters);
    lights = gpu.download<uint32_t>(*buffers[5], record.pair_capacity);
    light_order = gpu.download<uint32_t>(rig.stages().scene.light_order_buffer(), record.light_count);
  }

  bool occupied(uint32_t tile, uint32_t slice) const {
    return (words[tile * shared::SliceWords + slice / 32].occupied >> (slice % 32) & 1) != 0;
  }
  /// As cluster_of_cell in umbrage.glsl; NoIndex for free cells and for clusters beyond the capacity.
  uint32_t cluster_of(uint32_t tile, uint32_t slice) const {
    if (!occupied(tile, slice)) return shared::NoIndex;
    const shared::ClusterWord word = words[tile * shared::SliceWords + slice / 32];
    const uint32_t index =
        word.first + static_cast<uint32_t>(shared::bitCount(word.occupied & ((1u << slice % 32) - 1)));
    return index < record.cluster_capacity ? index : shared::NoIndex;
  }
  std::vector<uint32_t> lights_of(uint32_t cluster) const {
    if (cluster == shared::NoIndex || lists[cluster].first == shared::NoIndex) return light_order;
    const auto first = lights.begin() + lists[cluster].first;
    return {first, first + lists[cluster].count};
  }
};

/// The slice of a view depth before rounding down: where it is near a whole number, either neighbour is right.
inline float slice_steps(const shared::CameraRecord& camera, float t) {
  if (camera.slices_are_logarithmic == 0) return (t - camera.slice_origin) * camera.slice_scale;
  return t > camera.slice_origin ? std::log2(t / camera.slice_origin) * camera.slice_scale : 0.0f;
}
/// The slices that a sample may be in, first and last.
inline glm::uvec2 slices_of(const shared::CameraRecord& camera, float t) {
  const float steps = slice_steps(camera, t), last = float(camera.slice_count - 1);
  return glm::uvec2(glm::clamp(glm::vec2(steps - 1e-3f, steps + 1e-3f), glm::vec2(0), glm::vec2(last)));
}

inline bool holds(const shared::Box& box, const glm::vec3& point, float slack = 0) {
  return glm::all(glm::lessThanEqual(box.lo - slack, point)) && glm::all(glm::lessThanEqual(point, box.hi + slack));
}

}  // namespace umbrage::test
