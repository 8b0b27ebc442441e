// What a LayeredScene owns: device objects, geometry in one buffer, what may move in another.
#pragma once
#include <array>
#include <vector>

#include "gpu/uploader.hpp"
#include "layered/layered_types.shared.h"
#include "umbrage/layered_scene.hpp"

namespace umbrage {

/// A part of the geometry buffer.
struct LayeredSection {
  VkDeviceSize offset = 0, bytes = 0;
};

struct LayeredScene::State {
  /// Host-side arrays on their way to the device.
  struct Geometry {
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::vector<shared::LayeredSkinRecord> skins;
    std::vector<uint32_t> indices, batch_vertices, batch_triangles;
    std::vector<shared::LayeredBatch> batches;
    std::vector<shared::LayeredCaster> casters;
  };
  struct MeshRange {
    uint32_t first_batch = 0, batch_count = 0;
    bool is_skinned = false;
    uint32_t bones = 0;  // that its skin names, from 0 on
  };
  struct FrameSlot {
    gpu::Uploader uploader;
  };

  ~State();
  Result<void> add_mesh(const LayeredMesh&, size_t index, uint32_t mask_count, Geometry&);
  Result<void> add_instance(const LayeredInstance&, size_t index, Geometry&);
  Result<void> create_buffers(const Geometry&);
  Result<void> create_masks(std::span<const LayeredMask>);
  gpu::Recorder recorder(VkCommandBuffer commands) const {
    return {*device, *factory, commands, nullptr, frame_set, mask_set, nullptr};
  }
  VkDeviceAddress address(const LayeredSection& section) const {
    return section.bytes ? geometry.address() + section.offset : 0;
  }

  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  std::string device_name;
  std::unique_ptr<gpu::Device> device;
  std::unique_ptr<gpu::Memory> memory;
  std::unique_ptr<gpu::PipelineFactory> factory;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
  VkDescriptorSet frame_set = VK_NULL_HANDLE, mask_set = VK_NULL_HANDLE;

  gpu::Buffer geometry, staging, moving;
  LayeredSection positions, normals, uvs, skins, indices, batch_vertices, batch_triangles, batches, casters;
  VkDeviceSize bones_offset = 0;  ///< In `moving`, behind the instances.
  std::vector<MeshRange> meshes;
  std::vector<shared::LayeredInstanceRecord> instances;
  std::vector<uint32_t> bone_counts;
  std::vector<shared::vec4> bones;  ///< Three rows each.
  std::vector<FrameSlot> slots;
  uint32_t slot = 0;
  uint64_t serial = 0;
  uint64_t uploaded_in = 0;  ///< The frame that uploads the geometry; staging lives until it has retired.
  uint32_t caster_count = 0;
  uint64_t triangles = 0;
  bool has_masked = false, has_mirrored = false, has_moved = true;
};

}  // namespace umbrage
