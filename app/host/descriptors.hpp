// One descriptor set with its layout and its pool.
#pragma once
#include "host/gpu_context.hpp"

namespace app {

class DescriptorSet {
 public:
  /// Every binding may stay unwritten as long as no shader touches it.
  static umbrage::Result<DescriptorSet> create(const GpuContext&, std::span<const VkDescriptorSetLayoutBinding>);
  VkDescriptorSetLayout layout() const { return layout_.get(); }
  VkDescriptorSet get() const { return set_; }
  void write_image(const GpuContext&, uint32_t binding, uint32_t element, VkDescriptorType,
                   VkDescriptorImageInfo) const;

 private:
  Handle<VkDescriptorSetLayout> layout_;
  Handle<VkDescriptorPool> pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace app
