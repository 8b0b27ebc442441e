// Which batches each shadow map's views need, and the work items that follow from it (O6, O7, O22): count → scan → write.
#pragma once
#include <array>

#include "culling/culling_types.shared.h"
#include "gpu/prefix_sum.hpp"
#include "scene/gpu_scene.hpp"

namespace umbrage::culling {

class MapCulling {
 public:
  static constexpr uint32_t kModes = 5;  ///< Of umbrage::CasterCulling.
  /// Memory of an item a round: there may be as many masked ones as opaque ones.
  static constexpr uint64_t kBytesAnItem = 2 * sizeof(shared::CasterItem);
  /// node_test: NodesByLight, …; changes the time, never the items.
  static Result<MapCulling> create(const gpu::PipelineFactory&, uint32_t node_test = shared::NodesByView);
  /// Makes the pipelines of a mode, before it is recorded for the first time.
  Result<void> prepare(const gpu::PipelineFactory&, umbrage::CasterCulling);
  /// map_capacity: as many maps as there can be, at most 65535 (groups of a dispatch). item_capacity: items a round.
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint32_t map_capacity, uint32_t item_capacity,
                       std::vector<gpu::Buffer>& retired);
  struct Inputs {
    const scene::GpuScene& scene;
    const gpu::Buffer& frame;     ///< FrameRecord: names the buffers below.
    const gpu::Buffer& counters;  ///< FrameCounters: map_groups, maps and pair_limit are read.
    const gpu::Buffer& views;
    const gpu::Buffer& maps;
    const gpu::Buffer& projection;      ///< Receivers, of every map but whole ones for points anywhere; grown by filter and bias (E7).
    const gpu::Buffer& receiver_depth;  ///< Depths as ViewFootprint has them (E10).
    const gpu::Buffer& used_lights;
    VkDeviceAddress tree_shape;  ///< In `frame`.
    umbrage::CasterCulling mode;
  };
  /// Counts items and scans them; their number goes to FrameCounters::caster_pairs.
  void record_count(gpu::Recorder&, const Inputs&);
  /// The items of round `round` and how many there are. Light words of what no round will draw get LightLacksCasters.
  void record_round(gpu::Recorder&, const Inputs&, uint32_t round);

  uint32_t capacity() const { return capacity_; }
  /// shared::CasterItem: opaque ones from 0 on, masked ones from capacity() on.
  const gpu::Buffer& items() const { return items_; }
  const gpu::Buffer& draw_counts() const { return draw_counts_; }

 private:
  shared::ItemPush inputs(gpu::Pass&, const Inputs&) const;
  uint32_t node_test_ = 0, map_capacity_ = 0, capacity_ = 0;
  std::array<gpu::Pipeline, kModes> count_, write_;
  gpu::PrefixSum scan_;
  gpu::Buffer counts_, totals_, items_, draw_counts_;
};

}  // namespace umbrage::culling
