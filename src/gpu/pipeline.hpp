// Compute and depth-only graphics pipelines over the one pipeline layout that every pass uses.
#pragma once
#include <initializer_list>
#include <span>

#include "gpu/device.hpp"

namespace umbrage::gpu {

constexpr uint32_t kPushBytes = 128;  ///< What every Vulkan 1.3 device has.

/// A specialization constant: constant_id and its 32-bit value.
struct Constant {
  uint32_t id;
  uint32_t value;
};

class Pipeline {
 public:
  Pipeline() = default;
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;
  ~Pipeline();
  VkPipeline handle() const { return handle_; }
  VkPipelineBindPoint bind_point() const { return bind_point_; }

 private:
  friend class PipelineFactory;
  const Device* device_ = nullptr;
  VkPipeline handle_ = VK_NULL_HANDLE;
  VkPipelineBindPoint bind_point_ = VK_PIPELINE_BIND_POINT_COMPUTE;
};

/// What a depth pipeline draws with: no culling, no depth clamp (near plane clips), reversed Z.
struct DepthShaders {
  std::span<const uint32_t> vertex;
  std::span<const uint32_t> fragment;  ///< Empty: depth only.
  /// Instance attributes of binding 0, at locations 0, 1, …, 16 bytes each.
  std::span<const VkFormat> instance_attributes;
  uint32_t instance_stride_bytes = 0;
  VkFormat attachment =
      VK_FORMAT_D32_SFLOAT;  ///< UNDEFINED: the fragment shader writes where it likes, and there is no depth test.
  VkCompareOp compare = VK_COMPARE_OP_GREATER;
};

/// Owns descriptor set layouts and the pipeline layout. Set 0: per-frame images, and those that shaders write; set 1: masks.
class PipelineFactory {
 public:
  static Result<std::unique_ptr<PipelineFactory>> create(const Device&, uint32_t max_masks,
                                                         uint32_t storage_images = 0);
  ~PipelineFactory();
  PipelineFactory(const PipelineFactory&) = delete;
  Result<Pipeline> compute(std::span<const uint32_t> spirv, const char* name,
                           std::initializer_list<Constant> = {}) const;
  Result<Pipeline> depth(const DepthShaders&, const char* name, std::initializer_list<Constant> = {}) const;
  VkPipelineLayout layout() const { return layout_; }
  VkDescriptorSetLayout frame_set_layout() const { return frame_set_; }
  VkDescriptorSetLayout mask_set_layout() const { return mask_set_; }

 private:
  explicit PipelineFactory(const Device& device) : device_(device) {}
  Result<VkShaderModule> module(std::span<const uint32_t> spirv, const char* name) const;
  const Device& device_;
  VkDescriptorSetLayout frame_set_ = VK_NULL_HANDLE, mask_set_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
};

}  // namespace umbrage::gpu
