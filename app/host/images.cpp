// DeviceImage creation, transitions, mip chains.
#include "host/images.hpp"

#include <vk_mem_alloc.h>

#include <algorithm>

namespace app {

using umbrage::Error;
using umbrage::Result;

namespace {

struct UseInfo {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
};

constexpr VkPipelineStageFlags2 depth_stages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags2 shader_stages =
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

/// In the order of ImageUse.
constexpr UseInfo use_infos[] = {
    {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
     VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
     VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
    {depth_stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
     VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL},
    {depth_stages | shader_stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
     VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
    {shader_stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
     VK_IMAGE_LAYOUT_GENERAL},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL},
};

const UseInfo& info_of(ImageUse use) { return use_infos[static_cast<size_t>(use)]; }

struct MipRange {
  uint32_t first = 0, count = VK_REMAINING_MIP_LEVELS;
};

void transition(const GpuContext& context, VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                MipRange mips, ImageUse from, ImageUse to) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = info_of(from).stages;
  barrier.srcAccessMask = info_of(from).access;
  barrier.dstStageMask = info_of(to).stages;
  barrier.dstAccessMask = info_of(to).access;
  barrier.oldLayout = info_of(from).layout;
  barrier.newLayout = info_of(to).layout;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect, mips.first, mips.count, 0, 1};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  context.vk.vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

VkImageLayout layout_of(ImageUse use) { return info_of(use).layout; }

VkImageAspectFlags aspect_of(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Result<DeviceImage> DeviceImage::create(const GpuContext& context, const ImageDesc& desc) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = desc.mip_levels;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage;
  VmaAllocationCreateInfo allocation{};
  allocation.usage = VMA_MEMORY_USAGE_AUTO;
  DeviceImage image;
  image.allocator_ = context.allocator();
  image.desc_ = desc;
  const VkResult made =
      vmaCreateImage(image.allocator_, &info, &allocation, &image.image_, &image.allocation_, nullptr);
  if (made != VK_SUCCESS) {
    Error error = vulkan_error("vmaCreateImage", made);
    error.message +=
        std::string(": ") + desc.name + ", " + std::to_string(desc.width) + "x" + std::to_string(desc.height);
    return error;
  }
  VkImageViewCreateInfo view_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view_info.image = image.image_;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = desc.format;
  view_info.subresourceRange = {aspect_of(desc.format), 0, desc.mip_levels, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  if (const VkResult result = context.vk.vkCreateImageView(context.device(), &view_info, nullptr, &view);
      result != VK_SUCCESS) {
    return vulkan_error("vkCreateImageView", result);
  }
  image.view_ = {context.device(), view, context.vk.vkDestroyImageView};
  context.name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(image.image_), desc.name);
  return image;
}

DeviceImage::~DeviceImage() {
  view_ = {};
  if (image_ != VK_NULL_HANDLE) vmaDestroyImage(allocator_, image_, allocation_);
}

void DeviceImage::swap(DeviceImage& other) noexcept {
  std::swap(allocator_, other.allocator_);
  std::swap(allocation_, other.allocation_);
  std::swap(image_, other.image_);
  std::swap(view_, other.view_);
  std::swap(desc_, other.desc_);
  std::swap(current_, other.current_);
}

void DeviceImage::use(const GpuContext& context, VkCommandBuffer commands, ImageUse next) {
  transition(context, commands, image_, aspect_of(desc_.format), {}, current_, next);
  current_ = next;
}

void DeviceImage::make_mips(const GpuContext& context, VkCommandBuffer commands) {
  const auto side = [](uint32_t size, uint32_t level) { return static_cast<int32_t>(std::max(size >> level, 1u)); };
  for (uint32_t level = 1; level < desc_.mip_levels; ++level) {
    transition(context, commands, image_, VK_IMAGE_ASPECT_COLOR_BIT, {level - 1, 1}, ImageUse::transfer_target,
               ImageUse::transfer_source);
    VkImageBlit blit{};
    blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, 1};
    blit.srcOffsets[1] = {side(desc_.width, level - 1), side(desc_.height, level - 1), 1};
    blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
    blit.dstOffsets[1] = {side(desc_.width, level), side(desc_.height, level), 1};
    context.vk.vkCmdBlitImage(commands, image_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image_,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
    transition(context, commands, image_, VK_IMAGE_ASPECT_COLOR_BIT, {level - 1, 1}, ImageUse::transfer_source,
               ImageUse::sampled);
  }
  transition(context, commands, image_, VK_IMAGE_ASPECT_COLOR_BIT, {desc_.mip_levels - 1, 1}, ImageUse::transfer_target,
             ImageUse::sampled);
  current_ = ImageUse::sampled;
}

}  // namespace app
