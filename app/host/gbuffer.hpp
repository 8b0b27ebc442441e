// The G-buffer pass: depth, normals and materials of opaque and masked surfaces.
#pragma once
#include <vector>

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
  static umbrage::Result<GBufferPass> create(const GpuContext&, VkPipelineLayout, const Targets&, const DrawList&);
  /// Afterwards depth is depth_read and the others are sampled: visible to compute shaders.
  void record(PassContext&, const DrawList&, VkBuffer indices) const;

 private:
  /// For the ranges that are alike in these.
  struct Variant {
    bool masked = false;
    uint32_t reads = 0;
    Handle<VkPipeline> pipeline;
  };
  const Variant* find(const DrawRange&) const;
  std::vector<Variant> variants_;
};

/// The vertex stage of every surface.
Spirv transform_vertices_spirv();
/// Cull mode and front face. glTF winds front faces counter-clockwise, mirrored instances the other way.
void set_sides(const PassContext&, VkCullModeFlags, bool mirrored);

}  // namespace app
