// The frame is a list: the passes of Olsson et al. 2014, figure 7, in order. Read this first; each call is a folder of its own.
// What each reads and writes is declared where it is recorded, and barriers follow from that (gpu/recorder.hpp).
#include "frame.hpp"

#include <array>

namespace umbrage {

void Frame::record_scene(gpu::Recorder& recorder, const FramePlan& plan, gpu::Uploader& uploader, gpu::RetireQueue& retired) {
  // Edits → device; world boxes of what moved; 32-way trees over casters and lights (O4, O5).
  scene.record(recorder, scene_pipelines, uploader, retired, plan.serial);
}

void Frame::record_shadows(gpu::Recorder& recorder, const FramePlan& plan) {
  // Depth → occupied clusters with explicit bounds and normal cones (O1, O9).
  clusters.record_clusters(recorder, block, counters, plan.tiles, plan.normal_encoding);

  // Clusters → lights of each, through the light tree; which lights are used at all (O1).
  clusters.record_lights(recorder, block, counters, scene, light_shape(), plan.settings.light_assignment);

  // Used lights → shadow views and their tiles.
  store.record_views(recorder, block, counters, scene, clusters.used_lights(), plan.all_lights);

  // Views → the batches each needs (O6) → depth (O12), by one multi-draw or a pass per view.
  const culling::CasterCulling::Inputs cull{scene, store.views(), counters, clusters.used_lights(), block, caster_shape(), plan.settings.caster_culling};
  const raster::Writers::Inputs write{scene, store, culling, cull, max_draws};
  if (scene.light_slots() > 0 && plan.settings.writer == Writer::multi_draw) {
    culling.record_count(recorder, cull);
    writers.record_multi_draw(recorder, write, plan.caster_rounds);
  } else if (scene.light_slots() > 0) {
    writers.record_traditional(recorder, write);
  }

  // Everything a lookup reads → the host's shading.
  const auto cluster_buffers = clusters.published();
  std::array<const gpu::Buffer*, cluster_buffers.size() + 5> published{&block, &counters, &scene.light_buffer(), &scene.light_order_buffer(), &store.views()};
  std::copy(cluster_buffers.begin(), cluster_buffers.end(), published.begin() + 5);
  recorder.publish(published, plan.consumer_stages, &store.atlas());
}

void Frame::record_statistics(gpu::Recorder& recorder, const gpu::Buffer& target) {
  const gpu::Functions& vk = recorder.device().vk();
  {
    gpu::Pass pass = recorder.pass("statistics");
    pass.read(counters, gpu::Access::transfer_read);
    pass.read(clusters.used_lights(), gpu::Access::transfer_read);
    pass.write(target, gpu::Access::transfer_write);
    const VkCommandBuffer commands = pass.commands();
    const VkBufferCopy count{0, 0, sizeof(shared::FrameCounters)};
    vk.vkCmdCopyBuffer(commands, counters.handle(), target.handle(), 1, &count);
    const VkBufferCopy lights{0, sizeof(shared::FrameCounters), scene.light_slots() * sizeof(uint32_t)};
    if (lights.size) vk.vkCmdCopyBuffer(commands, clusters.used_lights().handle(), target.handle(), 1, &lights);
  }
  gpu::Pass pass = recorder.pass("statistics to host");
  pass.read(target, gpu::Access::host_read);
  pass.commands();
}

Result<std::unique_ptr<Frame>> Frame::create(const gpu::Device& device, gpu::Memory& memory, const gpu::PipelineFactory& factory,
                                             const StaticSettings& settings) {
  std::unique_ptr<Frame> frame(new Frame(device, memory, settings));
  const auto make = [&](auto& target, auto made) -> Result<void> {
    if (!made) return made.error();
    target = std::move(*made);
    return {};
  };
  const auto buffer = [&](VkDeviceSize bytes, const char* name) { return gpu::Buffer::create(device, memory, bytes, gpu::MemoryKind::device, name); };
  if (auto ok = make(frame->scene_pipelines, scene::ScenePipelines::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->clusters, clusters::Clusters::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->store, store::FixedCubes::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->culling, culling::CasterCulling::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->writers, raster::Writers::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->block, buffer(sizeof(FrameBlock), "frame")); !ok) return ok.error();
  if (auto ok = make(frame->counters, buffer(sizeof(shared::FrameCounters), "counters")); !ok) return ok.error();
  frame->max_draws = device.limits().max_draw_indirect_count;
  return frame;
}

}  // namespace umbrage
