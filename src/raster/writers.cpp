// The two writers of the first form. Reversed depth, cleared to 0; both sides of casters; the near plane clips.
#include "raster/writers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace umbrage::raster {

namespace {
constexpr uint32_t kCastVertex[] =
#include "shaders/cast.vert.inc"
    ;
constexpr uint32_t kMaskFragment[] =
#include "shaders/mask.frag.inc"
    ;

/// Begins rendering into a rectangle of the atlas. The viewport is always the whole: coordinates round alike, so that both
/// writers make the same bits.
void begin(const gpu::Device& device, VkCommandBuffer commands, const gpu::Image& atlas, const VkRect2D& area,
           bool clear) {
  VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  depth.imageView = atlas.view();
  depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth.loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
  depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  depth.clearValue.depthStencil.depth = 0;
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = area;
  info.layerCount = 1;
  info.pDepthAttachment = &depth;
  device.vk().vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0, 0, float(atlas.width()), float(atlas.height()), 0, 1};
  device.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
  device.vk().vkCmdSetScissor(commands, 0, 1, &area);
}

/// Declares what drawing reads, besides positions, which have been visible since they were uploaded.
shared::CastPush declare(gpu::Pass& pass, const Writers::Inputs& in) {
  using enum gpu::Access;
  pass.read(in.scene.index_buffer(), index_read);
  pass.read(in.culling.instances(), vertex_attribute_read);
  pass.read(in.culling.commands(), indirect_read);
  pass.read(in.culling.draw_counts(), indirect_read);
  const gpu::Image& atlas = in.store.atlas();
  pass.image(atlas, depth_attachment);
  return {.batches = pass.read(in.scene.batch_buffer(), fragment_read),
          .viewport_size = {atlas.width(), atlas.height()}};
}

void bind_geometry(const gpu::Functions& vk, VkCommandBuffer commands, const Writers::Inputs& in) {
  vk.vkCmdBindIndexBuffer(commands, in.scene.index_buffer().handle(), 0, VK_INDEX_TYPE_UINT32);
  const VkBuffer instances = in.culling.instances().handle();
  const VkDeviceSize offset = 0;
  vk.vkCmdBindVertexBuffers(commands, 0, 1, &instances, &offset);
}
}  // namespace

Result<Writers> Writers::create(const gpu::PipelineFactory& factory) {
  Writers out;
  constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT, kWords = VK_FORMAT_R32G32B32A32_UINT;
  constexpr std::array<VkFormat, 7> kAttributes{kFloats, kFloats, kFloats, kFloats, kFloats, kWords, kWords};
  for (uint32_t masked = 0; masked < 2; ++masked) {
    const gpu::DepthShaders shaders{
        .vertex = kCastVertex,
        .fragment = masked ? std::span<const uint32_t>(kMaskFragment) : std::span<const uint32_t>{},
        .instance_attributes = kAttributes,
        .instance_stride_bytes = sizeof(shared::CasterInstance)};
    auto made = factory.depth(shaders, masked ? "cast, masked" : "cast", {{0, masked}});
    if (!made) return made.error();
    out.cast_[masked] = std::move(*made);
  }
  return out;
}

void Writers::record_multi_draw(gpu::Recorder& recorder, const Inputs& in, uint32_t rounds) const {
  const gpu::Image& atlas = in.store.atlas();
  const VkRect2D whole{{0, 0}, {atlas.width(), atlas.height()}};
  const gpu::Functions& vk = recorder.device().vk();
  const uint32_t capacity = in.culling.capacity();
  for (uint32_t round = 0; round < rounds; ++round) {
    in.culling.record_round(recorder, in.cull, round);
    gpu::Scope scope(recorder, "raster");
    gpu::Pass pass = recorder.pass("multi-draw");
    const shared::CastPush push = declare(pass, in);
    const VkCommandBuffer commands = pass.commands();
    begin(recorder.device(), commands, atlas, whole, round == 0);
    bind_geometry(vk, commands, in);
    for (uint32_t masked = 0; masked < (in.scene.has_masked() ? 2u : 1u); ++masked) {
      pass.bind_graphics(cast_[masked], push);
      const VkDeviceSize count_at =
          masked ? offsetof(shared::DrawCounts, masked) : offsetof(shared::DrawCounts, opaque);
      vk.vkCmdDrawIndexedIndirectCount(
          commands, in.culling.commands().handle(), VkDeviceSize(masked) * capacity * sizeof(shared::DrawCommand),
          in.culling.draw_counts().handle(), count_at, std::min(capacity, in.max_draws), sizeof(shared::DrawCommand));
    }
    vk.vkCmdEndRendering(commands);
  }
}

void Writers::record_traditional(gpu::Recorder& recorder, const Inputs& in) const {
  const gpu::Functions& vk = recorder.device().vk();
  const store::AtlasLayout& layout = in.store.layout();
  const uint32_t range = in.culling.view_range();
  gpu::Scope scope(recorder, "raster");
  for (uint32_t first = 0; first < layout.views; first += kViewsAtOnce) {
    const uint32_t count = std::min(kViewsAtOnce, layout.views - first);
    in.culling.record_views(recorder, in.cull, first, count);
    gpu::Pass pass = recorder.pass("pass per view");
    const shared::CastPush push = declare(pass, in);
    const VkCommandBuffer commands = pass.commands();
    bind_geometry(vk, commands, in);
    for (uint32_t i = 0; i < count; ++i) {
      const glm::uvec2 tile = shared::atlas_tile(first + i, layout.columns, layout.resolution);
      begin(recorder.device(), commands, in.store.atlas(),
            {{int32_t(tile.x), int32_t(tile.y)}, {layout.resolution, layout.resolution}}, true);
      for (uint32_t masked = 0; masked < (in.scene.has_masked() ? 2u : 1u); ++masked) {
        pass.bind_graphics(cast_[masked], push);
        const VkDeviceSize count_at = i * sizeof(shared::DrawCounts) + (masked ? offsetof(shared::DrawCounts, masked)
                                                                               : offsetof(shared::DrawCounts, opaque));
        vk.vkCmdDrawIndexedIndirectCount(commands, in.culling.commands().handle(),
                                         VkDeviceSize(2 * i + masked) * range * sizeof(shared::DrawCommand),
                                         in.culling.draw_counts().handle(), count_at, std::min(range, in.max_draws),
                                         sizeof(shared::DrawCommand));
      }
      vk.vkCmdEndRendering(commands);
    }
  }
}

}  // namespace umbrage::raster
