// The scene on both sides: ids and records on the host, the same records on the device. Edits are collected and travel once
// a frame; world boxes are recomputed for what moved, and the trees over casters and lights follow.
#pragma once
#include <span>
#include <vector>

#include "core/id_pool.hpp"
#include "core/range_pool.hpp"
#include "gpu/uploader.hpp"
#include "scene/box_tree.hpp"
#include "umbrage/prepare.hpp"
#include "umbrage/scene.hpp"

namespace umbrage::scene {

struct ScenePipelines {
  static Result<ScenePipelines> create(const gpu::PipelineFactory&);
  TreePipelines tree;
  gpu::Pipeline bound_batches, bound_lights;
};

/// A light's record and what of it only the host needs.
struct HostLight {
  LightDesc desc;
  shared::LightRecord record{};
  bool has_cascades = false;
  /// In the store.
  bool needs_map() const { return desc.casts_shadow && !has_cascades; }
};

class GpuScene {
 public:
  GpuScene(const gpu::Device& device, gpu::Memory& memory, const StaticSettings& settings)
      : device_(device), memory_(memory), settings_(settings) {}

  // Edits, as in ShadowSystem.
  Result<MaskId> add_mask(VkImageView, VkSampler);
  Result<MeshId> add_mesh(const MeshDesc&);
  Result<InstanceId> add_instance(const InstanceDesc&);
  Result<LightId> add_light(const LightDesc&);
  Result<void> set_transforms(std::span<const InstanceId>, std::span<const Affine>);
  Result<void> mark_deformed(std::span<const InstanceId>);
  Result<void> set_lights(std::span<const LightId>, std::span<const LightDesc>);
  Result<void> remove(MaskId);
  Result<void> remove(MeshId);
  Result<void> remove(InstanceId);
  Result<void> remove(LightId);

  /// Lights in slot order; the store lays out their maps in the records before upload().
  IdPool<HostLight>& lights() { return lights_; }
  void light_changed(uint32_t slot);
  /// True if lights came, went or changed since the last upload.
  bool lights_edited() const { return lights_edited_; }

  /// Sizes buffers and stages the edits for the frame; the uploader has room for so many bytes more. On error the edits
  /// stay pending.
  Result<void> upload(gpu::Uploader&, gpu::RetireQueue&, uint64_t serial, VkDeviceSize bytes_beside = 0);
  /// Copies, boxes of what moved; trees when something did.
  void record(gpu::Recorder&, const ScenePipelines&, gpu::Uploader&, gpu::RetireQueue&, uint64_t serial);

  struct MaskEntry { VkImageView view; VkSampler sampler; uint32_t users = 0; };
  IdPool<MaskEntry>& masks() { return masks_; }
  /// Frames up to this serial have finished: descriptors of masks removed before them may be written again.
  void collect(uint64_t completed_serial);
  /// Slots whose descriptor must be written; cleared by the caller.
  std::vector<uint32_t>& new_masks() { return new_masks_; }

  uint32_t light_slots() const { return lights_.slots(); }
  uint32_t caster_slots() const { return caster_ranges_.size(); }
  uint32_t casters() const { return caster_count_; }
  uint32_t light_count() const { return lights_.count(); }
  uint32_t directional_lights() const { return directional_count_; }
  bool has_masked() const { return masked_batches_ > 0; }
  const gpu::Buffer& light_buffer() const { return light_buffer_.buffer(); }
  const gpu::Buffer& instance_buffer() const { return instance_buffer_.buffer(); }
  const gpu::Buffer& batch_buffer() const { return batch_buffer_.buffer(); }
  const gpu::Buffer& caster_buffer() const { return caster_buffer_.buffer(); }
  const gpu::Buffer& index_buffer() const { return index_buffer_.buffer(); }
  const gpu::Buffer& caster_boxes() const { return caster_boxes_.buffer(); }
  /// Casters that came, went, moved or deformed with the last upload(): their numbers, in staging memory of that frame.
  VkDeviceAddress moved_casters() const { return moved_address_; }
  uint32_t moved_caster_count() const { return moved_count_; }
  /// Slots of the lights alive: directional ones first, then by priority.
  const gpu::Buffer& light_order_buffer() const { return light_order_buffer_.buffer(); }
  const BoxTree& caster_tree() const { return caster_tree_; }
  const BoxTree& light_tree() const { return light_tree_; }

 private:
  struct Mesh {
    std::vector<Vec3> positions;          // until uploaded
    std::vector<Vec2> uvs;
    std::vector<uint32_t> indices;        // in batch order, until uploaded
    std::vector<shared::BatchRecord> batches;
    std::vector<MaskId> masks;
    Stream device_positions, device_uvs;
    std::unique_ptr<gpu::Buffer> position_buffer, uv_buffer;  // stable while a frame is recorded
    Aabb bounds;                          // of all levels
    uint32_t vertex_count = 0, first_batch = 0, first_index = 0, index_count = 0, instances = 0;
    bool masked = false;
  };
  struct Instance {
    InstanceDesc desc;
    shared::InstanceRecord record{};
    uint32_t first_caster = 0, caster_count = 0;
    bool moved = false;                   // in moved_
  };

  Result<void> check(const LightDesc&) const;
  void fill(HostLight&);
  Result<void> make_batches(const MeshDesc&, const PreparedMesh&, Mesh&) const;
  void fill(Instance&, const Mesh&) const;
  void mark_moved(uint32_t slot);
  Result<void> ensure_buffers();
  VkDeviceSize staged_bytes() const;
  void stage_meshes(gpu::Uploader&);
  void stage_records(gpu::Uploader&);
  void stage_moved(gpu::Uploader&);

  const gpu::Device& device_;
  gpu::Memory& memory_;
  StaticSettings settings_;
  IdPool<MaskEntry> masks_;
  IdPool<Mesh> meshes_;
  IdPool<Instance> instances_;
  IdPool<HostLight> lights_;
  RangePool batch_ranges_, index_ranges_, caster_ranges_;
  uint32_t caster_count_ = 0, masked_batches_ = 0, directional_count_ = 0;

  // Pending edits.
  std::vector<uint32_t> new_meshes_, new_masks_, dirty_instances_, dirty_lights_, moved_;
  std::vector<shared::CasterRecord> casters_;           // host mirror
  std::vector<std::pair<uint32_t, uint32_t>> dirty_casters_;  // first, count
  std::vector<std::unique_ptr<gpu::Buffer>> removed_buffers_;
  struct RemovedMask { uint32_t slot; uint64_t serial; };  // of the first frame without it; 0: not begun yet
  std::vector<RemovedMask> removed_masks_;
  std::vector<gpu::Buffer> outgrown_;
  bool lights_edited_ = true;

  // Of the frame being recorded.
  std::vector<const gpu::Buffer*> new_geometry_;
  VkDeviceAddress moved_address_ = 0;
  uint32_t moved_count_ = 0;
  bool lights_changed_ = false, has_trees_ = false;

  gpu::GrownBuffer light_buffer_, instance_buffer_, batch_buffer_, caster_buffer_, index_buffer_, caster_boxes_, light_order_buffer_;
  gpu::Buffer light_boxes_;
  BoxTree caster_tree_, light_tree_;
};

}  // namespace umbrage::scene
