// The implicit left-balanced 32-way tree over Morton-sorted boxes (O5), rebuilt on the device whenever boxes change.
// Olsson et al. 2014, 5.2.1.
#pragma once
#include "gpu/recorder.hpp"
#include "scene/scene_types.shared.h"

namespace umbrage::scene {

/// Levels and their places for a number of leaves.
shared::TreeShape tree_shape(uint32_t count);

struct TreePipelines {
  static Result<TreePipelines> create(const gpu::PipelineFactory&);
  gpu::Pipeline reduce_bounds, make_keys, sort_count, sort_scan, sort_scatter, build_nodes;
};

class BoxTree {
 public:
  /// Room for this many boxes; contents are lost when it grows. Old buffers go to `retired`.
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint32_t count, std::vector<gpu::Buffer>& retired);
  /// boxes: `count` shared::Box; empty ones sort last and meet nothing. Deterministic: ties keep the order of the boxes.
  void record(gpu::Recorder&, const TreePipelines&, const gpu::Buffer& boxes, uint32_t count);

  const shared::TreeShape& shape() const { return shape_; }
  const gpu::Buffer& order() const { return values_[0]; }  ///< Box index of each leaf.
  const gpu::Buffer& leaves() const { return leaves_; }    ///< Boxes in Morton order.
  const gpu::Buffer& nodes() const { return nodes_; }
  const gpu::Buffer& bounds() const { return bounds_; }  ///< Six ordered_bits of the box around everything.

 private:
  uint32_t capacity_ = 0;
  shared::TreeShape shape_{};
  gpu::Buffer keys_[2], values_[2], counts_, leaves_, nodes_, bounds_;
};

}  // namespace umbrage::scene
