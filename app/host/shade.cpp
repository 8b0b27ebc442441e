// Records lighting.
#include "host/shade.hpp"

#include <algorithm>

namespace app {

using umbrage::Result;

namespace {
constexpr uint32_t shade_pixels[] =
#include "shaders/shade_pixels.comp.inc"
    ;
constexpr uint32_t shade_blended[] =
#include "shaders/shade_blended.frag.inc"
    ;
constexpr uint32_t tile = 8;
}  // namespace

Result<ShadePass> ShadePass::create(const GpuContext& context, VkPipelineLayout layout, const Targets& targets) {
  ShadePass pass;
  auto shade = create_compute_pipeline(context, layout, shade_pixels, "shade pixels");
  if (!shade) return shade.error();
  pass.shade_ = std::move(shade).value();
  const VkFormat format = targets[Target::color].format();
  GraphicsPipelineDesc desc;
  desc.name = "shade blended";
  desc.vertex = transform_vertices_spirv();
  desc.fragment = shade_blended;
  desc.color_formats = {&format, 1};
  desc.depth = DepthUse::test;
  desc.blend = Blend::premultiplied;
  desc.reads = gpu::ReadsAll;
  auto blended = create_graphics_pipeline(context, layout, desc);
  if (!blended) return blended.error();
  pass.blended_ = std::move(blended).value();
  return pass;
}

void ShadePass::record(PassContext& pass) const {
  pass.targets[Target::color].use(pass.gpu, pass.commands, ImageUse::storage);
  pass.gpu.vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_COMPUTE, shade_.get());
  push_constants(pass.gpu, pass.commands, pass.layout, pass.push);
  pass.gpu.vk.vkCmdDispatch(pass.commands, groups(pass.targets.width(), tile), groups(pass.targets.height(), tile), 1);
  memory_barrier(pass.gpu, pass.commands, compute_write, compute_access);
}

void ShadePass::record_blended(PassContext& pass, const DrawList& draws, VkBuffer indices,
                               const CameraMatrices& camera) {
  const std::span<const BlendedDraw> blended = draws.blended();
  if (blended.empty()) return;
  order_.clear();
  for (uint32_t i = 0; i < blended.size(); ++i)
    order_.emplace_back(glm::dot(blended[i].center - camera.eye, camera.back), i);
  std::sort(order_.begin(), order_.end());  // The farthest lies most against `back`.

  Targets& targets = pass.targets;
  const VolkDeviceTable& vk = pass.gpu.vk;
  begin_drawing_over(pass.gpu, pass.commands, targets, Target::color);
  push_constants(pass.gpu, pass.commands, pass.layout, pass.push);
  vk.vkCmdBindIndexBuffer(pass.commands, indices, 0, VK_INDEX_TYPE_UINT32);
  vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, blended_.get());
  for (const auto& [distance, i] : order_) {
    const BlendedDraw& draw = blended[i];
    const auto draw_sides = [&](VkCullModeFlags cull) {
      set_sides(pass, cull, draw.mirrored);
      vk.vkCmdDrawIndexed(pass.commands, draw.index_count, 1, draw.first_index, 0, draw.instance);
    };
    // Of a closed double-sided thing the inside lies behind the outside.
    if (draw.double_sided) draw_sides(VK_CULL_MODE_FRONT_BIT);
    draw_sides(VK_CULL_MODE_BACK_BIT);
  }
  vk.vkCmdEndRendering(pass.commands);
  targets[Target::color].use(pass.gpu, pass.commands, ImageUse::storage);
}

}  // namespace app
