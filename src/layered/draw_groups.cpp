// Recording: select what each group draws, then a render pass a group.
#include <algorithm>

#include "layered/layered_pass_state.hpp"

namespace umbrage {

void LayeredPass::State::select(gpu::Recorder& recorder) {
  using enum gpu::Access;
  {
    gpu::Pass pass = recorder.pass("upload views");
    pass.write(block, transfer_write);
    const VkBufferCopy whole{0, 0, at.bytes};
    scene.device->vk().vkCmdCopyBuffer(pass.commands(), staging[scene.slot].handle(), block.handle(), 1, &whole);
  }
  if (scene.caster_count == 0) return;
  gpu::Pass pass = recorder.pass("select casters");
  pass.read(scene.geometry), pass.read(scene.moving);
  const VkDeviceAddress base = pass.write(block);
  const shared::SelectPush push{.casters = scene.address(scene.casters),
                                .batches = scene.address(scene.batches),
                                .instances = scene.moving.address(),
                                .views = base + at.views,
                                .groups = base + at.groups,
                                .visible = pass.write(visible),
                                .counts = base + at.counts,
                                .draws = uses_draws() ? pass.write(draws) : 0,
                                .listed = uses_draws() ? 0 : pass.write(listed),
                                .caster_count = scene.caster_count,
                                .group_count = static_cast<uint32_t>(groups.size()),
                                .view_count = static_cast<uint32_t>(views.size()),
                                .list_count = list_count,
                                .instance_per_view = instance_per_view()};
  pass.dispatch(select_casters, push, (scene.caster_count + 63) / 64);
}

void LayeredPass::State::begin_rendering(VkCommandBuffer commands, const layered::ViewGroup& group) const {
  const LayeredTargetDesc& desc = target->desc;
  const bool loads = group.continues || !clear;
  VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  depth.imageView = target->depth[group.first_layer];
  depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth.loadOp = loads ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
  depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  depth.clearValue.depthStencil.depth = settings.depth_order == DepthOrder::larger_is_nearer ? 0.0f : 1.0f;
  VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  if (is_color) {
    color.imageView = target->color[group.first_layer];
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = depth.loadOp;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.clearValue.color = clear_color;
  }
  const gpu::Functions& vk = scene.device->vk();
  if (group.continues) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                                  VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT |
                                                  VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    barrier.dstAccessMask =
        barrier.srcAccessMask | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vk.vkCmdPipelineBarrier2(commands, &info);
  }
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, {desc.width, desc.height}};
  info.layerCount = group.layer_count;
  if (settings.writer == LayeredWriter::multiview)
    info.viewMask = group.layer_count >= 32 ? 0xffffffffu : (1u << group.layer_count) - 1;
  info.colorAttachmentCount = is_color ? 1 : 0;
  info.pColorAttachments = &color;
  info.pDepthAttachment = &depth;
  vk.vkCmdBeginRendering(commands, &info);
}

void LayeredPass::State::draw_group(VkCommandBuffer commands, const layered::ViewGroup& group, size_t index,
                                    shared::LayeredPush& push) {
  const gpu::Functions& vk = scene.device->vk();
  const bool culls = culls_by_hardware() && settings.culled_faces != CulledFaces::none;
  vk.vkCmdSetCullMode(commands, !culls                                       ? VK_CULL_MODE_NONE
                                : settings.culled_faces == CulledFaces::back ? VK_CULL_MODE_BACK_BIT
                                                                             : VK_CULL_MODE_FRONT_BIT);
  push.first_view = group.first_view, push.view_count = group.view_count, push.first_layer = group.first_layer;
  const uint32_t view_mask = settings.writer != LayeredWriter::multiview ? 0
                             : group.layer_count >= 32                   ? 0xffffffffu
                                                                         : (1u << group.layer_count) - 1;
  begin_rendering(commands, group);
  for (uint32_t list = 0; list < list_count && scene.caster_count > 0; ++list) {
    const VkPipeline pipeline = pipelines->find((list & 1) != 0 && !is_color, view_mask);
    if (!pipeline) continue;  // lists of masked batches in a scene without any
    // Fronts, counter-clockwise seen from outside, are clockwise by Vulkan's rule unless view or instance mirrors (eye_point.cpp).
    vk.vkCmdSetFrontFace(commands,
                         group.is_mirrored != (list >= 2) ? VK_FRONT_FACE_COUNTER_CLOCKWISE : VK_FRONT_FACE_CLOCKWISE);
    vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    const VkDeviceSize row = list_row(index, list);
    push.list = uses_draws() ? 0 : listed.address() + row * sizeof(uint32_t);
    vk.vkCmdPushConstants(commands, pipelines->layout(), pipelines->push_stages(), 0, sizeof push, &push);
    const VkDeviceSize count_at = at.counts + (index * list_count + list) * sizeof(shared::LayeredCount);
    if (uses_draws())
      vk.vkCmdDrawIndexedIndirectCount(commands, draws.handle(), row * sizeof(shared::LayeredDraw), block.handle(),
                                       count_at, scene.caster_count, sizeof(shared::LayeredDraw));
    else
      vk.vkCmdDrawMeshTasksIndirectEXT(commands, block.handle(), count_at, 1, sizeof(shared::LayeredCount));
  }
  vk.vkCmdEndRendering(commands);
}

void LayeredPass::State::draw_groups(gpu::Recorder& recorder, VkCommandBuffer commands) {
  using enum gpu::Access;
  const gpu::Functions& vk = scene.device->vk();
  gpu::Pass pass = recorder.pass("draw views");
  pass.read(block, geometry_read), pass.read(block, indirect_read), pass.read(visible, geometry_read);
  if (scene.caster_count > 0) {
    pass.read(scene.geometry, geometry_read), pass.read(scene.geometry, fragment_read),
        pass.read(scene.geometry, index_read);
    pass.read(scene.moving, geometry_read);
    pass.read(uses_draws() ? draws : listed, uses_draws() ? indirect_read : geometry_read);
  }
  pass.commands();
  const VkViewport viewport{0, 0, static_cast<float>(target->desc.width), static_cast<float>(target->desc.height),
                            0, 1};
  const VkRect2D whole{{0, 0}, {target->desc.width, target->desc.height}};
  vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  vk.vkCmdSetScissor(commands, 0, 1, &whole);
  const std::array<VkDescriptorSet, 2> sets{scene.mask_set, color_set};
  vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines->layout(), 0, color_set ? 2 : 1,
                             sets.data(), 0, nullptr);
  if (uses_draws() && scene.caster_count > 0)
    vk.vkCmdBindIndexBuffer(commands, scene.geometry.handle(), scene.indices.offset, VK_INDEX_TYPE_UINT32);
  shared::LayeredPush push = scene_push();
  for (size_t i = 0; i < groups.size(); ++i) draw_group(commands, groups[i], i, push);
}

void LayeredPass::State::write_depth(gpu::Recorder& recorder, VkCommandBuffer commands) {
  for (size_t i = 0; i < groups.size(); ++i) {
    depth_writer->record(recorder, commands,
                         {.views = groups[i],
                          .target = target->desc,
                          .scene = block.address() + at.scene,
                          .indices = scene.address(scene.indices),
                          .geometry = scene.geometry,
                          .moving = scene.moving,
                          .visible = visible,
                          .listed = listed,
                          .block = block,
                          .empty_count = at.empty_count,
                          .first_count = at.counts + i * list_count * sizeof(shared::LayeredCount),
                          .first_listed = list_row(i, 0) * sizeof(uint32_t),
                          .caster_count = scene.caster_count,
                          .list_count = list_count});
  }
}

}  // namespace umbrage
