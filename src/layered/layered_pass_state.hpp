// What a LayeredPass owns, and what prepare() hands to record().
#pragma once
#include <optional>
#include <vector>

#include "layered/layered_pipelines.hpp"
#include "layered/layered_scene_state.hpp"
#include "layered/layered_target_state.hpp"
#include "layered/write_depth.hpp"

namespace umbrage {

struct LayeredPass::State {
  State(LayeredScene::State& in, const LayeredPassSettings& wanted) : scene(in), settings(wanted) {}
  Result<void> check(const Inputs&) const;
  Result<void> reserve();
  void fill_views(const Inputs&);
  void fill_block();
  void select(gpu::Recorder&);
  void draw_groups(gpu::Recorder&, VkCommandBuffer);
  void draw_group(VkCommandBuffer, const layered::ViewGroup&, size_t group, shared::LayeredPush&);
  void begin_rendering(VkCommandBuffer, const layered::ViewGroup&) const;
  void write_depth(gpu::Recorder&, VkCommandBuffer);
  shared::LayeredPush scene_push() const;
  bool uses_draws() const {
    return settings.writer != LayeredWriter::mesh && settings.writer != LayeredWriter::compute;
  }
  bool instance_per_view() const {
    return settings.writer == LayeredWriter::vertex_layer || settings.writer == LayeredWriter::atlas;
  }
  bool culls_by_hardware() const {
    return uses_draws() && settings.writer != LayeredWriter::geometry_invocations &&
           settings.writer != LayeredWriter::geometry_loop;
  }
  VkDeviceSize list_row(size_t group, uint32_t list) const {
    return (VkDeviceSize(group) * list_count + list) * scene.caster_count;
  }

  LayeredScene::State& scene;
  LayeredPassSettings settings;  // its span is not valid after create
  bool is_color = false;
  layered::DeviceLimits limits;
  std::unique_ptr<layered::LayeredPipelines> pipelines;
  std::optional<layered::DepthWriter> depth_writer;
  gpu::Pipeline select_casters;

  // Of the frame being recorded.
  const LayeredTarget::State* target = nullptr;
  std::vector<shared::LayeredViewRecord> views;  // sorted by layer
  std::vector<layered::SplitView> split;
  std::vector<layered::ViewGroup> groups;
  uint32_t list_count = 1;
  bool clear = true;
  VkClearColorValue clear_color{};
  VkDescriptorSet color_set = VK_NULL_HANDLE;
  VkDeviceAddress host_data = 0;

  /// Counts, groups, views and the scene's addresses, staged by the host each frame.
  struct Block {
    VkDeviceSize counts = 0, empty_count = 0, groups = 0, views = 0, scene = 0, bytes = 0;
  } at;
  gpu::Buffer block, visible, draws, listed;
  std::vector<gpu::Buffer> staging;  // a frame in flight
  std::vector<gpu::Buffer> outgrown;
  gpu::RetireQueue retired;
};

}  // namespace umbrage
