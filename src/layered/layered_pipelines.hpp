// The graphics pipelines of one layered pass over a layout of their own: set 0 masks, set 1 the host's, 128 bytes of push constants.
#pragma once
#include <array>

#include "gpu/pipeline.hpp"
#include "layered/split_views.hpp"

namespace umbrage::layered {

/// Limits of the device that writers meet.
struct DeviceLimits {
  SplitLimits split;
  uint32_t geometry_invocations = 32;
  uint32_t task_groups = 65535;  ///< Along one dimension.
};
/// For triangles of `components` output components a vertex.
DeviceLimits device_limits(const gpu::Device&, VkPhysicalDevice, uint32_t components);

/// What the writer needs and the device lacks, in words; empty: nothing.
std::string_view missing_feature(LayeredWriter, const Capabilities&);

class LayeredPipelines {
 public:
  static Result<std::unique_ptr<LayeredPipelines>> create(const gpu::Device&, const gpu::PipelineFactory&,
                                                          const LayeredPassSettings&, const DeviceLimits&, bool masked);
  ~LayeredPipelines();
  LayeredPipelines(const LayeredPipelines&) = delete;
  VkPipelineLayout layout() const { return layout_; }
  VkShaderStageFlags push_stages() const { return push_stages_; }
  /// masked: with alpha masks. view_mask: multiview's, 0 otherwise. VK_NULL_HANDLE: create() made none.
  VkPipeline find(bool masked, uint32_t view_mask) const;

 private:
  struct Made {
    bool masked;
    uint32_t view_mask;
    VkPipeline pipeline;
  };
  explicit LayeredPipelines(const gpu::Device& device) : device_(device) {}
  Result<void> create_layout(const gpu::PipelineFactory&, const LayeredPassSettings&);
  Result<void> create_pipeline(const LayeredPassSettings&, const DeviceLimits&, bool masked, uint32_t view_mask);
  const gpu::Device& device_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkShaderStageFlags push_stages_ = 0;
  std::vector<Made> pipelines_;
};

}  // namespace umbrage::layered
