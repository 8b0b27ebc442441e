// Records the G-buffer pass.
#include "host/gbuffer.hpp"

#include <algorithm>

namespace app {

using umbrage::Result;

namespace {
constexpr uint32_t transform_vertices[] =
#include "shaders/transform_vertices.vert.inc"
    ;
constexpr uint32_t write_gbuffer[] =
#include "shaders/write_gbuffer.frag.inc"
    ;
}  // namespace

Spirv transform_vertices_spirv() { return transform_vertices; }

Result<GBufferPass> GBufferPass::create(const GpuContext& context, VkPipelineLayout layout, const Targets& targets,
                                        const DrawList& draws) {
  std::array<VkFormat, gbuffer_targets.size()> formats;
  for (size_t i = 0; i < formats.size(); ++i) formats[i] = targets[gbuffer_targets[i]].format();
  GBufferPass pass;
  for (const DrawRange& range : draws.ranges()) {
    if (pass.find(range) != nullptr) continue;
    GraphicsPipelineDesc desc;
    desc.name = range.masked ? "G-buffer, masked" : "G-buffer";
    desc.vertex = transform_vertices;
    desc.fragment = write_gbuffer;
    desc.color_formats = formats;
    desc.masked = range.masked ? VK_TRUE : VK_FALSE;
    desc.reads = range.reads;
    auto pipeline = create_graphics_pipeline(context, layout, desc);
    if (!pipeline) return pipeline.error();
    pass.variants_.push_back({range.masked, range.reads, std::move(pipeline).value()});
  }
  return pass;
}

const GBufferPass::Variant* GBufferPass::find(const DrawRange& range) const {
  const auto found = std::find_if(variants_.begin(), variants_.end(), [&](const Variant& variant) {
    return variant.masked == range.masked && variant.reads == range.reads;
  });
  return found == variants_.end() ? nullptr : &*found;
}

void set_sides(const PassContext& pass, VkCullModeFlags cull, bool mirrored) {
  pass.gpu.vk.vkCmdSetCullMode(pass.commands, cull);
  pass.gpu.vk.vkCmdSetFrontFace(pass.commands, mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
}

void GBufferPass::record(PassContext& pass, const DrawList& draws, VkBuffer indices) const {
  Targets& targets = pass.targets;
  const VolkDeviceTable& vk = pass.gpu.vk;
  std::array<VkRenderingAttachmentInfo, gbuffer_targets.size()> colors;
  for (size_t i = 0; i < colors.size(); ++i) {
    targets[gbuffer_targets[i]].use(pass.gpu, pass.commands, ImageUse::color_target);
    colors[i] = attachment(targets[gbuffer_targets[i]], ImageUse::color_target, VK_ATTACHMENT_LOAD_OP_CLEAR,
                           VK_ATTACHMENT_STORE_OP_STORE);
  }
  targets[Target::depth].use(pass.gpu, pass.commands, ImageUse::depth_target);
  VkRenderingAttachmentInfo depth = attachment(targets[Target::depth], ImageUse::depth_target,
                                               VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
  depth.clearValue.depthStencil = {0.0f, 0};
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea = targets.area();
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = static_cast<uint32_t>(colors.size());
  rendering.pColorAttachments = colors.data();
  rendering.pDepthAttachment = &depth;

  vk.vkCmdBeginRendering(pass.commands, &rendering);
  set_whole_viewport(pass.gpu, pass.commands, targets);
  push_constants(pass.gpu, pass.commands, pass.layout, pass.push);
  vk.vkCmdBindIndexBuffer(pass.commands, indices, 0, VK_INDEX_TYPE_UINT32);
  for (const DrawRange& range : draws.ranges()) {
    vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, find(range)->pipeline.get());
    set_sides(pass, range.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT, range.mirrored);
    vk.vkCmdDrawIndexedIndirect(pass.commands, draws.commands(),
                                range.first_command * sizeof(VkDrawIndexedIndirectCommand), range.command_count,
                                sizeof(VkDrawIndexedIndirectCommand));
  }
  vk.vkCmdEndRendering(pass.commands);
  targets[Target::depth].use(pass.gpu, pass.commands, ImageUse::depth_read);
  for (const Target target : gbuffer_targets) targets[target].use(pass.gpu, pass.commands, ImageUse::sampled);
}

}  // namespace app
