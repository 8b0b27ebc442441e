// Lighting: every pixel of the G-buffer, then blended surfaces over it.
#pragma once
#include "host/frame_data.hpp"
#include "host/gbuffer.hpp"

namespace app {

class ShadePass {
 public:
  static umbrage::Result<ShadePass> create(const GpuContext&, VkPipelineLayout, const Targets&);
  /// Afterwards the colour target is in storage use.
  void record(PassContext&) const;
  /// Blended surfaces, back to front. Before and after: colour in storage use, depth in depth_read.
  void record_blended(PassContext&, const DrawList&, VkBuffer indices, const CameraMatrices&);

 private:
  Handle<VkPipeline> shade_, blended_;
  std::vector<std::pair<float, uint32_t>> order_;  ///< (distance along the view, draw), kept to save allocations.
};

}  // namespace app
