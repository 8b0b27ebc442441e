// Read-back through mapped buffers.
#include "host/read_back.hpp"

#include <algorithm>
#include <bit>

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {
constexpr uint32_t read_surface[] =
#include "shaders/read_surface.comp.inc"
    ;
constexpr uint32_t read_visibility[] =
#include "shaders/read_visibility.comp.inc"
    ;
constexpr uint32_t tile = 8;
constexpr uint32_t group_size = 64;
constexpr VkDeviceSize visibility_chunk_bytes = VkDeviceSize{32} << 20;

constexpr VkDeviceSize looked_up_offset = 64;  // the bits; the count of triangles comes first

/// Bytes of one light in the shader's output: whole words.
VkDeviceSize padded(uint32_t pixels) { return (VkDeviceSize{pixels} + 3) / 4 * 4; }
}  // namespace

Result<ReadBack> ReadBack::create(const GpuContext& context, VkPipelineLayout layout) {
  ReadBack made;
  auto surface = create_compute_pipeline(context, layout, read_surface, "read surface");
  if (!surface) return surface.error();
  made.surface_ = std::move(surface).value();
  auto visibility = create_compute_pipeline(context, layout, read_visibility, "read visibility");
  if (!visibility) return visibility.error();
  made.visibility_ = std::move(visibility).value();
  return made;
}

uint32_t ReadBack::max_visibility_lights(uint32_t pixels) {
  return static_cast<uint32_t>(std::max<VkDeviceSize>(visibility_chunk_bytes / padded(pixels), 1));
}

Result<void> ReadBack::reserve(const GpuContext& context, DeviceBuffer& buffer, VkDeviceSize bytes) {
  if (buffer.size() >= bytes) return {};
  auto made = context.create_buffer(bytes, Memory::read_back, "read back");
  if (!made) return made.error();
  buffer = std::move(made).value();
  return {};
}

Result<const std::byte*> ReadBack::copy_image(GpuContext& context, PassContext& pass, Target target,
                                              VkDeviceSize bytes) {
  if (auto reserved = reserve(context, buffer_, bytes); !reserved) return reserved.error();
  DeviceImage& image = pass.targets[target];
  image.use(context, pass.commands, ImageUse::transfer_source);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {pass.targets.width(), pass.targets.height(), 1};
  context.vk.vkCmdCopyImageToBuffer(pass.commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer_.get(), 1,
                                    &region);
  memory_barrier(context, pass.commands, transfer_write, host_read);
  image.use(context, pass.commands, ImageUse::storage);
  if (auto done = context.submit_and_wait(); !done) return done.error();
  return buffer_.mapped();
}

Result<std::vector<uint8_t>> ReadBack::picture(GpuContext& context, PassContext& pass) {
  std::vector<uint8_t> pixels(size_t{4} * pass.targets.pixels());
  auto bytes = copy_image(context, pass, Target::picture, pixels.size());
  if (!bytes) return bytes.error();
  std::memcpy(pixels.data(), *bytes, pixels.size());
  return pixels;
}

Result<std::vector<float>> ReadBack::color(GpuContext& context, PassContext& pass) {
  const size_t count = pass.targets.pixels();
  auto bytes = copy_image(context, pass, Target::color, count * 4 * sizeof(float));
  if (!bytes) return bytes.error();
  std::vector<float> color(3 * count);
  for (size_t i = 0; i < count; ++i) std::memcpy(&color[3 * i], *bytes + i * 4 * sizeof(float), 3 * sizeof(float));
  return color;
}

Result<std::vector<float>> ReadBack::surface(GpuContext& context, PassContext& pass, SurfaceArray array) {
  std::vector<float> values(size_t{3} * pass.targets.pixels());
  if (auto reserved = reserve(context, buffer_, values.size() * sizeof(float)); !reserved) return reserved.error();
  pass.push.output_buffer = buffer_.address();
  pass.push.first = array == SurfaceArray::position ? 0 : 1;
  context.vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_COMPUTE, surface_.get());
  push_constants(context, pass.commands, pass.layout, pass.push);
  context.vk.vkCmdDispatch(pass.commands, groups(pass.targets.width(), tile), groups(pass.targets.height(), tile), 1);
  memory_barrier(context, pass.commands, compute_write, host_read);
  if (auto done = context.submit_and_wait(); !done) return done.error();
  std::memcpy(values.data(), buffer_.mapped(), values.size() * sizeof(float));
  return values;
}

Result<void> ReadBack::visibility(GpuContext& context, PassContext& pass, uint32_t first, uint32_t count,
                                  std::span<uint8_t> visibility, std::span<uint8_t> band_px) {
  const uint32_t pixels = pass.targets.pixels();
  const VkDeviceSize light_bytes = padded(pixels);
  if (auto reserved = reserve(context, buffer_, count * light_bytes); !reserved) return reserved.error();
  if (!band_px.empty()) {
    if (auto reserved = reserve(context, band_buffer_, count * light_bytes); !reserved) return reserved.error();
  }
  pass.push.output_buffer = buffer_.address();
  pass.push.output_band = band_px.empty() ? 0 : band_buffer_.address();
  pass.push.first = first;
  pass.push.count = count;
  pass.push.looked_up = looked_up_.size() > 0 ? looked_up_.address() + looked_up_offset : 0;
  context.vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_COMPUTE, visibility_.get());
  push_constants(context, pass.commands, pass.layout, pass.push);
  dispatch_items(context, pass.commands, groups(pixels, 4), group_size);
  memory_barrier(context, pass.commands, compute_write, host_read);
  if (auto done = context.submit_and_wait(); !done) return done.error();
  for (size_t light = 0; light < count; ++light) {
    std::memcpy(visibility.data() + light * pixels, buffer_.mapped() + light * light_bytes, pixels);
    if (!band_px.empty())
      std::memcpy(band_px.data() + light * pixels, band_buffer_.mapped() + light * light_bytes, pixels);
  }
  return {};
}

Result<void> ReadBack::mark_lookups(const GpuContext& context, VkDeviceSize pool_bytes) {
  const VkDeviceSize bytes = looked_up_offset + pool_bytes / sizeof(uint32_t) / 8;
  if (auto reserved = reserve(context, looked_up_, bytes); !reserved) return reserved;
  std::memset(looked_up_.mapped(), 0, bytes);
  return {};
}

Result<NeededWork> ReadBack::needed(GpuContext& context, PassContext& pass, umbrage::NeededTriangles& triangles) {
  memory_barrier(context, pass.commands, compute_write, compute_access);
  if (auto recorded = triangles.record(pass.commands, looked_up_.address() + looked_up_offset, looked_up_.address());
      !recorded)
    return recorded.error();
  memory_barrier(context, pass.commands, compute_write, host_read);
  if (auto done = context.submit_and_wait(); !done) return done.error();
  NeededWork needed;
  uint32_t count = 0;
  std::memcpy(&count, looked_up_.mapped(), sizeof(count));
  needed.triangles = count;
  for (VkDeviceSize at = looked_up_offset; at + sizeof(uint64_t) <= looked_up_.size(); at += sizeof(uint64_t)) {
    uint64_t bits = 0;
    std::memcpy(&bits, looked_up_.mapped() + at, sizeof(bits));
    needed.texels += static_cast<uint64_t>(std::popcount(bits));
  }
  return needed;
}

}  // namespace app
