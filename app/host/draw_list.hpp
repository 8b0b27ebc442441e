// Instances as the vertex shader reads them and the indirect draws of those that the camera can see, nearest first.
#pragma once
#include <tuple>

#include "host/bounding_parts.hpp"
#include "host/frame_data.hpp"
#include "host/shaders/host.shared.h"

namespace app {

/// Draws that share pipeline and fixed state.
struct DrawRange {
  bool masked = false, double_sided = false, mirrored = false;
  uint32_t reads = 0;  ///< ReadsBaseColorTexture …
  uint32_t first_instance = 0, instance_count = 0;
  uint32_t first_command = 0, command_count = 0;  ///< Of those in view.
};

/// One blended item.
struct BlendedDraw {
  uint32_t instance = 0;  ///< Into the instance table.
  uint32_t index_count = 0, first_index = 0;
  bool double_sided = false, mirrored = false;
  glm::vec3 center{0};  ///< World.
};

class DrawList {
 public:
  static umbrage::Result<DrawList> create(const GpuContext&, const Scene&, const SceneBuffers&, const Pose&,
                                          std::span<const SceneItem>);
  /// Takes over the transforms of what moves. No submission that reads the list is under way.
  void update(const Pose&, std::span<const SceneItem>);
  /// Lists the opaque and masked draws whose boxes a camera's frustum meets, those of a range from near to far, and finds
  /// the blended surfaces in it.
  void select(const CameraMatrices&);
  /// Opaque and masked items, a multi-draw for each range.
  std::span<const DrawRange> ranges() const { return ranges_; }
  VkBuffer commands() const { return commands_.get(); }
  /// Blended items, unsorted.
  std::span<const BlendedDraw> blended() const { return blended_; }
  /// Where blended surfaces are that the camera may see.
  OtherReceivers blended_places() const { return {blended_in_view_, blended_boxes_}; }
  VkDeviceAddress instances() const { return instances_.address(); }

 private:
  struct Entry {
    uint32_t item = 0, primitive = 0, index_count = 0, first_index = 0, reads = 0;
    AlphaMode alpha = AlphaMode::opaque;
    bool double_sided = false, mirrored = false, moving = false;
    bool unbounded = false;  ///< Deformed: its box is not known.
    glm::vec3 mesh_center{0}, mesh_half_size{0};
    glm::vec3 center{0}, half_size{0};  ///< World.
    uint32_t parts = 0;                 ///< Blended: into parts_.
    glm::mat4 world_from_mesh{1};       ///< Likewise.
    auto order() const {
      return std::tuple(alpha == AlphaMode::blend, alpha, double_sided, mirrored, reads, primitive, item);
    }
  };
  void build(const Pose&, std::span<const SceneItem>);
  void append(uint32_t place);
  void find_blended(const CameraMatrices&);
  void write_instance(uint32_t place, const Pose&, std::span<const SceneItem>);

  std::vector<Entry> entries_;  ///< In the order of the instance table.
  DeviceBuffer instances_, commands_;
  std::vector<VkDrawIndexedIndirectCommand> draws_;
  std::vector<std::pair<float, uint32_t>> nearest_;  ///< Depth and place, of a range.
  std::vector<DrawRange> ranges_;
  std::vector<BlendedDraw> blended_;
  std::vector<std::vector<MeshBox>> parts_;  ///< Of blended items.
  std::vector<umbrage::Aabb> blended_boxes_;
  bool blended_in_view_ = false;
};

}  // namespace app
