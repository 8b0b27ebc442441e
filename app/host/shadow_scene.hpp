// The host's scene handed to umbrage: meshes, masks, instances, lights, and what changes of them from frame to frame.
#pragma once
#include "host/frame_data.hpp"
#include "import/batch_cache.hpp"

namespace app {

class ShadowScene {
 public:
  static umbrage::Result<std::unique_ptr<ShadowScene>> create(const GpuContext&, const umbrage::StaticSettings&);
  struct Source {
    const Scene& scene;
    const Pose& pose;
    const SceneBuffers& buffers;
    const TextureTable& textures;
    std::span<const SceneItem> items;
  };
  /// Once: one umbrage mesh per primitive that casts; blended primitives cast nothing.
  umbrage::Result<void> add_scene(const Source&, const std::string& batch_cache_dir, uint32_t batch_triangles);
  umbrage::ShadowSystem& system() { return system_; }
  const umbrage::ShadowSystem& system() const { return system_; }
  /// Moves what moved; deformed: items whose streams this frame writes anew.
  umbrage::Result<void> update(const Pose&, std::span<const SceneItem>, std::span<const uint32_t> deformed);
  /// Makes umbrage's lights equal to these; host_index = index.
  umbrage::Result<void> set_lights(std::span<const ActiveLight>);

 private:
  explicit ShadowScene(umbrage::ShadowSystem system) : system_(std::move(system)) {}
  umbrage::Result<umbrage::MeshId> add_mesh(const Source&, const Primitive&, const UploadedPrimitive&, BatchCache&,
                                            const umbrage::PrepareSettings&, bool has_levels);
  umbrage::Result<umbrage::MaskId> mask_of(const Texture&, const TextureTable&);
  umbrage::Result<void> add_instance(const SceneItem&, umbrage::MeshId, const Pose&);

  umbrage::ShadowSystem system_;
  std::vector<umbrage::MaskId> masks_;          ///< By texture slot; 0 = not added yet.
  std::vector<umbrage::InstanceId> instances_;  ///< By item; 0 = casts nothing.
  std::vector<umbrage::LightId> lights_;
  std::vector<umbrage::LightDesc> light_descs_;  ///< As umbrage has them.
  // Kept to save allocations from frame to frame.
  std::vector<umbrage::InstanceId> changed_instances_;
  std::vector<umbrage::Affine> changed_transforms_;
  std::vector<glm::mat4> transforms_;  ///< By item, as umbrage has them.
};

}  // namespace app
