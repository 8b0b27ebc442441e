// Texture upload.
#include "host/textures.hpp"

#include <algorithm>
#include <bit>

#include "host/shaders/host.shared.h"

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {

VkSamplerAddressMode address_mode(Wrap wrap) {
  switch (wrap) {
    case Wrap::clamp:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case Wrap::mirror:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}

Result<void> check_image(const GpuContext& context, const Image& image) {
  const uint32_t most = context.limits().maxImageDimension2D;
  const std::string size = std::to_string(image.width) + "x" + std::to_string(image.height);
  if (image.width == 0 || image.height == 0 || image.rgba.size() != size_t{4} * image.width * image.height) {
    return Error{ErrorCode::invalid_argument, "image \"" + image.name + "\" holds no " + size + " RGBA pixels"};
  }
  if (image.width > most || image.height > most) {
    return Error{ErrorCode::unsupported, "image \"" + image.name + "\" has " + size + " pixels: the device takes " +
                                             std::to_string(most) + " along a side, scale it down"};
  }
  return {};
}

}  // namespace

TextureTable::SlotKey TextureTable::key_of(const Texture& texture, ColorSpace space) {
  return {texture.image, space, {texture.wrap_u, texture.wrap_v, texture.nearest}};
}

uint32_t TextureTable::slot(const Texture& texture, ColorSpace space) const {
  return texture.image < 0 ? gpu::NoTexture : slot_of_.at(key_of(texture, space));
}

Result<TextureTable> TextureTable::create(GpuContext& context, const Scene& scene) {
  TextureTable table;
  for (const Material& material : scene.materials) {
    const std::pair<const Texture*, ColorSpace> uses[] = {
        {&material.base_color_texture, ColorSpace::srgb},
        {&material.emissive_texture, ColorSpace::srgb},
        {&material.metallic_roughness_texture, ColorSpace::linear},
        {&material.normal_texture, ColorSpace::linear},
    };
    for (const auto& [texture, space] : uses) {
      if (auto added = table.add(context, scene, *texture, space); !added) return added.error();
    }
  }
  if (auto made = table.create_set(context); !made) return made.error();
  return table;
}

Result<void> TextureTable::add(GpuContext& context, const Scene& scene, const Texture& texture, ColorSpace space) {
  const SlotKey key = key_of(texture, space);
  if (texture.image < 0 || slot_of_.contains(key)) return {};
  if (static_cast<size_t>(texture.image) >= scene.images.size()) {
    return Error{ErrorCode::invalid_argument, "a material names image " + std::to_string(texture.image) + " of " +
                                                  std::to_string(scene.images.size())};
  }
  Slot slot;
  if (const auto found = image_of_.find({texture.image, space}); found != image_of_.end()) {
    slot.image = found->second;
  } else {
    auto image = add_image(context, scene.images[static_cast<size_t>(texture.image)], space);
    if (!image) return image.error();
    slot.image = *image;
    image_of_[{texture.image, space}] = slot.image;
  }
  auto sampler = add_sampler(context, std::get<SamplerKey>(key));
  if (!sampler) return sampler.error();
  slot.sampler = *sampler;
  slot_of_[key] = static_cast<uint32_t>(slots_.size());
  slots_.push_back(slot);
  return {};
}

Result<size_t> TextureTable::add_image(GpuContext& context, const Image& image, ColorSpace space) {
  if (auto good = check_image(context, image); !good) return good.error();
  ImageDesc desc;
  desc.name = image.name.c_str();
  desc.format = space == ColorSpace::srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  desc.width = image.width;
  desc.height = image.height;
  desc.mip_levels = static_cast<uint32_t>(std::bit_width(std::max(image.width, image.height)));
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  auto made = DeviceImage::create(context, desc);
  if (!made) return made.error();
  auto staging = context.create_buffer(image.rgba.size(), Memory::upload, "texture staging");
  if (!staging) return staging.error();
  staging->write(std::span<const uint8_t>(image.rgba));

  auto commands = context.begin();
  if (!commands) return commands.error();
  made->use(context, *commands, ImageUse::transfer_target);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {image.width, image.height, 1};
  context.vk.vkCmdCopyBufferToImage(*commands, staging->get(), made->get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                    &region);
  made->make_mips(context, *commands);
  if (auto done = context.submit_and_wait(); !done) return done.error();
  images_.push_back(std::move(made).value());
  return images_.size() - 1;
}

Result<size_t> TextureTable::add_sampler(const GpuContext& context, SamplerKey key) {
  if (const auto found = sampler_of_.find(key); found != sampler_of_.end()) return found->second;
  const auto [wrap_u, wrap_v, nearest] = key;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  info.minFilter = info.magFilter;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.addressModeU = address_mode(wrap_u);
  info.addressModeV = address_mode(wrap_v);
  info.maxLod = VK_LOD_CLAMP_NONE;
  VkSampler sampler = VK_NULL_HANDLE;
  if (const VkResult result = context.vk.vkCreateSampler(context.device(), &info, nullptr, &sampler);
      result != VK_SUCCESS) {
    return vulkan_error("vkCreateSampler", result);
  }
  samplers_.emplace_back(context.device(), sampler, context.vk.vkDestroySampler);
  sampler_of_[key] = samplers_.size() - 1;
  return samplers_.size() - 1;
}

Result<void> TextureTable::create_set(const GpuContext& context) {
  const uint32_t count = std::max(static_cast<uint32_t>(slots_.size()), 1u);
  const VkPhysicalDeviceLimits& limits = context.limits();
  const uint32_t most = std::min(limits.maxPerStageDescriptorSamplers, limits.maxPerStageDescriptorSampledImages);
  if (count > most) {
    return Error{ErrorCode::unsupported,
                 "the scene uses " + std::to_string(count) + " textures: the device takes " + std::to_string(most)};
  }
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count,
                                             VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
  auto made = DescriptorSet::create(context, {&binding, 1});
  if (!made) return made.error();
  set_ = std::move(made).value();
  for (uint32_t i = 0; i < slots_.size(); ++i) {
    set_.write_image(context, 0, i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                     {sampler(i), view(i), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  }
  return {};
}

}  // namespace app
