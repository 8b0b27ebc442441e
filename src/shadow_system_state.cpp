// What begin_frame is made of.
#include "shadow_system_state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace umbrage {

ShadowSystem::State::~State() {
  if (!device) return;
  const gpu::Functions& vk = device->vk();
  if (mask_sampler) vk.vkDestroySampler(device->handle(), mask_sampler, device->callbacks());
  if (pool) vk.vkDestroyDescriptorPool(device->handle(), pool, device->callbacks());
  if (host_layout) vk.vkDestroyDescriptorSetLayout(device->handle(), host_layout, device->callbacks());
}

Result<void> ShadowSystem::State::check_device() const {
  if (settings.store == Store::physical_pool && !device->capabilities().vertex_layer)
    return Error{ErrorCode::unsupported,
                 "store=physical_pool needs shaderOutputLayer (Capabilities::vertex_layer), which " + device->name() +
                     " lacks or the host has not enabled"};
  return {};
}

Result<void> ShadowSystem::State::create_host_layout() {
  const std::array<VkDescriptorSetLayoutBinding, 3> images{
      {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_ALL, nullptr},
       {1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, shared::MaxMapImages, VK_SHADER_STAGE_ALL, nullptr},
       {2, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, shared::MaxMapImages, VK_SHADER_STAGE_ALL, nullptr}}};
  constexpr VkDescriptorBindingFlags kPartly = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
  const std::array<VkDescriptorBindingFlags, 3> partly{0, kPartly, kPartly};
  VkDescriptorSetLayoutBindingFlagsCreateInfo flags{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
  flags.bindingCount = static_cast<uint32_t>(partly.size());
  flags.pBindingFlags = partly.data();
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &flags};
  info.bindingCount = static_cast<uint32_t>(images.size());
  info.pBindings = images.data();
  VkResult result =
      device->vk().vkCreateDescriptorSetLayout(device->handle(), &info, device->callbacks(), &host_layout);
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
  const std::array<VkDescriptorPoolSize, 3> sizes{
      {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, (1 + 2 * shared::MaxCameras + 2 * shared::MaxMapImages) * frames_in_flight},
       {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, shared::MaxMasks},
       {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, std::max(storage_images(), 1u) * shared::MaxCameras * frames_in_flight}}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
  info.maxSets = (shared::MaxCameras + 1) * frames_in_flight + 1;
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
    for (VkDescriptorSet& set : slot.frame_sets)
      if (auto ok = allocate(pipelines->frame_set_layout(), set); !ok) return ok.error();
    if (auto ok = allocate(host_layout, slot.host_set); !ok) return ok.error();
  }
  return allocate(pipelines->mask_set_layout(), mask_set);
}

Result<FrameSlot*> ShadowSystem::State::free_slot(const FrameDesc& desc) {
  FrameSlot& slot = slots[next_slot];
  if (slot.serial > desc.completed_serial)
    return Error{ErrorCode::invalid_argument, "FrameDesc::completed_serial is " +
                                                  std::to_string(desc.completed_serial) +
                                                  ", but with frames_in_flight = " + std::to_string(slots.size()) +
                                                  " frame " + std::to_string(slot.serial) + " must have completed"};
  return &slot;
}

void ShadowSystem::State::collect(uint64_t completed_serial) {
  retired.collect(completed_serial);
  frame->scene.collect(completed_serial);
  const FrameSlot* newest = nullptr;
  for (const FrameSlot& slot : slots)
    if (slot.serial > statistics.serial && slot.serial <= completed_serial && (!newest || slot.serial > newest->serial))
      newest = &slot;
  if (newest) read_statistics(*newest);
}

void ShadowSystem::State::read_statistics(const FrameSlot& slot) {
  shared::FrameReport report;
  std::memcpy(&report, slot.statistics.mapped(), sizeof report);
  const shared::FrameCounters& counters = report.counters;
  statistics = slot.known;
  statistics.serial = slot.serial;
  statistics.passes = {pass_times.data(), slot.timers.read(pass_times)};
  statistics.lights_visible = counters.lights_visible;
  statistics.clusters = counters.clusters_found;
  statistics.cluster_light_pairs = counters.pairs_found;
  statistics.shadow_views = counters.views_drawn;
  statistics.caster_pairs = counters.caster_pairs;
  statistics.batches_drawn = uint64_t(counters.batches_drawn_high) << 32 | counters.batches_drawn_low;
  statistics.triangles_drawn = uint64_t(counters.triangles_drawn_high) << 32 | counters.triangles_drawn_low;
  statistics.cpu_record_ms = slot.cpu_record_ms;
  degraded = slot.without_map;
  if (has_virtual_maps()) read_map_statistics(report);
  const std::byte* words = slot.statistics.mapped() + sizeof report;
  for (uint32_t light = 0; light < slot.light_slots; ++light) {
    uint32_t word;
    std::memcpy(&word, words + light * sizeof word, sizeof word);
    if (word >> shared::LightShiftAt)
      degraded.push_back(
          {LightId{frame->scene.lights().id_at(light)}, Degradation::coarser,
           uint64_t(counters.pool_units_asked - std::min(counters.pool_units, counters.pool_units_asked)) *
               shared::PoolUnit * texel_bytes()});
    if (word & shared::LightLacksCasters)
      degraded.push_back({LightId{frame->scene.lights().id_at(light)}, Degradation::casters_missing,
                          (counters.caster_pairs - counters.pair_limit) * bytes_a_caster_pair()});
  }
  statistics.overflows += uint64_t(counters.clusters_found > counters.clusters) +
                          uint64_t(counters.all_lights_used != 0) +
                          uint64_t(counters.caster_pairs > counters.pair_limit);
  statistics.lights_degraded = static_cast<uint32_t>(degraded.size());
  read_cascade_statistics(slot);

  if (counters.pairs_found > pair_capacity) pair_capacity = counters.pairs_found + counters.pairs_found / 4;
  if (slot.serial >= edit_serial) {
    caster_pairs_seen =
        caster_pairs_known ? std::max<uint64_t>(caster_pairs_seen, counters.caster_pairs) : counters.caster_pairs;
    caster_pairs_known = true;
  }
}

void ShadowSystem::State::read_map_statistics(const shared::FrameReport& report) {
  const shared::FrameCounters& counters = report.counters;
  statistics.shadow_maps = counters.maps;
  statistics.shadow_views = counters.receiver_views;
  statistics.pages_requested = counters.pages_requested;
  statistics.pages_resident = statistics.pages_rendered = counters.pages;
  statistics.texels_requested = uint64_t(counters.pool_units_asked) * shared::PoolUnit;
  statistics.texels_allocated = uint64_t(counters.pool_units) * shared::PoolUnit;
  statistics.unbacked_taps = report.taps.unbacked;
  statistics.unmarked_taps = report.taps.unmarked;
  const auto grown = [](uint32_t have, uint32_t found) { return found > have ? found + found / 4 : have; };
  statistics.overflows += uint64_t(counters.maps_found > map_sizes.maps) +
                          uint64_t(counters.page_words_found > map_sizes.words) +
                          uint64_t(counters.receiver_views_found > map_sizes.receiver_views);
  large_triangles = std::min(grown(large_triangles, counters.large_triangles), kMaxLargeTriangles);
  map_sizes.maps = grown(map_sizes.maps, counters.maps_found);
  map_sizes.words = grown(map_sizes.words, counters.page_words_found);
  map_sizes.receiver_views = grown(map_sizes.receiver_views, counters.receiver_views_found);
}

void ShadowSystem::State::lay_out_images(const FrameSettings& frame_settings, std::vector<uint32_t>& changed) {
  const bool is_sparse = settings.store == Store::hardware_sparse;
  const gpu::Limits& limits = device->limits();
  store::ImageDemand demand{.finest = frame_settings.max_resolution,
                            .texels = budget_bytes() / texel_bytes(),
                            .most_side = limits.max_image_side,
                            .most_layers = limits.max_image_layers};
  const store::LeastRoom room =
      store::least_room_of_images(demand, is_sparse ? store::kOrdinaryMaps : store::kLeastMaps, texel_bytes());
  views = store::number_views(frame->scene.lights(), room, 1, changed, without_map).views;
  // In powers of two, so that a light more or less makes no new images.
  demand.views = static_cast<uint32_t>(std::min<uint64_t>(std::bit_ceil(views), room.views));
  if (!is_sparse) {
    image_layout = store::lay_out_images(demand);
    return;
  }
  const store::SparseForm& form = frame->sparse.form();
  const VkImageFormatProperties most = device->sparse_image_limits(form.format(), form.usage());
  demand.most_side = std::min({demand.most_side, most.maxExtent.width, most.maxExtent.height});
  demand.most_layers = std::min(demand.most_layers, most.maxArrayLayers);
  // A quarter of the address space is left to others.
  const uint64_t address_texels = limits.sparse_address_bytes / 4 * 3 / form.texel_bytes();
  sparse_layout = store::lay_out_sparse(demand, form, address_texels, most.maxResourceSize / form.texel_bytes());
}

uint64_t ShadowSystem::State::texel_bytes() const {
  if (settings.store == Store::hardware_sparse) return frame->sparse.form().texel_bytes();
  return settings.store == Store::physical_pool ? sizeof(uint16_t) : sizeof(uint32_t);
}

Result<void> ShadowSystem::State::lay_out_maps(const FrameSettings& frame_settings) {
  const std::array<uint32_t, 3> wanted{frame_settings.min_resolution, frame_settings.max_resolution,
                                       most_cascade_lights(frame_settings)};
  if (!frame->scene.lights_edited() && wanted == laid_out_for) return {};
  choose_cascade_lights(frame_settings);
  std::vector<uint32_t> changed;
  if (settings.store == Store::page_pool) {
    const store::ViewCount numbered = store::number_views(
        frame->scene.lights(), store::least_room_of_pool(budget_bytes()), store::kSunViews, changed, without_map);
    views = numbered.views, map_sizes.suns = numbered.suns;
  } else if (has_virtual_maps()) {
    lay_out_images(frame_settings, changed);
  } else {
    layout = store::lay_out(frame->scene.lights(), budget_bytes(), device->limits().max_image_side, frame_settings,
                            changed, without_map);
    views = layout.views;
  }
  for (const uint32_t slot : changed) frame->scene.light_changed(slot);
  laid_out_for = wanted;
  return {};
}

Result<void> ShadowSystem::State::reserve(FrameSlot& slot, uint32_t tile_count, const FrameDesc& desc) {
  scene::GpuScene& scene = frame->scene;
  const uint32_t light_slots = scene.light_slots();
  if (auto ok = frame->clusters.reserve(*device, *memory, tile_count, pair_capacity, light_slots, outgrown); !ok)
    return ok.error();
  if (auto ok = frame->views.reserve(*device, *memory, views, outgrown); !ok) return ok.error();
  if (auto ok = frame->others.reserve(*device, *memory, desc.cameras, outgrown); !ok) return ok.error();
  // The include names the atlas, so that there is one in any case.
  if (auto ok = frame->store.reserve(*device, *memory, layout, retired, desc.serial); !ok) return ok.error();
  if (auto ok = has_virtual_maps() ? reserve_virtual_maps(desc) : reserve_fixed_cubes(desc); !ok) return ok.error();
  if (settings.store == Store::page_pool)
    if (auto ok = reserve_page_pool(desc); !ok) return ok.error();
  if (settings.store == Store::physical_pool)
    if (auto ok = reserve_physical_pool(desc); !ok) return ok.error();
  if (settings.store == Store::hardware_sparse)
    if (auto ok = reserve_sparse(slot, desc); !ok) return ok.error();
  const VkDeviceSize bytes = sizeof(shared::FrameReport) + light_slots * sizeof(uint32_t);
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
  known.shadow_memory_bytes = frame->store.texels() * sizeof(uint32_t);
  if (settings.store == Store::page_pool) {
    known.shadow_memory_bytes = frame->pool.pool().size();
  } else if (settings.store == Store::physical_pool) {
    known.shadow_memory_bytes = image_layout.texels * texel_bytes();
  } else if (settings.store == Store::hardware_sparse) {
    known.shadow_memory_bytes = frame->sparse.memory_bytes();
  } else {
    known.map_resolution = layout.resolution;
    known.texels_allocated = frame->store.texels();
    known.shadow_maps = layout.maps;
  }
  known.table_memory_bytes = bytes_beside(known.shadow_memory_bytes);
  return {};
}

uint64_t ShadowSystem::State::bytes_beside(uint64_t shadow_bytes) const {
  const uint64_t in_use = memory->bytes_in_use(gpu::MemoryKind::device);
  return in_use - std::min(in_use, shadow_bytes);
}

Result<void> ShadowSystem::State::reserve_fixed_cubes(const FrameDesc& desc) {
  const scene::GpuScene& scene = frame->scene;
  const uint64_t most_at_once = std::min(1u << 20, device->limits().max_draw_indirect_count);
  const auto capacity = static_cast<uint32_t>(std::clamp<uint64_t>(caster_capacity(), 1024, most_at_once));
  const bool traditional = desc.settings.writer == Writer::traditional;
  return frame->culling.reserve(*device, *memory, scene.light_slots(), std::max(capacity, frame->culling.capacity()),
                                traditional ? raster::kViewsAtOnce : 0, scene.caster_slots(), outgrown);
}

Result<void> ShadowSystem::State::reserve_virtual_maps(const FrameDesc& desc) {
  const uint32_t light_slots = frame->scene.light_slots();
  // At least what every light's coarsest map and whole map take; more from what frames report.
  map_sizes.light_slots = std::max(map_sizes.light_slots, light_slots);
  map_sizes.pairs = frame->clusters.pair_capacity();
  const uint32_t sun_maps = map_sizes.suns * kExpectedSunMaps;
  map_sizes.maps = std::max({map_sizes.maps, 3 * light_slots + sun_maps, 64u});
  map_sizes.receiver_views = std::max({map_sizes.receiver_views, 3 * views, 384u});
  map_sizes.words = std::max(
      {map_sizes.words, 8 * views + sun_maps * shared::page_words_of(shared::pages_of(1u << shared::MaxLevel)), 4096u});
  map_sizes.receiver_grid = desc.settings.receiver_grid;
  const auto grid_bytes = [&] {
    return uint64_t(map_sizes.receiver_views) * map_sizes.receiver_grid * map_sizes.receiver_grid * sizeof(uint32_t);
  };
  while (map_sizes.receiver_grid > 1 && grid_bytes() > kMaxGridBytes) map_sizes.receiver_grid /= 2;
  if (auto ok = frame->maps.reserve(*device, *memory, map_sizes, outgrown); !ok) return ok;
  const uint32_t most = settings.store == Store::page_pool ? UINT32_MAX : raster::kLayerItems;
  const uint32_t capacity = std::min(std::max({caster_capacity(), frame->map_culling.capacity(), 1024u}), most);
  if (auto ok = frame->map_culling.reserve(*device, *memory, map_sizes.maps, capacity, outgrown); !ok) return ok;
  return frame->map_culling.prepare(*pipelines, desc.settings.caster_culling);
}

Result<void> ShadowSystem::State::reserve_page_pool(const FrameDesc& desc) {
  if (auto ok = frame->pool.reserve(*device, *memory, budget_bytes(), map_sizes.words, outgrown); !ok) return ok;
  if (desc.settings.writer == Writer::fragments) return frame->page_fragments.reserve(*device, *memory);
  return frame->page_raster.reserve(*device, *memory, large_triangles, budget_bytes(), outgrown);
}

Result<void> ShadowSystem::State::reserve_physical_pool(const FrameDesc& desc) {
  if (auto ok =
          frame->images.reserve(*device, *memory, image_layout, {.format = VK_FORMAT_D16_UNORM}, retired, desc.serial);
      !ok)
    return ok;
  return frame->layer_writer.reserve(*device, *memory, image_layout, outgrown);
}

Result<void> ShadowSystem::State::reserve_sparse(FrameSlot& slot, const FrameDesc& desc) {
  if (auto ok = frame->sparse.reserve(*device, *memory, sparse_layout, retired, desc.serial); !ok) return ok;
  if (!slot.page_requests || slot.page_requests.size() < frame->sparse.request_bytes()) {
    auto made = gpu::Buffer::create(*device, *memory, frame->sparse.request_bytes(), gpu::MemoryKind::readback,
                                    "page requests");
    if (!made) return made.error();
    slot.page_requests = std::move(*made);
  }
  return frame->layer_writer.reserve(*device, *memory, sparse_layout.images, outgrown);
}

/// (batch, view) pairs of fixed cubes, (batch, map) pairs of virtual shadow maps.
uint64_t ShadowSystem::State::most_caster_pairs() const {
  const uint64_t targets = has_virtual_maps() ? map_sizes.maps : views;
  return targets * std::max(frame->scene.casters(), 1u);
}

/// Room for half as many pairs again as any frame has needed, so that one round does; for what nothing is known of yet, as
/// many as the rounds demand.
uint32_t ShadowSystem::State::caster_capacity() const {
  const uint64_t most = most_caster_pairs();
  const uint64_t expected = caster_pairs_known ? std::min<uint64_t>(caster_pairs_seen * 3 / 2, kMaxGrownPairs)
                                               : (most + kMaxRounds - 1) / kMaxRounds;
  return static_cast<uint32_t>(
      std::min<uint64_t>({most, std::max<uint64_t>(settings.max_caster_pairs, expected), UINT32_MAX / 4}));
}

uint32_t ShadowSystem::State::caster_pairs_per_round() const {
  return has_virtual_maps() ? frame->map_culling.capacity() : frame->culling.capacity();
}

uint64_t ShadowSystem::State::bytes_a_caster_pair() const {
  return has_virtual_maps() ? culling::MapCulling::kBytesAnItem : culling::CasterCulling::kBytesAnInstance;
}

uint32_t ShadowSystem::State::plan_rounds() {
  const uint64_t capacity = caster_pairs_per_round();
  const uint64_t most = most_caster_pairs();
  // Half as many again as any frame has needed: movement adds pairs. With nothing known, the most there can be.
  const uint64_t expected = caster_pairs_known ? std::min(most, caster_pairs_seen * 3 / 2) : most;
  return static_cast<uint32_t>(std::clamp<uint64_t>((expected + capacity - 1) / capacity, 1, kMaxRounds));
}

uint32_t ShadowSystem::State::shader_store() const {
  switch (settings.store) {
    case Store::fixed_cubes:
      return shared::StoreAtlas;
    case Store::page_pool:
      return shared::StorePool;
    case Store::physical_pool:
      return shared::StoreImages;
    case Store::hardware_sparse:
      return frame->sparse.form().is_attachment ? shared::StoreSparseDepth : shared::StoreSparseWords;
  }
  return shared::StorePool;
}

/// A box of CameraDesc::other_receivers_ws.
bool is_sound(const Aabb& box) {
  const float sides[3][2] = {{box.min.x, box.max.x}, {box.min.y, box.max.y}, {box.min.z, box.max.z}};
  return std::all_of(std::begin(sides), std::end(sides), [](const float (&side)[2]) {
    return std::isfinite(side[0]) && std::isfinite(side[1]) && side[0] <= side[1];
  });
}

Result<CameraRecords> camera_records(std::span<const CameraDesc> cameras) {
  const auto invalid = [](std::string text) { return Error{ErrorCode::invalid_argument, std::move(text)}; };
  if (cameras.empty() || cameras.size() > shared::MaxCameras)
    return invalid("FrameDesc::cameras: 1…" + std::to_string(shared::MaxCameras) + " cameras are supported, not " +
                   std::to_string(cameras.size()));
  CameraRecords made;
  for (size_t i = 0; i < cameras.size(); ++i) {
    const CameraDesc& camera = cameras[i];
    if (!camera.depth) return invalid("CameraDesc::depth is VK_NULL_HANDLE");
    if ((camera.normal == VK_NULL_HANDLE) != (camera.normal_encoding == NormalEncoding::none))
      return invalid("CameraDesc: a normal image and an encoding belong together");
    for (size_t other = 0; other < i; ++other)
      if (cameras[other].id.value == camera.id.value)
        return invalid("FrameDesc::cameras: two have the id " + std::to_string(camera.id.value) +
                       "; each needs its own");
    const auto boxes = camera.other_receivers_ws;
    if (const auto bad = std::find_if_not(boxes.begin(), boxes.end(), is_sound); bad != boxes.end())
      return invalid("CameraDesc::other_receivers_ws: box " + std::to_string(bad - boxes.begin()) +
                     " is not finite or has a minimum above its maximum");
    auto record = clusters::camera_record(camera);
    if (!record) return record.error();
    record->first_tile = i == 0 ? 0 : made.records[i - 1].end_tile;
    record->end_tile += record->first_tile;
    made.records[made.count++] = *record;
  }
  return made;
}

void ShadowSystem::State::plan_cameras(std::span<const CameraDesc> cameras,
                                       std::span<const shared::CameraRecord> records) {
  plan.camera_count = static_cast<uint32_t>(cameras.size());
  for (uint32_t i = 0; i < plan.camera_count; ++i) {
    plan.cameras[i] = {.record = frame->camera_record(i),
                       .images = current->frame_sets[i],
                       .tiles = records[i].tiles,
                       .normal_encoding = cameras[i].normal_encoding};
    plan.camera_ids[i] = cameras[i].id;
  }
}

void ShadowSystem::State::fill_block(FrameBlock& block, std::span<const shared::CameraRecord> cameras,
                                     const FrameSlot& slot) const {
  shared::FrameRecord& record = block.record;
  record.camera = cameras.front();
  record.cameras = frame->camera_record(0);
  record.camera_count = static_cast<uint32_t>(cameras.size());
  record.tile_count = cameras.back().end_tile;
  record.caster_error = static_cast<float>(plan.settings.caster_error_percent) / 100.0f;
  record.lights = frame->scene.light_buffer().address();
  record.light_order = frame->scene.light_order_buffer().address();
  record.counters = frame->counters.address();
  record.light_count = frame->scene.lights().count();
  record.directional_count = frame->scene.directional_lights();
  frame->clusters.fill(record);
  frame->views.fill(record);
  frame->store.fill(record);
  record.tap_counts = slot.statistics.address();
  if (has_virtual_maps()) frame->maps.fill(record);
  record.cascades = cascade_lights.empty() ? 0 : frame->cascades.table().address();
  record.store = shader_store();
  if (settings.store == Store::page_pool) frame->pool.fill(record);
  if (!Frame::draws_samples_only(plan)) record.texel_bits = 0;
  if (has_virtual_maps() && texel_bytes() == sizeof(uint16_t)) record.depth_step = 1.0f / 65535.0f;
  const std::vector<shared::MapImage>& images = frame->map_images(settings.store).layout().images;
  std::copy(images.begin(), images.end(), block.images.begin());
  block.caster_shape = scene::tree_shape(frame->scene.caster_slots());
  block.light_shape = scene::tree_shape(frame->scene.light_slots());
  std::copy(cameras.begin(), cameras.end(), block.cameras.begin());
  for (size_t i = 1; i < cameras.size(); ++i) {
    block.other_records[i - 1] = record;
    block.other_records[i - 1].camera = cameras[i];
  }
}

void ShadowSystem::State::write_sets(FrameSlot& slot, std::span<const CameraDesc> cameras) {
  const gpu::Functions& vk = device->vk();
  const auto write = [&](VkDescriptorSet set, uint32_t binding, uint32_t element, const VkDescriptorImageInfo& image,
                         VkDescriptorType type) {
    VkWriteDescriptorSet out{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    out.dstSet = set, out.dstBinding = binding, out.dstArrayElement = element, out.descriptorCount = 1;
    out.descriptorType = type;
    out.pImageInfo = &image;
    vk.vkUpdateDescriptorSets(device->handle(), 1, &out, 0, nullptr);
  };
  constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  constexpr VkImageLayout kDepthRead = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
  for (size_t i = 0; i < cameras.size(); ++i) {
    const CameraDesc& camera = cameras[i];
    write(slot.frame_sets[i], 0, 0, {VK_NULL_HANDLE, camera.depth, camera.depth_layout}, kSampled);
    if (camera.normal) write(slot.frame_sets[i], 1, 0, {VK_NULL_HANDLE, camera.normal, camera.normal_layout}, kSampled);
  }
  write(slot.host_set, 0, 0, {VK_NULL_HANDLE, frame->store.atlas().view(), kDepthRead}, kSampled);
  // All elements, so that none names an image that is gone.
  const std::vector<gpu::Image>& images = frame->map_images(settings.store).images();
  for (uint32_t i = 0; !images.empty() && i < shared::MaxMapImages; ++i) {
    const gpu::Image& image = images[std::min<size_t>(i, images.size() - 1)];
    if (image.aspect() == VK_IMAGE_ASPECT_DEPTH_BIT) {
      write(slot.host_set, 1, i, {VK_NULL_HANDLE, image.view(), kDepthRead}, kSampled);
    } else {
      write(slot.host_set, 2, i, {VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL}, kSampled);
      write(slot.frame_sets[0], 2, i, {VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL},
            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    }
  }

  for (const uint32_t mask : frame->scene.new_masks()) {
    const auto& entry = frame->scene.masks().at(mask);
    const VkDescriptorImageInfo image{entry.sampler ? entry.sampler : mask_sampler, entry.view,
                                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    write(mask_set, 0, mask, image, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  }
  frame->scene.new_masks().clear();
}

gpu::Recorder ShadowSystem::State::recorder(VkCommandBuffer commands, FrameSlot& slot) {
  return {*device, *pipelines, commands, &slot.timers, slot.frame_sets[0], mask_set, hazard_log};
}

}  // namespace umbrage
