// Memory of a fixed number of pages, and the binds that follow what frames ask for.
#include "store/sparse_images.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace umbrage::store {

namespace {
constexpr uint32_t kListBlocks[] =
#include "shaders/list_blocks.comp.inc"
    ;
constexpr uint32_t kSlotsPerBlock = 1024;  // 64 MiB

/// Reads the host's copy.
std::span<const shared::SparsePage> read(const gpu::Buffer& requests) {
  shared::SparseRequests header;
  std::memcpy(&header, requests.mapped(), sizeof header);
  return {reinterpret_cast<const shared::SparsePage*>(requests.mapped() + sizeof header), header.count};
}
}  // namespace

Result<SparseImages> SparseImages::create(const gpu::Device& device, const gpu::PipelineFactory& factory,
                                          const SparseForm& form) {
  SparseImages out;
  out.device_ = &device;
  out.form_ = form;
  auto list = factory.compute(kListBlocks, "list blocks");
  if (!list) return list.error();
  out.list_ = std::move(*list);
  const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  const VkResult result = device.vk().vkCreateFence(device.handle(), &info, device.callbacks(), &out.fence_);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateFence", "page binding");
  return out;
}

SparseImages::SparseImages(SparseImages&& other) noexcept { *this = std::move(other); }
SparseImages& SparseImages::operator=(SparseImages&& other) noexcept {
  std::swap(device_, other.device_), std::swap(form_, other.form_), std::swap(layout_, other.layout_);
  std::swap(images_, other.images_), std::swap(list_, other.list_), std::swap(residency_, other.residency_);
  std::swap(memory_, other.memory_), std::swap(metadata_, other.metadata_),
      std::swap(metadata_binds_, other.metadata_binds_);
  std::swap(binds_, other.binds_), std::swap(fence_, other.fence_);
  return *this;
}
SparseImages::~SparseImages() {
  if (fence_) device_->vk().vkDestroyFence(device_->handle(), fence_, device_->callbacks());
}

Result<void> SparseImages::reserve(const gpu::Device& device, gpu::Memory& memory, const SparseLayout& layout,
                                   gpu::RetireQueue& retired, uint64_t serial) {
  if (same_images(layout.images, images_.layout()) && layout.pages == layout_.pages) return {};
  const gpu::ImageDesc like{.format = form_.format(), .usage = form_.usage(), .sparse = form_.is_sparse};
  if (auto ok = images_.reserve(device, memory, layout.images, like, retired, serial); !ok) return ok.error();
  for (std::vector<gpu::Allocation>* all : {&memory_, &metadata_}) {
    for (gpu::Allocation& one : *all) retired.retire(std::move(one), serial);
    all->clear();
  }
  metadata_binds_.clear();
  layout_ = {};  // until everything is there
  if (auto ok = reserve_pages(memory, layout.pages); !ok) return ok.error();
  if (auto ok = reserve_metadata(memory); !ok) return ok.error();
  residency_.reset(layout.pages);
  layout_ = layout;
  return {};
}

Result<void> SparseImages::reserve_pages(gpu::Memory& memory, uint32_t pages) {
  uint32_t types = UINT32_MAX;
  for (const gpu::Image& image : images_.images()) {
    if (!image.is_sparse()) continue;
    VkMemoryRequirements needs;
    device_->vk().vkGetImageMemoryRequirements(device_->handle(), image.handle(), &needs);
    types &= needs.memoryTypeBits;
    if (kSparsePageBytes % needs.alignment != 0)
      return Error{ErrorCode::unsupported, "store=hardware_sparse needs pages of 64 KiB; " + device_->name() +
                                               " has pages of " + std::to_string(needs.alignment) + " bytes"};
  }
  for (uint32_t first = 0; form_.is_sparse && first < pages; first += kSlotsPerBlock) {
    const VkDeviceSize bytes = std::min(kSlotsPerBlock, pages - first) * kSparsePageBytes;
    auto made = memory.allocate({bytes, kSparsePageBytes, types}, gpu::MemoryKind::device, "sparse pages", true);
    if (!made) return made.error();
    memory_.push_back(std::move(*made));
  }
  return {};
}

Result<void> SparseImages::reserve_metadata(gpu::Memory& memory) {
  const gpu::Functions& vk = device_->vk();
  for (const gpu::Image& image : images_.images()) {
    if (!image.is_sparse()) continue;
    uint32_t count = 0;
    vk.vkGetImageSparseMemoryRequirements(device_->handle(), image.handle(), &count, nullptr);
    std::vector<VkSparseImageMemoryRequirements> all(count);
    vk.vkGetImageSparseMemoryRequirements(device_->handle(), image.handle(), &count, all.data());
    VkMemoryRequirements needs;
    vk.vkGetImageMemoryRequirements(device_->handle(), image.handle(), &needs);
    for (const VkSparseImageMemoryRequirements& part : all) {
      if ((part.formatProperties.aspectMask & VK_IMAGE_ASPECT_METADATA_BIT) == 0) continue;
      const bool once = (part.formatProperties.flags & VK_SPARSE_IMAGE_FORMAT_SINGLE_MIPTAIL_BIT) != 0;
      for (uint32_t layer = 0; layer < (once ? 1 : image.layers()); ++layer) {
        needs.size = part.imageMipTailSize;
        auto made = memory.allocate(needs, gpu::MemoryKind::device, "metadata of sparse images", true);
        if (!made) return made.error();
        metadata_binds_.push_back({image.handle(),
                                   {.resourceOffset = part.imageMipTailOffset + layer * part.imageMipTailStride,
                                    .size = part.imageMipTailSize,
                                    .memory = made->memory,
                                    .memoryOffset = made->offset,
                                    .flags = VK_SPARSE_MEMORY_BIND_METADATA_BIT}});
        metadata_.push_back(std::move(*made));
      }
    }
  }
  return {};
}

void SparseImages::record_requests(gpu::Recorder& recorder, const maps::Maps& maps, const gpu::Buffer& frame,
                                   const gpu::Buffer& counters, const gpu::Buffer& target) const {
  gpu::Scope scope(recorder, "list pages");
  {
    gpu::Pass pass = recorder.pass("list pages");
    shared::MapsPush push{.frame = pass.read(frame),
                          .counters = pass.write(counters),
                          .requests = pass.write(target) + sizeof(shared::SparseRequests),
                          .flags = shared::MapsSparse,
                          .backing = form_.page.x | form_.page.y << 16};
    pass.read(maps.maps()), pass.read(maps.page_bits()), pass.read(counters, gpu::Access::indirect_read);
    pass.dispatch_indirect(list_, push, counters, offsetof(shared::FrameCounters, map_groups));
  }
  {
    gpu::Pass pass = recorder.pass("number of pages");
    pass.read(counters, gpu::Access::transfer_read), pass.write(target, gpu::Access::transfer_write);
    const VkBufferCopy count{offsetof(shared::FrameCounters, pages_listed), offsetof(shared::SparseRequests, count),
                             sizeof(uint32_t)};
    recorder.device().vk().vkCmdCopyBuffer(pass.commands(), counters.handle(), target.handle(), 1, &count);
  }
  gpu::Pass pass = recorder.pass("pages to host");
  pass.read(target, gpu::Access::host_read);
  pass.commands();
}

VkSparseImageMemoryBind SparseImages::image_bind(const BoundPage& bound, bool has_memory) const {
  const uint32_t image = bound.page.image_layer >> 16, layer = bound.page.image_layer & 0xffff;
  const uint32_t x = bound.page.place & 0xffff, y = bound.page.place >> 16;
  VkSparseImageMemoryBind out{};
  out.subresource = {images_.images()[image].aspect(), 0, layer};
  out.offset = {static_cast<int32_t>(x * form_.page.x), static_cast<int32_t>(y * form_.page.y), 0};
  out.extent = {form_.page.x, form_.page.y, 1};
  if (!has_memory) return out;
  const gpu::Allocation& memory = memory_[bound.slot / kSlotsPerBlock];
  out.memory = memory.memory;
  out.memoryOffset = memory.offset + bound.slot % kSlotsPerBlock * kSparsePageBytes;
  return out;
}

Result<SparseImages::Bound> SparseImages::bind(VkQueue queue, const gpu::Buffer& requests, VkSemaphore done) {
  const std::span<const shared::SparsePage> pages = read(requests);
  if (pages.size() > residency_.slots())
    return Error{ErrorCode::vulkan, "bind_pages: " + std::to_string(pages.size()) + " pages asked for of " +
                                        std::to_string(residency_.slots()) + "; has the submission finished?"};
  residency_.plan(pages);
  Bound report{.bytes_read = sizeof(shared::SparseRequests) + pages.size_bytes(),
               .bound = static_cast<uint32_t>(residency_.to_bind().size()),
               .unbound = static_cast<uint32_t>(residency_.to_unbind().size())};
  if (form_.is_sparse)
    if (auto ok = submit(queue, done); !ok) return ok.error();
  residency_.commit();
  metadata_binds_.clear();
  return report;
}

Result<void> SparseImages::submit(VkQueue queue, VkSemaphore done) {
  // Image by image: both lists are in that order.
  binds_.clear();
  binds_.reserve(residency_.to_bind().size() + residency_.to_unbind().size());
  std::vector<VkSparseImageMemoryBindInfo> images;
  auto unbind = residency_.to_unbind().begin(), bind = residency_.to_bind().begin();
  for (uint32_t i = 0; i < images_.images().size(); ++i) {
    const size_t first = binds_.size();
    for (; unbind != residency_.to_unbind().end() && unbind->page.image_layer >> 16 == i; ++unbind)
      binds_.push_back(image_bind(*unbind, false));
    for (; bind != residency_.to_bind().end() && bind->page.image_layer >> 16 == i; ++bind)
      binds_.push_back(image_bind(*bind, true));
    if (binds_.size() > first)
      images.push_back(
          {images_.images()[i].handle(), static_cast<uint32_t>(binds_.size() - first), binds_.data() + first});
  }
  std::vector<VkSparseImageOpaqueMemoryBindInfo> metadata;
  for (const auto& [image, bind_info] : metadata_binds_) metadata.push_back({image, 1, &bind_info});
  if (images.empty() && metadata.empty() && !done) return {};
  VkBindSparseInfo info{VK_STRUCTURE_TYPE_BIND_SPARSE_INFO};
  info.imageOpaqueBindCount = static_cast<uint32_t>(metadata.size());
  info.pImageOpaqueBinds = metadata.data();
  info.imageBindCount = static_cast<uint32_t>(images.size());
  info.pImageBinds = images.data();
  info.signalSemaphoreCount = done ? 1 : 0;
  info.pSignalSemaphores = &done;
  const gpu::Functions& vk = device_->vk();
  VkResult result = vk.vkQueueBindSparse(queue, 1, &info, done ? VK_NULL_HANDLE : fence_);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkQueueBindSparse", "");
  if (done) return {};
  result = vk.vkWaitForFences(device_->handle(), 1, &fence_, VK_TRUE, UINT64_MAX);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkWaitForFences", "page binding");
  result = vk.vkResetFences(device_->handle(), 1, &fence_);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkResetFences", "page binding");
  return {};
}

}  // namespace umbrage::store
