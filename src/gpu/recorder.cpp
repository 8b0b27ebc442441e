// One table from access to stage, access mask and layout; barriers are what the last accesses of a resource leave open.
#include "gpu/recorder.hpp"

#include <cassert>

namespace umbrage::gpu {

namespace {
struct AccessInfo {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
  bool writes;
};

AccessInfo info_of(Access access) {
  switch (access) {
    case Access::compute_read: return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, false};
    case Access::compute_write: return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL, true};
    case Access::vertex_read: return {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_GENERAL, false};
    case Access::fragment_read: return {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, false};
    case Access::indirect_read: return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, false};
    case Access::index_read: return {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, false};
    case Access::transfer_read: return {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false};
    case Access::transfer_write: return {VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, true};
    case Access::depth_attachment:
      return {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
              VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
              VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, true};
    case Access::host_read: return {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, false};
  }
  return {};
}

struct Barrier {
  VkPipelineStageFlags2 src_stages = 0;
  VkAccessFlags2 src_access = 0;
  bool needed = false;
};

/// What must be waited for before `now`, and the state after it.
Barrier advance(SyncState& state, const AccessInfo& now) {
  Barrier barrier;
  if (now.writes) {
    barrier.src_stages = state.write_stages | state.read_stages;
    barrier.src_access = state.write_access;
    barrier.needed = barrier.src_stages != 0;
    state.write_stages = now.stages, state.write_access = now.access;
    state.read_stages = 0, state.visible_stages = 0, state.visible_access = 0;
    return barrier;
  }
  const bool visible = (state.visible_stages & now.stages) == now.stages && (state.visible_access & now.access) == now.access;
  if (state.write_stages && !visible) {
    barrier = {state.write_stages, state.write_access, true};
    // Visibility is a set of (stage, access) pairs; keeping their product would claim pairs that no barrier made.
    state.visible_stages = now.stages, state.visible_access = now.access;
  }
  state.read_stages |= now.stages;
  return barrier;
}
}  // namespace

VkDeviceAddress Pass::read(const Buffer& buffer, Access access) {
  declare(buffer.sync, &buffer.sync, buffer.name(), buffer.handle(), nullptr, access);
  return buffer.address();
}
VkDeviceAddress Pass::write(const Buffer& buffer, Access access) {
  declare(buffer.sync, &buffer.sync, buffer.name(), buffer.handle(), nullptr, access);
  return buffer.address();
}
void Pass::image(const DepthImage& image, Access access) {
  declare(image.sync, &image.sync, image.name(), VK_NULL_HANDLE, &image, access);
}

void Pass::declare(SyncState& state, const void* identity, const char* name, VkBuffer buffer, const DepthImage* image, Access access) {
  const AccessInfo now = info_of(access);
  const VkImageLayout old_layout = state.layout;
  Barrier barrier = advance(state, now);
  if (image && old_layout != now.layout) {
    barrier.needed = true;
    state.layout = now.layout;
    if (!now.writes) {  // a transition writes: later accesses wait for it as for the write before it
      if (!barrier.src_stages) barrier.src_stages = state.write_stages | state.read_stages, barrier.src_access = state.write_access;
      state.write_stages = now.stages, state.write_access = 0;
      state.visible_stages = now.stages, state.visible_access = now.access;
    }
  }
  HazardLog* log = recorder_.log_;
  if (barrier.needed) {
    if (image) {
      assert(image_count_ < images_.size());
      VkImageMemoryBarrier2& out = images_[image_count_++];
      out = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
      out.srcStageMask = barrier.src_stages, out.srcAccessMask = barrier.src_access;
      out.dstStageMask = now.stages, out.dstAccessMask = now.access;
      out.oldLayout = old_layout, out.newLayout = now.layout;
      out.srcQueueFamilyIndex = out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      out.image = image->handle();
      out.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    } else {
      assert(buffer_count_ < buffers_.size());
      VkBufferMemoryBarrier2& out = buffers_[buffer_count_++];
      out = {VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2};
      out.srcStageMask = barrier.src_stages, out.srcAccessMask = barrier.src_access;
      out.dstStageMask = now.stages, out.dstAccessMask = now.access;
      out.srcQueueFamilyIndex = out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      out.buffer = buffer;
      out.size = VK_WHOLE_SIZE;
    }
    if (log)
      log->push_back({.kind = HazardEvent::Kind::barrier, .resource = identity, .resource_name = name, .pass = name_,
                      .stages = barrier.src_stages, .dst_stages = now.stages, .access = barrier.src_access, .dst_access = now.access});
  }
  if (log)
    log->push_back({.kind = HazardEvent::Kind::access, .resource = identity, .resource_name = name, .pass = name_,
                    .writes = now.writes, .stages = now.stages, .access = now.access});
}

void Pass::flush() {
  if (buffer_count_ + image_count_ == 0) return;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.bufferMemoryBarrierCount = buffer_count_;
  info.pBufferMemoryBarriers = buffers_.data();
  info.imageMemoryBarrierCount = image_count_;
  info.pImageMemoryBarriers = images_.data();
  recorder_.device_.vk().vkCmdPipelineBarrier2(recorder_.commands_, &info);
  buffer_count_ = image_count_ = 0;
}

VkCommandBuffer Pass::commands() {
  flush();
  return recorder_.commands_;
}

void Pass::bind(const Pipeline& pipeline, const void* push, size_t size) {
  assert(size <= kPushBytes && size % 4 == 0);
  flush();
  const Functions& vk = recorder_.device_.vk();
  const VkPipelineBindPoint point = pipeline.bind_point();
  bool& bound = recorder_.sets_bound_[point == VK_PIPELINE_BIND_POINT_GRAPHICS];
  if (!bound) {
    bound = true;
    vk.vkCmdBindDescriptorSets(recorder_.commands_, point, recorder_.factory_.layout(), 0,
                               static_cast<uint32_t>(recorder_.sets_.size()), recorder_.sets_.data(), 0, nullptr);
  }
  vk.vkCmdBindPipeline(recorder_.commands_, point, pipeline.handle());
  vk.vkCmdPushConstants(recorder_.commands_, recorder_.factory_.layout(),
                        VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        static_cast<uint32_t>(size), push);
}

void Pass::dispatch_bound(uint32_t x, uint32_t y, uint32_t z) {
  recorder_.device_.vk().vkCmdDispatch(recorder_.commands_, x, y, z);
}

void Pass::dispatch_indirect_bound(const Buffer& arguments, VkDeviceSize offset) {
  recorder_.device_.vk().vkCmdDispatchIndirect(recorder_.commands_, arguments.handle(), offset);
}

void Recorder::publish(std::span<const Buffer* const> buffers, VkPipelineStageFlags2 stages, const DepthImage* image) {
  std::array<VkBufferMemoryBarrier2, 24> barriers{};
  uint32_t count = 0;
  VkImageMemoryBarrier2 image_barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  const auto note = [&](const SyncState& state, const char* name) {
    if (!log_) return;
    log_->push_back({.kind = HazardEvent::Kind::barrier, .resource = &state, .resource_name = name, .pass = "publish",
                     .stages = state.write_stages | state.read_stages, .dst_stages = stages, .access = state.write_access,
                     .dst_access = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
    log_->push_back({.kind = HazardEvent::Kind::access, .resource = &state, .resource_name = name, .pass = "publish",
                     .stages = stages, .access = VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
  };
  for (const Buffer* buffer : buffers) {
    assert(count < barriers.size());
    VkBufferMemoryBarrier2& out = barriers[count++];
    out = {VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2};
    out.srcStageMask = buffer->sync.write_stages ? buffer->sync.write_stages : VK_PIPELINE_STAGE_2_NONE;
    out.srcAccessMask = buffer->sync.write_access;
    out.dstStageMask = stages;
    out.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    out.srcQueueFamilyIndex = out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    out.buffer = buffer->handle();
    out.size = VK_WHOLE_SIZE;
    note(buffer->sync, buffer->name());
    buffer->sync.read_stages |= stages;
  }
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.bufferMemoryBarrierCount = count;
  info.pBufferMemoryBarriers = barriers.data();
  if (image) {
    image_barrier.srcStageMask = image->sync.write_stages | image->sync.read_stages;
    image_barrier.srcAccessMask = image->sync.write_access;
    image_barrier.dstStageMask = stages;
    image_barrier.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    image_barrier.oldLayout = image->sync.layout;
    image_barrier.newLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    image_barrier.srcQueueFamilyIndex = image_barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    image_barrier.image = image->handle();
    image_barrier.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &image_barrier;
    note(image->sync, image->name());
    image->sync = {.write_stages = stages, .visible_stages = stages,
                   .visible_access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
    image->sync.read_stages = stages;
  }
  device_.vk().vkCmdPipelineBarrier2(commands_, &info);
}

Scope::Scope(Recorder& recorder, const char* name) : recorder_(recorder) {
  if (recorder.timers_) recorder.timers_->begin(recorder.commands_, name);
  if (recorder.device_.vk().vkCmdBeginDebugUtilsLabelEXT) {
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name;
    recorder.device_.vk().vkCmdBeginDebugUtilsLabelEXT(recorder.commands_, &label);
  }
}

Scope::~Scope() {
  if (recorder_.device_.vk().vkCmdEndDebugUtilsLabelEXT) recorder_.device_.vk().vkCmdEndDebugUtilsLabelEXT(recorder_.commands_);
  if (recorder_.timers_) recorder_.timers_->end(recorder_.commands_);
}

}  // namespace umbrage::gpu
