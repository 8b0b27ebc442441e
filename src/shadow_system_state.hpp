// What a ShadowSystem owns. Apart from the public class so that tests can look inside.
#pragma once
#include <array>
#include <chrono>
#include <vector>

#include "frame.hpp"
#include "gpu/timers.hpp"
#include "umbrage/umbrage.hpp"

namespace umbrage {

/// What a frame in flight has for its own.
struct FrameSlot {
  gpu::Uploader uploader;
  gpu::FrameTimers timers;
  gpu::Buffer statistics;                   // readback: FrameReport, then a word a light slot
  gpu::Buffer cascade_states;               // readback, with cascades: CascadeState each
  std::vector<CascadeStatistics> cascades;  // what the host knew of them
  gpu::Buffer page_requests;                // readback, hardware sparse: SparseRequests, then pages
  std::array<VkDescriptorSet, shared::MaxCameras> frame_sets{};  // the first also names the store's images
  VkDescriptorSet host_set = VK_NULL_HANDLE;
  uint64_t serial = 0;  // 0: never used
  uint32_t light_slots = 0;
  double cpu_record_ms = 0;
  Statistics known;  // what the host knew when it recorded
  std::vector<LightStatus> without_map;
};

/// Of a frame's cameras, their tiles numbered on.
struct CameraRecords {
  std::array<shared::CameraRecord, shared::MaxCameras> records;
  uint32_t count = 0;
  std::span<const shared::CameraRecord> all() const { return {records.data(), count}; }
};
/// Errors: invalid_argument.
Result<CameraRecords> camera_records(std::span<const CameraDesc>);
/// Directional lights that can have cascades.
uint32_t most_cascade_lights(const FrameSettings&);

struct ShadowSystem::State {
  static constexpr uint32_t kMaxRounds = 128;
  static constexpr uint64_t kMaxGrownPairs = 1u << 19;  // 80 MB; more pairs take more rounds

  static constexpr uint64_t kMaxGridBytes = 64u << 20;  // of farthest receivers; beyond it their grids are coarser
  static constexpr uint32_t kExpectedSunMaps = 16;  // levels of a directional light, before any frame has counted them
  static constexpr uint32_t kMaxLargeTriangles =
      1u << 19;  // queued at once, 380 bytes each; more are drawn by a thread each

  ~State();
  /// What the settings' store needs of the device.
  Result<void> check_device() const;
  Result<void> create_sets(uint32_t frames_in_flight);
  Result<void> create_host_layout();
  Result<FrameSlot*> free_slot(const FrameDesc&);
  void collect(uint64_t completed_serial);
  void read_statistics(const FrameSlot&);
  void read_map_statistics(const shared::FrameReport&);
  Result<void> lay_out_maps(const FrameSettings&);
  void choose_cascade_lights(const FrameSettings&);
  Result<void> begin_cascades(FrameSlot&, const shared::CameraRecord&, const FrameDesc&);
  void read_cascade_statistics(const FrameSlot&);
  Result<void> reserve(FrameSlot&, uint32_t tile_count, const FrameDesc&);
  Result<void> reserve_fixed_cubes(const FrameDesc&);
  Result<void> reserve_virtual_maps(const FrameDesc&);
  Result<void> reserve_page_pool(const FrameDesc&);
  Result<void> reserve_physical_pool(const FrameDesc&);
  Result<void> reserve_sparse(FrameSlot&, const FrameDesc&);
  void lay_out_images(const FrameSettings&, std::vector<uint32_t>& changed);
  uint32_t shader_store() const;
  bool has_virtual_maps() const { return settings.store != Store::fixed_cubes; }
  uint64_t texel_bytes() const;
  /// Of the device memory in use, what does not hold shadow texels.
  uint64_t bytes_beside(uint64_t shadow_bytes) const;
  /// Descriptors of images that shaders write.
  uint32_t storage_images() const { return settings.store == Store::hardware_sparse ? shared::MaxMapImages : 0; }
  uint64_t budget_bytes() const { return uint64_t(settings.budget_mib) << 20; }
  uint64_t most_caster_pairs() const;
  uint32_t caster_capacity() const;
  uint32_t caster_pairs_per_round() const;
  uint64_t bytes_a_caster_pair() const;
  uint32_t plan_rounds();
  void plan_cameras(std::span<const CameraDesc>, std::span<const shared::CameraRecord>);
  void write_sets(FrameSlot&, std::span<const CameraDesc>);
  void fill_block(FrameBlock&, std::span<const shared::CameraRecord>, const FrameSlot&) const;
  gpu::Recorder recorder(VkCommandBuffer, FrameSlot&);

  StaticSettings settings;
  std::unique_ptr<gpu::Device> device;
  std::unique_ptr<gpu::Memory> memory;
  std::unique_ptr<gpu::PipelineFactory> pipelines;
  gpu::RetireQueue retired;
  std::unique_ptr<Frame> frame;
  VkDescriptorSetLayout host_layout = VK_NULL_HANDLE;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkSampler mask_sampler = VK_NULL_HANDLE;
  VkDescriptorSet mask_set = VK_NULL_HANDLE;
  std::vector<FrameSlot> slots;
  uint32_t next_slot = 0;
  FrameSlot* current = nullptr;  // being recorded
  FramePlan plan;
  store::AtlasLayout layout;            // fixed cubes
  uint32_t large_triangles = 1u << 17;  // page pool: room in the queue, grown from what frames report
  uint32_t views = 0;                   // of all lights
  store::ImageLayout image_layout;      // physical pool
  store::SparseLayout sparse_layout;
  bool pages_bound = false;                // in the frame that is recorded
  maps::Maps::Sizes map_sizes;             // virtual shadow maps: grown from what frames report
  std::array<uint32_t, 3> laid_out_for{};  // min and max resolution; lights with cascades at most
  std::vector<cascades::CascadeLight> cascade_lights;
  std::vector<LightStatus> without_map;
  std::vector<gpu::Buffer> outgrown;
  uint64_t last_serial = 0;
  uint32_t pair_capacity = 0;       // cluster/light pairs, grown from what frames report
  uint64_t caster_pairs_seen = 0;   // most of any frame since the newest edit
  bool caster_pairs_known = false;  // and there has been one
  uint64_t edit_serial = 0;         // first frame that holds the newest edits
  bool edited = true;

  Statistics statistics;
  std::array<PassTime, gpu::FrameTimers::kMaxScopes> pass_times{};
  std::vector<LightStatus> degraded;
  std::vector<CascadeStatistics> cascade_statistics;
  gpu::HazardLog* hazard_log = nullptr;
};

/// A way in for tests and oracles.
struct SystemAccess {
  static ShadowSystem::State& state(ShadowSystem& system) { return *system.state_; }
};

}  // namespace umbrage
