// Morph targets and skins on the GPU, into streams of each instance's own.
#pragma once
#include "host/pipelines.hpp"
#include "host/scene_buffers.hpp"
#include "host/shaders/host.shared.h"

namespace app {

class Deformer {
 public:
  /// Gives the deformed items their own streams (SceneItem::positions, normals).
  static umbrage::Result<Deformer> create(const GpuContext&, VkPipelineLayout, const Pose&, const SceneBuffers&,
                                          std::span<SceneItem>);
  /// Takes over the pose's weights and joints. Returns the items (indices) whose streams record() will write.
  std::span<const uint32_t> update(const Pose&, std::span<const SceneItem>);
  /// Writes the streams that update() named; they are visible to every shader afterwards.
  void record(const GpuContext&, VkCommandBuffer, VkPipelineLayout);

 private:
  struct Job {
    uint32_t item = 0;
    gpu::DeformPush push{};
    size_t joints_at = 0, joint_count = 0;    ///< Into inputs_, in bytes; matrices.
    size_t weights_at = 0, weight_count = 0;  ///< Likewise; floats.
    bool pending = true;                      ///< Its streams do not hold inputs_ yet.
  };
  umbrage::Result<void> create_buffers(const GpuContext&, const Pose&, const SceneBuffers&, std::span<SceneItem>);

  Handle<VkPipeline> pipeline_;
  DeviceBuffer streams_, inputs_;
  std::vector<Job> jobs_;
  std::vector<uint32_t> changed_items_;
  std::vector<std::byte> last_inputs_;  ///< What inputs_ holds, to see what changes.
};

}  // namespace app
