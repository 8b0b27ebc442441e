// umbrage: real-time shadows from hundreds to thousands of lights. Everything a host needs is included here.
#pragma once
#include <vulkan/vulkan_core.h>

#include <memory>
#include <span>
#include <vector>

#include "umbrage/device.hpp"
#include "umbrage/frame.hpp"
#include "umbrage/prepare.hpp"
#include "umbrage/result.hpp"
#include "umbrage/scene.hpp"
#include "umbrage/settings.hpp"
#include "umbrage/stats.hpp"

namespace umbrage {

/// Shadows for one scene on one device. Externally synchronised, like a command pool; systems are independent of each
/// other. A frame is: edits, begin_frame, record_scene, (the host draws depth and normals), record_shadows, (the host shades).
/// Recording happens outside of rendering and clobbers bound pipelines, descriptor sets, push constants and dynamic state.
class ShadowSystem {
 public:
  /// Compiles every pipeline. Errors: unsupported (names feature and device), out_of_memory, vulkan, invalid_argument.
  static Result<ShadowSystem> create(const DeviceDesc&, const StaticSettings&);
  ShadowSystem(ShadowSystem&&) noexcept;
  ShadowSystem& operator=(ShadowSystem&&) noexcept;
  /// The host has waited for every submission that uses the system.
  ~ShadowSystem();

  // Edits take effect in the next begin_frame. On error nothing has changed. Stale ids are refused.

  /// A texture whose alpha cuts casters out. The view (any sampled colour format) and its layout
  /// SHADER_READ_ONLY_OPTIMAL must hold while the mask is used; sampler: VK_NULL_HANDLE = linear, repeat.
  Result<MaskId> add_mask(VkImageView, VkSampler = VK_NULL_HANDLE);
  Result<MeshId> add_mesh(const MeshDesc&);
  Result<InstanceId> add_instance(const InstanceDesc&);
  Result<LightId> add_light(const LightDesc&);
  /// ids.size() == transforms.size().
  Result<void> set_transforms(std::span<const InstanceId> ids, std::span<const Affine> world_from_mesh);
  /// The streams InstanceDesc::deformed of these instances hold new positions in this frame.
  Result<void> mark_deformed(std::span<const InstanceId>);
  Result<void> set_lights(std::span<const LightId>, std::span<const LightDesc>);
  /// A mesh or mask that is in use is refused.
  Result<void> remove(MaskId);
  Result<void> remove(MeshId);
  Result<void> remove(InstanceId);
  Result<void> remove(LightId);

  /// Takes the edits over. Errors leave the frame unbegun and the edits pending.
  Result<void> begin_frame(const FrameDesc&);
  /// Needs no depth buffer: uploads, bounds, hierarchies. May overlap the host's G-buffer. Never fails.
  void record_scene(VkCommandBuffer);
  /// After depth (and normals) are visible to compute shaders: clusters, lights, shadow maps. Never fails.
  void record_shadows(VkCommandBuffer);

  /// Store::hardware_sparse: a host must bind pages between requests and raster. Then record_requests comes before record_shadows,
  /// in a submission of its own, and bind_pages between the two: the only call of the library that waits for the device.
  bool binds_pages() const;
  /// After depth, as record_shadows: clusters, lights, maps, and which of their pages lookups touch. Never fails.
  void record_requests(VkCommandBuffer);
  /// Binds the pages that were asked for and unbinds others. Errors (out_of_memory, device_lost, vulkan, invalid_argument): the frame's
  /// shadows cannot be recorded; begin the next one.
  Result<void> bind_pages(const PageBinding&);
  /// Of a camera of the frame; of the first where none has the id.
  ShaderInterface shader_interface(CameraId) const;
  /// For UMBRAGE_STORE in the shader: which code lookups need.
  uint32_t shader_store() const;
  /// Of shader_interface().set; owned by the system.
  VkDescriptorSetLayout descriptor_set_layout() const;

  /// Takes over what frames up to this serial, all finished by the device, have reported; begin_frame does so too.
  void collect(uint64_t completed_serial);
  /// Of the newest frame with serial <= the completed_serial of begin_frame or collect.
  const Statistics& statistics() const;
  std::span<const LightStatus> degraded_lights() const;
  Capabilities capabilities() const;
  /// For DeviceDesc::pipeline_cache of the next run.
  Result<std::vector<std::byte>> pipeline_cache() const;

 private:
  friend struct SystemAccess;  // the library's own tests
  struct State;
  explicit ShadowSystem(std::unique_ptr<State>);
  std::unique_ptr<State> state_;
};

}  // namespace umbrage
