// Plain Vulkan through the host's context.
#include "host/layer_images.hpp"

#include <vk_mem_alloc.h>

#include <cstring>

namespace app {

using umbrage::Result;

namespace {

void transition(const GpuContext& context, VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  context.vk.vkCmdPipelineBarrier2(commands, &info);
}

uint32_t bytes_of(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D16_UNORM:
      return 2;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return 8;
    default:
      return 4;
  }
}

}  // namespace

Result<LayerImages::One> LayerImages::make(VkFormat format, VkImageUsageFlags usage) const {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.flags = desc_.is_cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {desc_.width, desc_.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = desc_.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VmaAllocationCreateInfo allocation{};
  allocation.usage = VMA_MEMORY_USAGE_AUTO;
  One made;
  const VkResult result = vmaCreateImage(allocator_, &info, &allocation, &made.image, &made.allocation, nullptr);
  if (result == VK_SUCCESS) return made;
  umbrage::Error error = vulkan_error("vmaCreateImage", result);
  error.message += ": " + std::to_string(desc_.layers) + " layers of " + std::to_string(desc_.width) + "x" +
                   std::to_string(desc_.height);
  return error;
}

Result<LayerImages> LayerImages::create(GpuContext& context, const LayerImagesDesc& desc) {
  LayerImages images;
  images.allocator_ = context.allocator();
  images.desc_ = desc;
  auto depth = images.make(desc.depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  if (!depth) return depth.error();
  images.depth_ = *depth;
  if (desc.color_format != VK_FORMAT_UNDEFINED) {
    auto color = images.make(desc.color_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    if (!color) return color.error();
    images.color_ = *color;
  }
  auto commands = context.begin();
  if (!commands) return commands.error();
  images.begin_drawing(context, *commands);
  if (auto done = context.submit_and_wait(); !done) return done.error();
  return images;
}

LayerImages::LayerImages(LayerImages&& other) noexcept
    : allocator_(other.allocator_),
      desc_(other.desc_),
      depth_(std::exchange(other.depth_, {})),
      color_(std::exchange(other.color_, {})) {}

LayerImages::~LayerImages() {
  if (color_.image) vmaDestroyImage(allocator_, color_.image, color_.allocation);
  if (depth_.image) vmaDestroyImage(allocator_, depth_.image, depth_.allocation);
}

umbrage::LayeredTargetDesc LayerImages::target() const {
  return {.depth = depth_.image,
          .depth_format = desc_.depth_format,
          .color = color_.image,
          .color_format = desc_.color_format,
          .width = desc_.width,
          .height = desc_.height,
          .layers = desc_.layers};
}

void LayerImages::begin_drawing(const GpuContext& context, VkCommandBuffer commands) const {
  transition(context, commands, depth_.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  if (color_.image)
    transition(context, commands, color_.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

void LayerImages::end_drawing(const GpuContext& context, VkCommandBuffer commands) const {
  transition(context, commands, depth_.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
             VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
  if (color_.image)
    transition(context, commands, color_.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

Result<Handle<VkImageView>> LayerImages::view(const GpuContext& context, VkImageViewType type,
                                              VkImageAspectFlags aspect) const {
  return make_view(context, type, aspect, 0, desc_.layers);
}

Result<Handle<VkImageView>> LayerImages::layer_view(const GpuContext& context, uint32_t layer,
                                                    VkImageAspectFlags aspect) const {
  return make_view(context, VK_IMAGE_VIEW_TYPE_2D, aspect, layer, 1);
}

Result<Handle<VkImageView>> LayerImages::make_view(const GpuContext& context, VkImageViewType type,
                                                   VkImageAspectFlags aspect, uint32_t first, uint32_t count) const {
  const bool is_depth = aspect == VK_IMAGE_ASPECT_DEPTH_BIT;
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = is_depth ? depth_.image : color_.image;
  info.viewType = type;
  info.format = is_depth ? desc_.depth_format : desc_.color_format;
  info.subresourceRange = {aspect, 0, 1, first, count};
  VkImageView made = VK_NULL_HANDLE;
  const VkResult result = context.vk.vkCreateImageView(context.device(), &info, nullptr, &made);
  if (result != VK_SUCCESS) return vulkan_error("vkCreateImageView", result);
  return Handle<VkImageView>(context.device(), made, context.vk.vkDestroyImageView);
}

Result<std::vector<std::byte>> LayerImages::read(GpuContext& context, VkImage image, VkImageAspectFlags aspect,
                                                 VkImageLayout layout, uint32_t texel_bytes) {
  const VkDeviceSize bytes = VkDeviceSize(desc_.width) * desc_.height * desc_.layers * texel_bytes;
  auto buffer = context.create_buffer(bytes, Memory::read_back, "layers");
  if (!buffer) return buffer.error();
  auto commands = context.begin();
  if (!commands) return commands.error();
  transition(context, *commands, image, aspect, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  VkBufferImageCopy region{};
  region.imageSubresource = {aspect, 0, 0, desc_.layers};
  region.imageExtent = {desc_.width, desc_.height, 1};
  context.vk.vkCmdCopyImageToBuffer(*commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer->get(), 1, &region);
  transition(context, *commands, image, aspect, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
  memory_barrier(context, *commands, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT}, host_read);
  if (auto done = context.submit_and_wait(); !done) return done.error();
  return std::vector<std::byte>(buffer->mapped(), buffer->mapped() + bytes);
}

Result<std::vector<float>> LayerImages::read_depth(GpuContext& context) {
  const uint32_t texel_bytes = bytes_of(desc_.depth_format);
  auto bytes =
      read(context, depth_.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, texel_bytes);
  if (!bytes) return bytes.error();
  std::vector<float> depths(bytes->size() / texel_bytes);
  if (texel_bytes == 4) {
    std::memcpy(depths.data(), bytes->data(), bytes->size());
    return depths;
  }
  for (size_t i = 0; i < depths.size(); ++i) {
    uint16_t value;
    std::memcpy(&value, bytes->data() + 2 * i, sizeof value);
    depths[i] = static_cast<float>(value) / 65535.0f;
  }
  return depths;
}

Result<std::vector<std::byte>> LayerImages::read_color(GpuContext& context) {
  return read(context, color_.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
              bytes_of(desc_.color_format));
}

}  // namespace app
