// What a layered pass draws: meshes in batches, instances of them, masks. Part of layered_pass.hpp.
#pragma once
#include <vulkan/vulkan_core.h>

#include <memory>
#include <span>

#include "umbrage/device.hpp"
#include "umbrage/result.hpp"
#include "umbrage/scene.hpp"

namespace umbrage {

/// A vertex's bones (255: none) and weights, which sum to 1.
struct LayeredSkin {
  uint8_t bones[4] = {255, 255, 255, 255};
  float weights[4] = {0, 0, 0, 0};
};

/// Spans are read during create. Normals and uvs are empty or one a position.
struct LayeredMesh {
  std::span<const Vec3> positions;
  std::span<const uint32_t> indices;  ///< Triangle list.
  std::span<const Vec3> normals;      ///< For colour passes.
  std::span<const Vec2> uvs;          ///< For masks and colour passes.
  std::span<const LayeredSkin> skin;
  std::span<const Submesh> submeshes;   ///< Submesh::mask: MaskId{1 + index into LayeredSceneDesc::masks}; 0: opaque.
  std::span<const std::byte> prepared;  ///< From prepare_mesh with default settings; empty: prepared here.
};
struct LayeredInstance {
  uint32_t mesh = 0;  ///< Index into LayeredSceneDesc::meshes.
  Affine world_from_mesh;
  uint32_t bones = 0;       ///< Bones it has of its own, 0…255; 0: rigid.
  uint32_t host_index = 0;  ///< Handed to the fragment shader of colour passes.
};
struct LayeredMask {
  VkImageView view = VK_NULL_HANDLE;   ///< SHADER_READ_ONLY_OPTIMAL while the scene lives; its alpha cuts.
  VkSampler sampler = VK_NULL_HANDLE;  ///< VK_NULL_HANDLE: linear, repeat.
};
struct LayeredSceneDesc {
  std::span<const LayeredMesh> meshes;
  std::span<const LayeredInstance> instances;
  std::span<const LayeredMask> masks;
  uint32_t frames_in_flight = 2;  ///< 1…4.
};

/// Geometry on the device: fixed meshes and instances, transforms and bones that may change every frame.
class LayeredScene {
 public:
  static Result<LayeredScene> create(const DeviceDesc&, const LayeredSceneDesc&);
  LayeredScene(LayeredScene&&) noexcept;
  LayeredScene& operator=(LayeredScene&&) noexcept;
  ~LayeredScene();
  Result<void> set_transform(uint32_t instance, const Affine& world_from_mesh);
  /// As many bones as the instance has: instance space (before world_from_mesh) from bind space.
  Result<void> set_bones(uint32_t instance, std::span<const Affine>);
  /// serial grows by frame; frame `serial - frames_in_flight` has completed.
  Result<void> begin_frame(uint64_t serial);
  /// Uploads. Before the frame's passes are recorded; outside of rendering.
  void record(VkCommandBuffer);
  uint32_t batch_count() const;     ///< Of all instances.
  uint64_t triangle_count() const;  ///< Likewise.
  struct State;

 private:
  friend class LayeredTarget;
  friend class LayeredPass;
  explicit LayeredScene(std::unique_ptr<State>);
  std::unique_ptr<State> state_;
};

}  // namespace umbrage
