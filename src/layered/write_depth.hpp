// The compute writer: triangles into depth keys by atomics, keys into the layers of the depth image by one copy a group.
#pragma once
#include "gpu/recorder.hpp"
#include "layered/layered_types.shared.h"
#include "layered/split_views.hpp"

namespace umbrage::layered {

class DepthWriter {
 public:
  /// Texels whose keys are held at once: groups have as many layers as fit.
  static constexpr VkDeviceSize kMaxKeys = VkDeviceSize(64) << 20;

  static Result<DepthWriter> create(const gpu::PipelineFactory&, const LayeredPassSettings&, bool masked);
  /// Room for groups of up to `texels`.
  Result<void> reserve(const gpu::Device&, gpu::Memory&, VkDeviceSize texels, bool is_half,
                       std::vector<gpu::Buffer>& outgrown);

  struct Group {
    const ViewGroup& views;
    const LayeredTargetDesc& target;
    VkDeviceAddress scene = 0;  ///< A LayeredPush.
    VkDeviceAddress indices = 0;
    const gpu::Buffer &geometry, &moving, &visible, &listed, &block;
    VkDeviceSize empty_count = 0;   ///< In block: {0, 1, 1, 0}.
    VkDeviceSize first_count = 0;   ///< In block: LayeredCount of each list.
    VkDeviceSize first_listed = 0;  ///< In listed, bytes; each list has room for every caster.
    uint32_t caster_count = 0, list_count = 1;
  };
  void record(gpu::Recorder&, VkCommandBuffer, const Group&) const;

 private:
  void copy(gpu::Recorder&, VkCommandBuffer, const Group&) const;
  bool is_reversed_ = false;
  gpu::Pipeline batches_[2], large_[2], pack_;  // opaque, masked
  gpu::Buffer keys_, halves_, queue_, queue_count_;
};

}  // namespace umbrage::layered
