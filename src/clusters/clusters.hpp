// Clustered light assignment: occupied clusters with their bounds, and the lights of each (O1, O9).
#pragma once
#include "clusters/camera.hpp"
#include "clusters/cluster_push.shared.h"
#include "gpu/prefix_sum.hpp"
#include "scene/gpu_scene.hpp"
#include "umbrage/settings.hpp"

namespace umbrage::clusters {

/// A camera as the passes that read its images take it.
struct FrameCamera {
  VkDeviceAddress record = 0;               ///< shared::CameraRecord
  VkDescriptorSet images = VK_NULL_HANDLE;  ///< Descriptor set 0, with its depth and normals.
  glm::uvec2 tiles{0};
  NormalEncoding normal_encoding = NormalEncoding::none;
};

class Clusters {
 public:
  static Result<Clusters> create(const gpu::PipelineFactory&);
  /// Buffers for pictures of so many tiles in all and lists of so many pairs.
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint32_t tile_count, uint32_t pair_capacity,
                       uint32_t light_slots, std::vector<gpu::Buffer>& retired);
  /// Puts its addresses and capacities into the frame's record.
  void fill(shared::FrameRecord&) const;
  /// Depth (and normals) of each camera → clusters. `frame` and `counters` as in FrameRecord.
  void record_clusters(gpu::Recorder&, const gpu::Buffer& frame, const gpu::Buffer& counters,
                       std::span<const FrameCamera>);
  /// Clusters → light lists, and which lights are used.
  void record_lights(gpu::Recorder&, const gpu::Buffer& frame, const gpu::Buffer& counters, const scene::GpuScene&,
                     VkDeviceAddress tree_shape, LightAssignment);
  const gpu::Buffer& used_lights() const { return used_; }
  const gpu::Buffer& words() const { return words_; }
  const gpu::Buffer& boxes() const { return boxes_; }
  const gpu::Buffer& cones() const { return cones_; }
  const gpu::Buffer& cells() const { return cells_; }
  const gpu::Buffer& lists() const { return lists_; }
  const gpu::Buffer& lights() const { return lights_; }
  /// The cluster of each entry of lights(); NoIndex where a list found no room.
  const gpu::Buffer& pair_clusters() const { return pair_clusters_; }
  uint32_t pair_capacity() const { return pair_capacity_; }
  /// What a lookup reads.
  std::array<const gpu::Buffer*, 6> published() const {
    return {&words_, &cells_, &boxes_, &cones_, &lists_, &lights_};
  }

 private:
  uint32_t cluster_capacity_ = 0, pair_capacity_ = 0, light_slots_ = 0;
  gpu::Pipeline assign_, count_, compact_, count_lights_[2], write_lights_[2];
  gpu::PrefixSum scan_;
  gpu::Buffer words_, found_, tile_counts_, cells_, boxes_, cones_, counts_, lists_, lights_, pair_clusters_, used_;
};

}  // namespace umbrage::clusters
