// The public class: edits go to the scene, begin_frame decides everything that the host decides, record_* only records.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "shadow_system_state.hpp"

namespace umbrage {

namespace {
Error invalid(std::string text) { return {ErrorCode::invalid_argument, std::move(text)}; }

class Stopwatch {
 public:
  explicit Stopwatch(double& ms) : ms_(ms), begin_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  double& ms_;
  std::chrono::steady_clock::time_point begin_;
};
}  // namespace

ShadowSystem::ShadowSystem(std::unique_ptr<State> state) : state_(std::move(state)) {}
ShadowSystem::ShadowSystem(ShadowSystem&&) noexcept = default;
ShadowSystem& ShadowSystem::operator=(ShadowSystem&&) noexcept = default;
ShadowSystem::~ShadowSystem() = default;

Result<ShadowSystem> ShadowSystem::create(const DeviceDesc& desc, const StaticSettings& settings) {
  if (auto valid = validate(Settings{.fixed = settings}); !valid) return valid.error();
  auto state = std::make_unique<State>();
  state->settings = settings;
  state->pair_capacity = settings.max_cluster_light_pairs;
  auto device = gpu::Device::create(desc);
  if (!device) return device.error();
  state->device = std::move(*device);
  if (auto ok = state->check_device(); !ok) return ok.error();
  state->memory = std::make_unique<gpu::Memory>(*state->device);
  auto pipelines = gpu::PipelineFactory::create(*state->device, shared::MaxMasks, state->storage_images());
  if (!pipelines) return pipelines.error();
  state->pipelines = std::move(*pipelines);
  auto frame = Frame::create(*state->device, *state->memory, *state->pipelines, settings);
  if (!frame) return frame.error();
  state->frame = std::move(*frame);
  state->slots.resize(settings.frames_in_flight);
  for (FrameSlot& slot : state->slots) {
    auto timers = gpu::FrameTimers::create(*state->device);
    if (!timers) return timers.error();
    slot.timers = std::move(*timers);
  }
  if (auto ok = state->create_host_layout(); !ok) return ok.error();
  if (auto ok = state->create_sets(settings.frames_in_flight); !ok) return ok.error();
  return ShadowSystem(std::move(state));
}

Result<MaskId> ShadowSystem::add_mask(VkImageView view, VkSampler sampler) {
  return state_->frame->scene.add_mask(view, sampler);
}
Result<MeshId> ShadowSystem::add_mesh(const MeshDesc& desc) { return state_->frame->scene.add_mesh(desc); }
Result<InstanceId> ShadowSystem::add_instance(const InstanceDesc& desc) {
  state_->edited = true;
  return state_->frame->scene.add_instance(desc);
}
Result<LightId> ShadowSystem::add_light(const LightDesc& desc) {
  state_->edited = true;
  return state_->frame->scene.add_light(desc);
}
Result<void> ShadowSystem::set_transforms(std::span<const InstanceId> ids, std::span<const Affine> transforms) {
  return state_->frame->scene.set_transforms(ids, transforms);
}
Result<void> ShadowSystem::mark_deformed(std::span<const InstanceId> ids) {
  return state_->frame->scene.mark_deformed(ids);
}
Result<void> ShadowSystem::set_lights(std::span<const LightId> ids, std::span<const LightDesc> descs) {
  return state_->frame->scene.set_lights(ids, descs);
}
Result<void> ShadowSystem::remove(MaskId id) { return state_->frame->scene.remove(id); }
Result<void> ShadowSystem::remove(MeshId id) { return state_->frame->scene.remove(id); }
Result<void> ShadowSystem::remove(InstanceId id) { return state_->frame->scene.remove(id); }
Result<void> ShadowSystem::remove(LightId id) { return state_->frame->scene.remove(id); }

Result<void> ShadowSystem::begin_frame(const FrameDesc& desc) {
  State& s = *state_;
  double cpu_ms = 0;
  {
    Stopwatch watch(cpu_ms);
    if (auto valid = validate(Settings{.fixed = s.settings, .frame = desc.settings}); !valid) return valid.error();
    if (desc.serial <= s.last_serial)
      return invalid("FrameDesc::serial must grow: it is " + std::to_string(desc.serial) + " after " +
                     std::to_string(s.last_serial));
    if (!std::isfinite(desc.time_s)) return invalid("FrameDesc::time_s must be finite");
    if (desc.completed_serial >= desc.serial) return invalid("FrameDesc::completed_serial must be less than serial");
    const auto made = camera_records(desc.cameras);
    if (!made) return made.error();
    const std::span<const shared::CameraRecord> cameras = made->all();
    auto slot = s.free_slot(desc);
    if (!slot) return slot.error();
    s.collect(desc.completed_serial);
    if (auto ok = s.lay_out_maps(desc.settings); !ok) return ok.error();
    if (auto ok = s.reserve(**slot, cameras.back().end_tile, desc); !ok) return ok.error();
    if (auto ok = s.begin_cascades(**slot, cameras.front(), desc); !ok) return ok.error();
    const VkDeviceSize box_bytes = maps::OtherReceivers::staged_bytes(desc.cameras);
    if (auto ok = s.frame->scene.upload((*slot)->uploader, s.retired, desc.serial, box_bytes); !ok) {
      s.frame->cascades.stop();
      return ok.error();
    }

    // Nothing below fails.
    for (gpu::Buffer& buffer : s.outgrown) s.retired.retire(std::move(buffer), desc.serial);
    s.outgrown.clear();
    s.current = *slot;
    s.current->serial = s.last_serial = desc.serial;
    s.next_slot = (s.next_slot + 1) % static_cast<uint32_t>(s.slots.size());
    if (s.edited) s.edit_serial = desc.serial, s.edited = false, s.caster_pairs_known = false;
    s.plan = {.settings = desc.settings,
              .store = s.settings.store,
              .cascades = !s.cascade_lights.empty(),
              .caster_rounds = s.plan_rounds(),
              .consumer_stages = desc.consumer_stages,
              .serial = desc.serial};
    s.plan_cameras(desc.cameras, cameras);
    FrameBlock block{};
    block.record.explicit_bounds = desc.settings.cluster_bounds == ClusterBounds::explicit_bits;
    block.record.marks_blocks = desc.settings.receiver_boxes != ReceiverBoxes::clusters;
    s.fill_block(block, cameras, *s.current);
    std::memset(s.current->statistics.mapped(), 0, sizeof(shared::TapCounts));
    if (s.current->page_requests) std::memset(s.current->page_requests.mapped(), 0, sizeof(shared::SparseRequests));
    s.pages_bound = false;
    s.current->uploader.copy(s.frame->block, 0, &block,
                             offsetof(FrameBlock, other_records) + (cameras.size() - 1) * sizeof(shared::FrameRecord));
    shared::FrameCounters counters{};
    counters.pair_limit = s.plan.caster_rounds * s.caster_pairs_per_round();
    s.current->uploader.copy(s.frame->counters, 0, &counters, sizeof counters);
    s.frame->others.upload(s.current->uploader, desc.cameras);
    if (s.plan.cascades) s.frame->cascades.upload(s.current->uploader);
    s.write_sets(*s.current, desc.cameras);
    s.current->without_map = s.without_map;
  }
  s.current->cpu_record_ms = cpu_ms;
  return {};
}

void ShadowSystem::record_scene(VkCommandBuffer commands) {
  State& s = *state_;
  assert(s.current && "record_scene comes after begin_frame");
  Stopwatch watch(s.current->cpu_record_ms);
  s.current->timers.reset(commands);
  gpu::Recorder recorder = s.recorder(commands, *s.current);
  s.frame->record_scene(recorder, s.plan, s.current->uploader, s.retired);
}

void ShadowSystem::record_shadows(VkCommandBuffer commands) {
  State& s = *state_;
  assert(s.current && "record_shadows comes after record_scene");
  Stopwatch watch(s.current->cpu_record_ms);
  assert((!binds_pages() || s.pages_bound) && "record_shadows comes after bind_pages");
  gpu::Recorder recorder = s.recorder(commands, *s.current);
  if (!binds_pages()) s.frame->record_requests(recorder, s.plan, s.current->page_requests);
  s.frame->record_shadows(recorder, s.plan, s.retired);
  s.frame->record_statistics(recorder, s.current->statistics);
  if (s.plan.cascades) s.frame->cascades.record_statistics(recorder, s.current->cascade_states);
}

bool ShadowSystem::binds_pages() const { return state_->settings.store == Store::hardware_sparse; }

void ShadowSystem::record_requests(VkCommandBuffer commands) {
  State& s = *state_;
  assert(s.current && binds_pages() && "record_requests is for hardware_sparse and comes after record_scene");
  Stopwatch watch(s.current->cpu_record_ms);
  gpu::Recorder recorder = s.recorder(commands, *s.current);
  s.frame->record_requests(recorder, s.plan, s.current->page_requests);
}

Result<void> ShadowSystem::bind_pages(const PageBinding& binding) {
  State& s = *state_;
  if (!binds_pages()) return invalid("bind_pages: only store=hardware_sparse binds pages (ShadowSystem::binds_pages)");
  if (!s.current) return invalid("bind_pages comes after begin_frame and record_requests");
  if (!binding.queue) return invalid("PageBinding::queue is VK_NULL_HANDLE");
  Stopwatch watch(s.current->known.bind_ms);
  if (binding.requests) {
    const VkResult result =
        s.device->vk().vkWaitForFences(s.device->handle(), 1, &binding.requests, VK_TRUE, UINT64_MAX);
    if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkWaitForFences", "PageBinding::requests");
  }
  const auto bound = s.frame->sparse.bind(binding.queue, s.current->page_requests, binding.bound);
  if (!bound) return bound.error();
  s.current->known.bytes_read_back = bound->bytes_read;
  s.current->known.pages_bound = bound->bound;
  s.current->known.pages_unbound = bound->unbound;
  s.pages_bound = true;
  return {};
}

ShaderInterface ShadowSystem::shader_interface(CameraId id) const {
  const auto ids = std::span(state_->plan.camera_ids).first(state_->plan.camera_count);
  const auto found = std::find_if(ids.begin(), ids.end(), [&](CameraId other) { return other.value == id.value; });
  const auto camera = static_cast<uint32_t>(found == ids.end() ? 0 : found - ids.begin());
  return {.frame = state_->frame->frame_record(camera),
          .set = state_->current ? state_->current->host_set : VK_NULL_HANDLE};
}

uint32_t ShadowSystem::shader_store() const { return state_->shader_store(); }
VkDescriptorSetLayout ShadowSystem::descriptor_set_layout() const { return state_->host_layout; }
void ShadowSystem::collect(uint64_t completed_serial) { state_->collect(completed_serial); }
const Statistics& ShadowSystem::statistics() const { return state_->statistics; }
std::span<const LightStatus> ShadowSystem::degraded_lights() const { return state_->degraded; }
Capabilities ShadowSystem::capabilities() const { return state_->device->capabilities(); }

Result<std::vector<std::byte>> ShadowSystem::pipeline_cache() const {
  const gpu::Device& device = *state_->device;
  size_t size = 0;
  VkResult result = device.vk().vkGetPipelineCacheData(device.handle(), device.pipeline_cache(), &size, nullptr);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkGetPipelineCacheData", "");
  std::vector<std::byte> bytes(size);
  result = device.vk().vkGetPipelineCacheData(device.handle(), device.pipeline_cache(), &size, bytes.data());
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkGetPipelineCacheData", "");
  bytes.resize(size);
  return bytes;
}

}  // namespace umbrage
