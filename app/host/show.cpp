// Records debug pictures.
#include "host/show.hpp"

namespace app {

using umbrage::Result;

namespace {
constexpr uint32_t show_debug[] =
#include "shaders/show_debug.comp.inc"
    ;
constexpr uint32_t draw_boxes_vertices[] =
#include "shaders/draw_boxes.vert.inc"
    ;
constexpr uint32_t draw_boxes_fragments[] =
#include "shaders/draw_boxes.frag.inc"
    ;
constexpr uint32_t tile = 8;

constexpr ShowInfo show_infos[] = {
    {Show::image, "image", "the tone-mapped image"},
    {Show::clusters, "clusters", "each cluster of receivers in a colour of its own"},
    {Show::explicit_bounds, "explicit-bounds", "the image dimmed, with the clusters' boxes"},
    {Show::lights_per_pixel, "lights-per-pixel", "how many lights each pixel's cluster lists, blue to red"},
    {Show::normals, "normals", "geometric normals in world space, 0.5 n + 0.5"},
    {Show::depth, "depth", "distance, white near and black far, on a logarithmic scale"},
};

uint32_t shader_show(Show show) {
  switch (show) {
    case Show::clusters:
      return gpu::ShowClusters;
    case Show::explicit_bounds:
      return gpu::ShowExplicitBounds;
    case Show::lights_per_pixel:
      return gpu::ShowLightsPerPixel;
    case Show::normals:
      return gpu::ShowNormals;
    case Show::depth:
      return gpu::ShowDepth;
    case Show::image:
      break;
  }
  return 0;
}
}  // namespace

std::span<const ShowInfo> shows() { return show_infos; }

Result<ShowPass> ShowPass::create(const GpuContext& context, VkPipelineLayout layout, const Targets& targets) {
  ShowPass pass;
  auto debug = create_compute_pipeline(context, layout, show_debug, "show debug");
  if (!debug) return debug.error();
  pass.debug_ = std::move(debug).value();
  const VkFormat format = targets[Target::picture].format();
  GraphicsPipelineDesc desc;
  desc.name = "draw boxes";
  desc.vertex = draw_boxes_vertices;
  desc.fragment = draw_boxes_fragments;
  desc.color_formats = {&format, 1};
  desc.depth = DepthUse::test;
  desc.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
  auto boxes = create_graphics_pipeline(context, layout, desc);
  if (!boxes) return boxes.error();
  pass.boxes_ = std::move(boxes).value();
  return pass;
}

void ShowPass::record(PassContext& pass, Show show, VkBuffer counters) const {
  pass.push.show = shader_show(show);
  pass.gpu.vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_COMPUTE, debug_.get());
  push_constants(pass.gpu, pass.commands, pass.layout, pass.push);
  pass.gpu.vk.vkCmdDispatch(pass.commands, groups(pass.targets.width(), tile), groups(pass.targets.height(), tile), 1);
  if (show == Show::explicit_bounds) record_boxes(pass, counters);
}

void ShowPass::record_boxes(PassContext& pass, VkBuffer counters) const {
  Targets& targets = pass.targets;
  const VolkDeviceTable& vk = pass.gpu.vk;
  memory_barrier(pass.gpu, pass.commands, compute_write,
                 {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT});
  targets[Target::picture].use(pass.gpu, pass.commands, ImageUse::color_target);
  const VkRenderingAttachmentInfo color = attachment(targets[Target::picture], ImageUse::color_target,
                                                     VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
  const VkRenderingAttachmentInfo depth =
      attachment(targets[Target::depth], ImageUse::depth_read, VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_NONE);
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea = targets.area();
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &color;
  rendering.pDepthAttachment = &depth;
  vk.vkCmdBeginRendering(pass.commands, &rendering);
  set_whole_viewport(pass.gpu, pass.commands, targets);
  push_constants(pass.gpu, pass.commands, pass.layout, pass.push);
  vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, boxes_.get());
  // With a count, though it is always 1: Mesa 25.0's software driver takes the count of an earlier draw where there is none.
  vk.vkCmdDrawIndirectCount(pass.commands, counters, offsetof(gpu::GpuCounters, box_vertices), counters,
                            offsetof(gpu::GpuCounters, box_draws), 1, sizeof(VkDrawIndirectCommand));
  vk.vkCmdEndRendering(pass.commands);
  targets[Target::picture].use(pass.gpu, pass.commands, ImageUse::storage);
}

}  // namespace app
