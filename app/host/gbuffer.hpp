// The G-buffer pass: depth, normals and materials of opaque and masked surfaces.
#pragma once
#include "host/draw_list.hpp"
#include "host/pipelines.hpp"
#include "host/targets.hpp"

namespace app {

/// What every pass binds and pushes.
struct PassContext {
  const GpuContext& gpu;
  VkCommandBuffer commands;
  VkPipelineLayout layout;
  Targets& targets;
  gpu::FramePush push;
};

class GBufferPass {
 public:
  static umbrage::Result<GBufferPass> create(const GpuContext&, VkPipelineLayout, const Targets&);
  /// Afterwards depth is depth_read and the others are sampled: visible to compute shaders.
  void record(PassContext&, const DrawList&, VkBuffer indices) const;

 private:
  Handle<VkPipeline> opaque_, masked_;
};

/// The vertex stage of every surface.
Spirv transform_vertices_spirv();
/// Cull mode and front face. glTF winds front faces counter-clockwise, mirrored instances the other way.
void set_sides(const PassContext&, VkCullModeFlags, bool mirrored);

}  // namespace app
