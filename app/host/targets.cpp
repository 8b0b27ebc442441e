// Creates the images of a frame.
#include "host/targets.hpp"

#include <algorithm>

#include "host/pipelines.hpp"

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {

struct TargetInfo {
  const char* name;
  VkFormat format;
  VkImageUsageFlags usage;
};

constexpr VkImageUsageFlags drawn_and_sampled = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
constexpr VkImageUsageFlags stored_and_drawn =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

/// Signed 16-bit normals where the device draws into them; 32-bit floats are drawable everywhere.
VkFormat normal_format(const GpuContext& context) {
  const bool drawable = context.supports(VK_FORMAT_R16G16_SNORM, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT);
  return drawable ? VK_FORMAT_R16G16_SNORM : VK_FORMAT_R32G32_SFLOAT;
}

std::array<TargetInfo, target_count> target_infos(const GpuContext& context) {
  return {{
      {"depth", depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
      {"geometric normal", normal_format(context), drawn_and_sampled},
      {"surface", VK_FORMAT_R32G32B32A32_UINT, drawn_and_sampled},
      {"color", VK_FORMAT_R32G32B32A32_SFLOAT, stored_and_drawn},
      {"picture", VK_FORMAT_R8G8B8A8_UNORM, stored_and_drawn},
  }};
}

bool stored(Target target) { return target == Target::color || target == Target::picture; }

}  // namespace

Result<Targets> Targets::create(const GpuContext& context, uint32_t width, uint32_t height) {
  const uint32_t most = std::min({context.limits().maxImageDimension2D, context.limits().maxFramebufferWidth,
                                  context.limits().maxFramebufferHeight});
  if (width == 0 || height == 0 || width > most || height > most) {
    return Error{ErrorCode::invalid_argument, "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                                                  " pixels: this device takes 1 to " + std::to_string(most) +
                                                  " along a side"};
  }
  if (!context.supports(VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)) {
    return Error{ErrorCode::unsupported,
                 std::string(context.headless().name()) +
                     " cannot blend into 32-bit floats (R32G32B32A32_SFLOAT), which the sample host needs"};
  }
  Targets targets;
  targets.width_ = width;
  targets.height_ = height;
  const auto infos = target_infos(context);
  std::array<VkDescriptorSetLayoutBinding, target_count + 1> bindings;
  bindings[target_count] = {target_count, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                            nullptr};
  for (uint32_t i = 0; i < target_count; ++i) {
    auto image = DeviceImage::create(context, {infos[i].name, infos[i].format, width, height, 1, infos[i].usage});
    if (!image) return image.error();
    targets.images_[i] = std::move(image).value();
    const VkShaderStageFlags lines =
        Target{static_cast<uint8_t>(i)} == Target::depth ? VK_SHADER_STAGE_FRAGMENT_BIT : 0;
    bindings[i] = {
        i,
        stored(Target{static_cast<uint8_t>(i)}) ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
        1, VK_SHADER_STAGE_COMPUTE_BIT | lines, nullptr};
  }
  auto set = DescriptorSet::create(context, bindings);
  if (!set) return set.error();
  targets.set_ = std::move(set).value();
  for (uint32_t i = 0; i < target_count; ++i) {
    const Target target{static_cast<uint8_t>(i)};
    const ImageUse use = stored(target)            ? ImageUse::storage
                         : target == Target::depth ? ImageUse::depth_read
                                                   : ImageUse::sampled;
    targets.set_.write_image(context, i, 0, bindings[i].descriptorType,
                             {VK_NULL_HANDLE, targets.images_[i].view(), layout_of(use)});
  }
  return targets;
}

void Targets::set_reflection(const GpuContext& context, const VkDescriptorImageInfo& cube) {
  set_.write_image(context, target_count, 0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, cube);
}

VkRenderingAttachmentInfo attachment(const DeviceImage& image, ImageUse use, VkAttachmentLoadOp load,
                                     VkAttachmentStoreOp store) {
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = image.view();
  info.imageLayout = layout_of(use);
  info.loadOp = load;
  info.storeOp = store;
  return info;
}

void set_whole_viewport(const GpuContext& context, VkCommandBuffer commands, const Targets& targets) {
  const VkViewport viewport{0, 0, static_cast<float>(targets.width()), static_cast<float>(targets.height()), 0, 1};
  const VkRect2D area = targets.area();
  context.vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  context.vk.vkCmdSetScissor(commands, 0, 1, &area);
  context.vk.vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
  context.vk.vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
}

void begin_drawing_over(const GpuContext& context, VkCommandBuffer commands, Targets& targets, Target target) {
  targets[target].use(context, commands, ImageUse::color_target);
  const VkRenderingAttachmentInfo color =
      attachment(targets[target], ImageUse::color_target, VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
  const VkRenderingAttachmentInfo depth =
      attachment(targets[Target::depth], ImageUse::depth_read, VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_NONE);
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea = targets.area();
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &color;
  rendering.pDepthAttachment = &depth;
  context.vk.vkCmdBeginRendering(commands, &rendering);
  set_whole_viewport(context, commands, targets);
}

}  // namespace app
