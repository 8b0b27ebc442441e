// One table from access to stage, access mask and layout; barriers are what the last accesses of a resource leave open.
#include "gpu/recorder.hpp"

#include <cassert>

namespace umbrage::gpu {

struct AccessInfo {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;  // of images
  bool writes;
};

/// What must be waited for before an access.
struct Barrier {
  VkPipelineStageFlags2 src_stages = 0;
  VkAccessFlags2 src_access = 0;
  VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  bool needed = false;
};

namespace {
AccessInfo info_of(Access access) {
  switch (access) {
    case Access::compute_read:
      return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
              VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, false};
    case Access::compute_write:
      return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
              VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL,
              true};
    case Access::vertex_read:
      return {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
              VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, false};
    case Access::geometry_read:
      return {VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
              VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, false};
    case Access::vertex_attribute_read:
      return {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
              VK_IMAGE_LAYOUT_UNDEFINED, false};
    case Access::fragment_read:
      return {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
              VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, false};
    case Access::fragment_write:
      return {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
              VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL,
              true};
    case Access::indirect_read:
      return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
              false};
    case Access::index_read:
      return {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, false};
    case Access::transfer_read:
      return {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false};
    case Access::transfer_write:
      return {VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, true};
    case Access::depth_attachment:
      return {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
              VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
              VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, true};
    case Access::host_read:
      return {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, false};
  }
  return {};
}

bool is_visible(const SyncState& state, const AccessInfo& now) {
  VkPipelineStageFlags2 stages = 0;
  for (uint32_t i = 0; i < state.visible_count; ++i)
    if ((state.visible[i].access & now.access) == now.access) stages |= state.visible[i].stages;
  return (stages & now.stages) == now.stages;
}

/// The barrier that an access needs, and the state after it. A change of layout is a write that the access follows.
Barrier advance(SyncState& state, const AccessInfo& now, bool is_image) {
  Barrier barrier{.old_layout = state.layout};
  const bool changes_layout = is_image && state.layout != now.layout;
  if (now.writes || changes_layout) {
    barrier.src_stages = state.write_stages | state.read_stages;
    barrier.src_access = state.write_access;
    barrier.needed = changes_layout || barrier.src_stages != 0;
    state.write_stages = now.stages;
    state.write_access = now.writes ? now.access : 0;
    state.read_stages = 0, state.visible_count = 0;
    if (is_image) state.layout = now.layout;
  } else if (state.write_stages && !is_visible(state, now)) {
    barrier.src_stages = state.write_stages;
    barrier.src_access = state.write_access;
    barrier.needed = true;
  }
  if (now.writes) return barrier;
  // When there is no room left to remember, a later read has one barrier too many.
  if (barrier.needed && state.visible_count < state.visible.size())
    state.visible[state.visible_count++] = {now.stages, now.access};
  state.read_stages |= now.stages;
  return barrier;
}

/// Words are written by shaders: such an image stays in one layout.
VkImageLayout layout_of(const Image& image, VkImageLayout of_depth) {
  return image.aspect() == VK_IMAGE_ASPECT_DEPTH_BIT ? of_depth : VK_IMAGE_LAYOUT_GENERAL;
}
}  // namespace

Pass::Pass(Recorder& recorder, const char* name)
    : recorder_(recorder), name_(name), number_(recorder.log_ ? static_cast<uint32_t>(recorder.log_->size()) : 0) {}

VkDeviceAddress Pass::read(const Buffer& buffer, Access access) {
  declare(buffer, info_of(access));
  return buffer.address();
}
VkDeviceAddress Pass::write(const Buffer& buffer, Access access) {
  declare(buffer, info_of(access));
  return buffer.address();
}
void Pass::image(const Image& image, Access access) {
  AccessInfo now = info_of(access);
  if (now.access == VK_ACCESS_2_SHADER_STORAGE_READ_BIT) now.access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  now.layout = layout_of(image, now.layout);
  declare(image, now);
}

void Pass::declare(const Buffer& buffer, const AccessInfo& now) {
  const Barrier barrier = advance(buffer.sync, now, false);
  log(buffer.sync, buffer.name(), now, barrier);
  if (!barrier.needed) return;
  assert(buffer_count_ < buffers_.size());
  VkBufferMemoryBarrier2& out = buffers_[buffer_count_++];
  out = {VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2};
  out.srcStageMask = barrier.src_stages, out.srcAccessMask = barrier.src_access;
  out.dstStageMask = now.stages, out.dstAccessMask = now.access;
  out.srcQueueFamilyIndex = out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  out.buffer = buffer.handle();
  out.size = VK_WHOLE_SIZE;
}

void Pass::declare(const Image& image, const AccessInfo& now) {
  const Barrier barrier = advance(image.sync, now, true);
  log(image.sync, image.name(), now, barrier);
  if (!barrier.needed) return;
  assert(image_count_ < images_.size());
  VkImageMemoryBarrier2& out = images_[image_count_++];
  out = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  out.srcStageMask = barrier.src_stages, out.srcAccessMask = barrier.src_access;
  out.dstStageMask = now.stages, out.dstAccessMask = now.access;
  out.oldLayout = barrier.old_layout, out.newLayout = now.layout;
  out.srcQueueFamilyIndex = out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  out.image = image.handle();
  out.subresourceRange = {image.aspect(), 0, 1, 0, image.layers()};
}

void Pass::log(const SyncState& state, const char* resource_name, const AccessInfo& now, const Barrier& barrier) const {
  HazardLog* log = recorder_.log_;
  if (!log) return;
  const bool is_image = state.layout != VK_IMAGE_LAYOUT_UNDEFINED;
  HazardEvent event{.resource = state.resource, .resource_name = resource_name, .pass = name_, .pass_number = number_};
  if (barrier.needed) {
    event.kind = HazardEvent::Kind::barrier;
    event.stages = barrier.src_stages, event.access = barrier.src_access;
    event.dst_stages = now.stages, event.dst_access = now.access;
    if (is_image) event.old_layout = barrier.old_layout, event.layout = now.layout;
    log->push_back(event);
  }
  event.kind = HazardEvent::Kind::access;
  event.writes = now.writes;
  event.stages = now.stages, event.access = now.access;
  event.dst_stages = 0, event.dst_access = 0;
  if (is_image) event.layout = now.layout;
  log->push_back(event);
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

void Recorder::publish(std::span<const Buffer* const> buffers, std::span<const Image* const> images,
                       VkPipelineStageFlags2 stages) {
  Pass shown = pass("publish");
  for (const Buffer* buffer : buffers)
    shown.declare(*buffer, {stages, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, false});
  for (const Image* image : images)
    shown.declare(*image, {stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                           layout_of(*image, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL), false});
  shown.flush();
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
  if (recorder_.device_.vk().vkCmdEndDebugUtilsLabelEXT)
    recorder_.device_.vk().vkCmdEndDebugUtilsLabelEXT(recorder_.commands_);
  if (recorder_.timers_) recorder_.timers_->end(recorder_.commands_);
}

}  // namespace umbrage::gpu
