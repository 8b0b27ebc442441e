// Cascaded shadow maps that are cached and scrolled ("CSM Scrolling"): C, the static casters' maps, lives from frame to frame; W, with
// the active ones drawn onto it, is what is looked up. Which casters are in which set is decided on the device.
#pragma once
#include "cascades/cascade_planner.hpp"
#include "gpu/uploader.hpp"
#include "scene/gpu_scene.hpp"

namespace umbrage::cascades {

class Cascades {
 public:
  /// Makes the pipelines, before the first begin.
  Result<void> prepare(const gpu::PipelineFactory&);

  struct FrameInputs {
    const shared::CameraRecord& camera;
    std::span<const CascadeLight> lights;  ///< The first MaxCascades / count of them have cascades.
    CascadeSettings settings;
    double time_s = 0;   ///< The host's clock; stillness is measured with it. What runs backwards counts as standing.
    bool fresh = false;  ///< Every map is drawn anew from everything in its volume: what each mode must come to.
  };
  /// Plans the frame and makes room for it. After an error the next frame draws every map anew. Errors: invalid_argument, out_of_memory.
  Result<void> begin(const gpu::Device&, gpu::Memory&, const scene::GpuScene&, const FrameInputs&,
                     std::vector<gpu::Buffer>& retired);
  void upload(gpu::Uploader&) const;

  struct Inputs {
    const scene::GpuScene& scene;
    const gpu::Buffer& frame;  ///< Holds the caster tree's shape.
    VkDeviceAddress tree_shape;
    const gpu::Buffer& counters;  ///< FrameCounters.
    uint64_t serial;
  };
  /// All passes, from what moved to finished maps.
  void record(gpu::Recorder&, const Inputs&, gpu::RetireQueue&);
  /// Copies the states to a buffer that the host reads.
  void record_statistics(gpu::Recorder&, const gpu::Buffer& target) const;
  /// A frame that has begun without them, or will not be recorded: what is known of casters and maps goes stale.
  void stop() { is_recorded_ = false; }

  /// shared::CascadeTable of the frame, and what it points to.
  const gpu::Buffer& table() const { return table_buffer_; }
  const gpu::Buffer& states() const { return states_; }
  const gpu::Buffer& maps() const { return maps_; }
  /// What lookups read.
  std::array<const gpu::Buffer*, 3> published() const { return {&table_buffer_, &states_, &maps_}; }
  const shared::CascadeTable& planned() const { return table_; }
  VkDeviceSize map_bytes() const { return maps_.size(); }

 private:
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint32_t casters, std::vector<gpu::Buffer>& retired);
  void tick(double time_s);
  void record_moved(gpu::Recorder&, const Inputs&, shared::CascadePush&);
  void record_scroll(gpu::Recorder&, shared::CascadePush&);
  void record_lists(gpu::Recorder&, const Inputs&);
  void record_draws(gpu::Recorder&, const Inputs&, shared::CascadePush&, bool actives);
  void record_plan_draws(gpu::Recorder&, shared::CascadePush&, uint32_t step);
  void clear_cells(gpu::Recorder&);
  void write_maps(gpu::Pass&) const;
  uint32_t row_groups() const;

  gpu::Pipeline note_, plan_, scroll_, list_, plan_draws_, draw_[2], draw_large_[2], compose_;  // [masked]
  CascadePlanner planner_;
  shared::CascadeTable table_{};
  gpu::Buffer table_buffer_, states_, arguments_, maps_, farthest_, items_, larges_;
  gpu::GrownBuffer moved_at_, known_boxes_;
  uint32_t item_capacity_ = 0, most_side_ = 0;
  double first_time_s_ = 0;
  bool is_recorded_ = false;  ///< The frame before: its casters and maps are known.
  bool begins_ = true, states_are_new_ = true;
};

}  // namespace umbrage::cascades
