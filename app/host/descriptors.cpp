// Descriptor sets.
#include "host/descriptors.hpp"

#include <vector>

namespace app {

using umbrage::Result;

Result<DescriptorSet> DescriptorSet::create(const GpuContext& context,
                                            std::span<const VkDescriptorSetLayoutBinding> bindings) {
  DescriptorSet made;
  const std::vector<VkDescriptorBindingFlags> flags(bindings.size(), VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT);
  VkDescriptorSetLayoutBindingFlagsCreateInfo flags_info{
      VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
  flags_info.bindingCount = static_cast<uint32_t>(flags.size());
  flags_info.pBindingFlags = flags.data();
  VkDescriptorSetLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &flags_info};
  layout_info.bindingCount = static_cast<uint32_t>(bindings.size());
  layout_info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  VkResult result = context.vk.vkCreateDescriptorSetLayout(context.device(), &layout_info, nullptr, &layout);
  if (result != VK_SUCCESS) return vulkan_error("vkCreateDescriptorSetLayout", result);
  made.layout_ = {context.device(), layout, context.vk.vkDestroyDescriptorSetLayout};

  std::vector<VkDescriptorPoolSize> sizes;
  for (const auto& binding : bindings) sizes.push_back({binding.descriptorType, binding.descriptorCount});
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  pool_info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  result = context.vk.vkCreateDescriptorPool(context.device(), &pool_info, nullptr, &pool);
  if (result != VK_SUCCESS) return vulkan_error("vkCreateDescriptorPool", result);
  made.pool_ = {context.device(), pool, context.vk.vkDestroyDescriptorPool};

  VkDescriptorSetAllocateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  set_info.descriptorPool = pool;
  set_info.descriptorSetCount = 1;
  set_info.pSetLayouts = &layout;
  result = context.vk.vkAllocateDescriptorSets(context.device(), &set_info, &made.set_);
  if (result != VK_SUCCESS) return vulkan_error("vkAllocateDescriptorSets", result);
  return made;
}

void DescriptorSet::write_image(const GpuContext& context, uint32_t binding, uint32_t element, VkDescriptorType type,
                                VkDescriptorImageInfo image) const {
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set_;
  write.dstBinding = binding;
  write.dstArrayElement = element;
  write.descriptorCount = 1;
  write.descriptorType = type;
  write.pImageInfo = &image;
  context.vk.vkUpdateDescriptorSets(context.device(), 1, &write, 0, nullptr);
}

}  // namespace app
