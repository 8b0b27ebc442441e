// Each image has a block of memory to itself, or (sparse) none.
#include "gpu/image.hpp"

#include <algorithm>
#include <utility>

namespace umbrage::gpu {

VkImageAspectFlags Image::aspect() const {
  const bool is_depth = desc_.format == VK_FORMAT_D32_SFLOAT || desc_.format == VK_FORMAT_D16_UNORM;
  return is_depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Result<Image> Image::create(const Device& device, Memory& memory, const ImageDesc& desc, const char* name) {
  Image image;
  image.desc_ = desc;
  image.name_ = name;
  image.sync.resource = memory.name_resource();
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  if (desc.sparse) info.flags = VK_IMAGE_CREATE_SPARSE_BINDING_BIT | VK_IMAGE_CREATE_SPARSE_RESIDENCY_BIT;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = image.layers();
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = desc.usage;
  const VkResult result = device.vk().vkCreateImage(device.handle(), &info, device.callbacks(), &image.handle_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateImage", name);
  image.device_ = &device;
  if (!desc.sparse)
    if (auto ok = image.bind_memory(memory); !ok) return ok.error();
  if (auto ok = image.create_view(); !ok) return ok.error();
  device.set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(image.handle_), name);
  return image;
}

Result<void> Image::bind_memory(Memory& memory) {
  VkMemoryRequirements needs;
  device_->vk().vkGetImageMemoryRequirements(device_->handle(), handle_, &needs);
  auto allocation = memory.allocate(needs, MemoryKind::device, name_, true);
  if (!allocation) return allocation.error();
  allocation_ = std::move(*allocation);
  const VkResult result =
      device_->vk().vkBindImageMemory(device_->handle(), handle_, allocation_.memory, allocation_.offset);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkBindImageMemory", name_);
  return {};
}

Result<void> Image::create_view() {
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = handle_;
  view.viewType = desc_.layers ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view.format = desc_.format;
  view.subresourceRange = {aspect(), 0, 1, 0, layers()};
  const VkResult result = device_->vk().vkCreateImageView(device_->handle(), &view, device_->callbacks(), &view_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateImageView", name_);
  return {};
}

Image::Image(Image&& other) noexcept { *this = std::move(other); }
Image& Image::operator=(Image&& other) noexcept {
  std::swap(device_, other.device_), std::swap(handle_, other.handle_), std::swap(view_, other.view_);
  std::swap(desc_, other.desc_), std::swap(name_, other.name_);
  std::swap(sync, other.sync), std::swap(allocation_, other.allocation_);
  return *this;
}
Image::~Image() {
  if (view_) device_->vk().vkDestroyImageView(device_->handle(), view_, device_->callbacks());
  if (handle_) device_->vk().vkDestroyImage(device_->handle(), handle_, device_->callbacks());
}

}  // namespace umbrage::gpu
