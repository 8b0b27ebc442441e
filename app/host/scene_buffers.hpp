// The scene's vertex streams, indices and materials on the device, and the list of what its nodes draw.
#pragma once
#include <vector>

#include "host/textures.hpp"

namespace app {

/// A primitive on the device. Addresses are 0 where the scene has no such stream.
struct UploadedPrimitive {
  uint32_t vertex_count = 0, index_count = 0, first_index = 0, target_count = 0;
  VkDeviceAddress positions = 0, normals = 0;              ///< vec3
  VkDeviceAddress joints = 0, joint_weights = 0;           ///< 4 x 16 bit, vec4
  VkDeviceAddress morph_positions = 0, morph_normals = 0;  ///< vec3[target_count][vertex_count]
  uint32_t material = 0;
  uint32_t reads = 0;               ///< ReadsBaseColorTexture …
  glm::vec3 lowest{0}, highest{0};  ///< Mesh space.
};

class SceneBuffers {
 public:
  static umbrage::Result<SceneBuffers> create(GpuContext&, const Scene&, const TextureTable&);
  const std::vector<UploadedPrimitive>& primitives() const { return primitives_; }
  /// Index of a mesh's first primitive; the others follow.
  uint32_t first_primitive(uint32_t mesh) const { return first_primitive_[mesh]; }
  VkDeviceAddress primitive_table() const { return primitive_table_.address(); }
  VkDeviceAddress material_table() const { return material_table_.address(); }
  VkBuffer indices() const { return indices_.get(); }

 private:
  umbrage::Result<void> upload_streams(GpuContext&, const Scene&);
  umbrage::Result<void> upload_materials(GpuContext&, const Scene&, const TextureTable&);

  std::vector<UploadedPrimitive> primitives_;
  std::vector<uint32_t> first_primitive_;
  DeviceBuffer streams_, indices_, primitive_table_, material_table_;
};

/// One primitive of one posed instance: what is drawn and what casts.
struct SceneItem {
  uint32_t instance = 0;                       ///< Into Pose::instances.
  uint32_t primitive = 0;                      ///< Into SceneBuffers::primitives().
  bool moving = false;                         ///< Its transform may differ between frames.
  bool deformed = false;                       ///< Its streams are its own, written each frame that changes them.
  VkDeviceAddress positions = 0, normals = 0;  ///< As drawn.
};

/// All items that have triangles, by instance.
std::vector<SceneItem> list_items(const Scene&, const Pose&, const SceneBuffers&);

}  // namespace app
