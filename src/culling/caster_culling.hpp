// Which batches each light's views need, and the draws that follow from it (O6, O12): count → scan → write.
#pragma once
#include "gpu/prefix_sum.hpp"
#include "scene/gpu_scene.hpp"
#include "store/fixed_cubes.hpp"

#include "culling/culling_types.shared.h"

namespace umbrage::culling {

class CasterCulling {
 public:
  /// Memory of an instance a round: its command may be among the opaque ones or the masked ones.
  static constexpr uint64_t kBytesAnInstance = sizeof(shared::CasterInstance) + 2 * sizeof(shared::DrawCommand);
  static Result<CasterCulling> create(const gpu::PipelineFactory&);
  /// capacity: instances a round. views_at_once and caster_slots size the command ranges of the traditional writer (0: not used).
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint32_t light_slots, uint32_t capacity,
                       uint32_t views_at_once, uint32_t caster_slots, std::vector<gpu::Buffer>& retired);
  struct Inputs {
    const scene::GpuScene& scene;
    const gpu::Buffer& views;
    const gpu::Buffer& counters;
    const gpu::Buffer& used_lights;
    const gpu::Buffer& frame;
    VkDeviceAddress tree_shape;  ///< In `frame`.
    umbrage::CasterCulling mode;
  };
  /// Counts instances and scans them; their number goes to FrameCounters::caster_pairs.
  void record_count(gpu::Recorder&, const Inputs&);
  /// Instances and commands of round `round`.
  void record_round(gpu::Recorder&, const Inputs&, uint32_t round);
  /// Commands of `count` views from `first` on, range by range.
  void record_views(gpu::Recorder&, const Inputs&, uint32_t first, uint32_t count);

  uint32_t capacity() const { return capacity_; }
  uint32_t view_range() const { return view_range_; }  ///< Commands a view and kind.
  const gpu::Buffer& instances() const { return instances_; }
  const gpu::Buffer& commands() const { return commands_; }
  const gpu::Buffer& draw_counts() const { return draw_counts_; }

 private:
  shared::TraversePush inputs(gpu::Pass&, const Inputs&) const;
  void clear_draw_counts(gpu::Recorder&);
  uint32_t capacity_ = 0, view_range_ = 0;
  gpu::Pipeline count_[2], write_[2], write_views_[2];
  gpu::PrefixSum scan_;
  gpu::Buffer counts_, instances_, commands_, draw_counts_;
};

}  // namespace umbrage::culling
