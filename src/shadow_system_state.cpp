// What begin_frame is made of.
#include "shadow_system_state.hpp"

#include <algorithm>
#include <cstring>

namespace umbrage {

ShadowSystem::State::~State() {
  if (!device) return;
  const gpu::Functions& vk = device->vk();
  if (mask_sampler) vk.vkDestroySampler(device->handle(), mask_sampler, device->callbacks());
  if (pool) vk.vkDestroyDescriptorPool(device->handle(), pool, device->callbacks());
  if (host_layout) vk.vkDestroyDescriptorSetLayout(device->handle(), host_layout, device->callbacks());
}

Result<void> ShadowSystem::State::create_host_layout() {
  const VkDescriptorSetLayoutBinding atlas{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_ALL, nullptr};
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.bindingCount = 1;
  info.pBindings = &atlas;
  VkResult result = device->vk().vkCreateDescriptorSetLayout(device->handle(), &info, device->callbacks(), &host_layout);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateDescriptorSetLayout", "host");
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  sampler.maxLod = VK_LOD_CLAMP_NONE;
  result = device->vk().vkCreateSampler(device->handle(), &sampler, device->callbacks(), &mask_sampler);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateSampler", "masks");
  return {};
}

Result<void> ShadowSystem::State::create_sets(uint32_t frames_in_flight) {
  const std::array<VkDescriptorPoolSize, 2> sizes{{{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 3 * frames_in_flight},
                                                   {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, shared::MaxMasks}}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
  info.maxSets = 2 * frames_in_flight + 1;
  info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkResult result = device->vk().vkCreateDescriptorPool(device->handle(), &info, device->callbacks(), &pool);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateDescriptorPool", "");
  const auto allocate = [&](VkDescriptorSetLayout set_layout, VkDescriptorSet& set) -> Result<void> {
    VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &set_layout;
    const VkResult allocated = device->vk().vkAllocateDescriptorSets(device->handle(), &allocation, &set);
    if (allocated != VK_SUCCESS) return gpu::vulkan_error(allocated, "vkAllocateDescriptorSets", "");
    return {};
  };
  for (FrameSlot& slot : slots) {
    if (auto ok = allocate(pipelines->frame_set_layout(), slot.frame_set); !ok) return ok.error();
    if (auto ok = allocate(host_layout, slot.host_set); !ok) return ok.error();
  }
  return allocate(pipelines->mask_set_layout(), mask_set);
}

Result<FrameSlot*> ShadowSystem::State::free_slot(const FrameDesc& desc) {
  FrameSlot& slot = slots[next_slot];
  if (slot.serial > desc.completed_serial)
    return Error{ErrorCode::invalid_argument,
                 "FrameDesc::completed_serial is " + std::to_string(desc.completed_serial) + ", but with frames_in_flight = " +
                     std::to_string(slots.size()) + " frame " + std::to_string(slot.serial) + " must have completed"};
  return &slot;
}

void ShadowSystem::State::collect(uint64_t completed_serial) {
  retired.collect(completed_serial);
  frame->scene.collect(completed_serial);
  const FrameSlot* newest = nullptr;
  for (const FrameSlot& slot : slots)
    if (slot.serial > statistics.serial && slot.serial <= completed_serial && (!newest || slot.serial > newest->serial)) newest = &slot;
  if (newest) read_statistics(*newest);
}

void ShadowSystem::State::read_statistics(const FrameSlot& slot) {
  shared::FrameCounters counters;
  std::memcpy(&counters, slot.statistics.mapped(), sizeof counters);
  statistics = slot.known;
  statistics.serial = slot.serial;
  statistics.passes = {pass_times.data(), slot.timers.read(pass_times)};
  statistics.lights_visible = counters.lights_visible;
  statistics.clusters = counters.clusters;
  statistics.cluster_light_pairs = counters.pairs_found;
  statistics.shadow_views = counters.views_drawn;
  statistics.caster_pairs = counters.caster_pairs;
  statistics.batches_drawn = uint64_t(counters.batches_drawn_high) << 32 | counters.batches_drawn_low;
  statistics.triangles_drawn = uint64_t(counters.triangles_drawn_high) << 32 | counters.triangles_drawn_low;
  statistics.cpu_record_ms = slot.cpu_record_ms;
  degraded = slot.without_map;
  const std::byte* words = slot.statistics.mapped() + sizeof counters;
  for (uint32_t light = 0; light < slot.light_slots; ++light) {
    uint32_t word;
    std::memcpy(&word, words + light * sizeof word, sizeof word);
    if (word & shared::LightLacksCasters)
      degraded.push_back({LightId{frame->scene.lights().id_at(light)}, Degradation::casters_missing,
                          (counters.caster_pairs - counters.pair_limit) * (sizeof(shared::CasterInstance) + 2 * sizeof(shared::DrawCommand))});
  }
  statistics.overflows = uint64_t(counters.clusters_found > counters.clusters) + uint64_t(counters.all_lights_used != 0) +
                         uint64_t(counters.caster_pairs > counters.pair_limit);
  statistics.lights_degraded = static_cast<uint32_t>(degraded.size());

  if (counters.pairs_found > pair_capacity) pair_capacity = counters.pairs_found + counters.pairs_found / 4;
  if (slot.serial >= edit_serial) {
    caster_pairs_seen = caster_pairs_known ? std::max<uint64_t>(caster_pairs_seen, counters.caster_pairs) : counters.caster_pairs;
    caster_pairs_known = true;
  }
}

Result<void> ShadowSystem::State::lay_out_maps(const FrameSettings& frame_settings) {
  const std::array<uint32_t, 2> wanted{frame_settings.min_resolution, frame_settings.max_resolution};
  if (!frame->scene.lights_edited() && wanted == laid_out_for) return {};
  std::vector<uint32_t> changed;
  layout = store::lay_out(frame->scene.lights(), uint64_t(settings.budget_mib) << 20, device->limits().max_image_side, frame_settings,
                          changed, without_map);
  for (const uint32_t slot : changed) frame->scene.light_changed(slot);
  laid_out_for = wanted;
  return {};
}

Result<void> ShadowSystem::State::reserve(FrameSlot& slot, const shared::CameraRecord& camera, const FrameDesc& desc) {
  scene::GpuScene& scene = frame->scene;
  const uint32_t light_slots = scene.light_slots();
  if (auto ok = frame->clusters.reserve(*device, *memory, camera.tiles, pair_capacity, light_slots, outgrown); !ok) return ok.error();
  if (auto ok = frame->store.reserve(*device, *memory, layout, retired, desc.serial); !ok) return ok.error();

  // Room for half as many pairs again as any frame has needed, so that one round does; for what nothing is known of yet, as
  // many as the rounds demand.
  const uint64_t most_pairs = uint64_t(layout.views) * std::max(scene.casters(), 1u);
  const uint64_t expected = caster_pairs_known ? std::min<uint64_t>(caster_pairs_seen * 3 / 2, kMaxGrownPairs) : (most_pairs + kMaxRounds - 1) / kMaxRounds;
  const uint64_t needed = std::min(most_pairs, std::max<uint64_t>(settings.max_caster_pairs, expected));
  const uint32_t most_at_once = std::min(1u << 20, device->limits().max_draw_indirect_count);
  const auto capacity = static_cast<uint32_t>(std::clamp<uint64_t>(needed, 1024, most_at_once));
  const bool traditional = desc.settings.writer == Writer::traditional;
  if (auto ok = frame->culling.reserve(*device, *memory, light_slots, std::max(capacity, frame->culling.capacity()),
                                       traditional ? raster::kViewsAtOnce : 0, scene.caster_slots(), outgrown); !ok)
    return ok.error();

  const VkDeviceSize bytes = sizeof(shared::FrameCounters) + light_slots * sizeof(uint32_t);
  if (!slot.statistics || slot.statistics.size() < bytes) {
    auto made = gpu::Buffer::create(*device, *memory, 2 * bytes, gpu::MemoryKind::readback, "statistics");
    if (!made) return made.error();
    slot.statistics = std::move(*made);
  }
  slot.light_slots = light_slots;
  Statistics& known = slot.known;
  known = {};
  known.lights = scene.lights().count();
  known.casters = scene.casters();
  known.map_resolution = layout.resolution;
  known.texels_allocated = frame->store.texels();
  known.shadow_memory_bytes = frame->store.texels() * sizeof(uint32_t);
  known.table_memory_bytes = memory->bytes_in_use(gpu::MemoryKind::device) - std::min(memory->bytes_in_use(gpu::MemoryKind::device), known.shadow_memory_bytes);
  known.shadow_maps = layout.maps;
  return {};
}

uint32_t ShadowSystem::State::plan_rounds() {
  const uint64_t capacity = frame->culling.capacity();
  const uint64_t most = uint64_t(layout.views) * frame->scene.casters();
  // Half as many again as any frame has needed: movement adds pairs. With nothing known, the most there can be.
  const uint64_t expected = caster_pairs_known ? std::min(most, caster_pairs_seen * 3 / 2) : most;
  return static_cast<uint32_t>(std::clamp<uint64_t>((expected + capacity - 1) / capacity, 1, kMaxRounds));
}

void ShadowSystem::State::fill_block(FrameBlock& block, const shared::CameraRecord& camera) const {
  shared::FrameRecord& record = block.record;
  record.camera = camera;
  record.lights = frame->scene.light_buffer().address();
  record.light_order = frame->scene.light_order_buffer().address();
  record.counters = frame->counters.address();
  record.light_count = frame->scene.lights().count();
  record.directional_count = frame->scene.directional_lights();
  frame->clusters.fill(record);
  frame->store.fill(record);
  block.caster_shape = scene::tree_shape(frame->scene.caster_slots());
  block.light_shape = scene::tree_shape(frame->scene.light_slots());
}

void ShadowSystem::State::write_sets(FrameSlot& slot, const CameraDesc& camera) {
  std::array<VkDescriptorImageInfo, 3> images{};
  images[0] = {VK_NULL_HANDLE, camera.depth, camera.depth_layout};
  images[1] = {VK_NULL_HANDLE, frame->store.atlas().view(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
  images[2] = {VK_NULL_HANDLE, camera.normal, camera.normal_layout};
  std::array<VkWriteDescriptorSet, 3> writes{};
  const auto write = [&](VkDescriptorSet set, uint32_t binding, const VkDescriptorImageInfo& image) {
    VkWriteDescriptorSet out{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    out.dstSet = set, out.dstBinding = binding, out.descriptorCount = 1;
    out.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    out.pImageInfo = &image;
    return out;
  };
  writes[0] = write(slot.frame_set, 0, images[0]);
  writes[1] = write(slot.host_set, 0, images[1]);
  writes[2] = write(slot.frame_set, 1, images[2]);
  const gpu::Functions& vk = device->vk();
  vk.vkUpdateDescriptorSets(device->handle(), camera.normal ? 3 : 2, writes.data(), 0, nullptr);

  for (const uint32_t mask : frame->scene.new_masks()) {
    const auto& entry = frame->scene.masks().at(mask);
    const VkDescriptorImageInfo image{entry.sampler ? entry.sampler : mask_sampler, entry.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet out = write(mask_set, 0, image);
    out.dstArrayElement = mask;
    out.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    vk.vkUpdateDescriptorSets(device->handle(), 1, &out, 0, nullptr);
  }
  frame->scene.new_masks().clear();
}

gpu::Recorder ShadowSystem::State::recorder(VkCommandBuffer commands, FrameSlot& slot) {
  return {*device, *pipelines, commands, &slot.timers, slot.frame_set, mask_set, hazard_log};
}

}  // namespace umbrage
