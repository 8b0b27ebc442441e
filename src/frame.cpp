// The frame is a list: the passes of Olsson et al. 2014, figure 7, in order. Read this first; each call is a folder of its own.
// What each reads and writes is declared where it is recorded, and barriers follow from that (gpu/recorder.hpp).
#include "frame.hpp"

namespace umbrage {

void Frame::record_scene(gpu::Recorder& recorder, const FramePlan& plan, gpu::Uploader& uploader,
                         gpu::RetireQueue& retired) {
  // Edits → device; world boxes of what moved; 32-way trees over casters and lights (O4, O5).
  scene.record(recorder, scene_pipelines, uploader, retired, plan.serial);
}

void Frame::record_requests(gpu::Recorder& recorder, const FramePlan& plan, const gpu::Buffer& requests) {
  // Depth → occupied clusters with explicit bounds and normal cones (O1, O9).
  clusters.record_clusters(recorder, block, counters, plan.seen());

  // Clusters → lights of each, through the light tree; which lights are used at all (O1).
  clusters.record_lights(recorder, block, counters, scene, light_shape(), plan.settings.light_assignment);

  // Boxes of points that no depth buffer holds → lights that reach them, which are used as well.
  others.record_lights(recorder, scene, clusters.used_lights());

  // Used lights → their shadow views.
  views.record(recorder, block, counters, scene, clusters.used_lights(), others.anywhere());
  if (scene.light_slots() == 0 || plan.store == Store::fixed_cubes) return;

  // Cluster/light pairs → resolutions (O2) → maps (O8) → pages and receivers that lookups touch (O3, O7); coarser until it fits.
  const maps::Maps::Inputs receivers{scene,          clusters,      block,       counters,
                                     views.buffer(), plan.settings, plan.seen(), backing(plan.store),
                                     others};
  maps.record(recorder, receivers);

  // Marked pages → places in the pool, cleared; or a list for the host, which binds them (O18).
  if (plan.store == Store::page_pool) pool.record(recorder, maps, block, counters);
  if (draws_samples_only(plan)) maps.mark_texels(recorder, receivers, pool.texel_bits());
  if (plan.store == Store::hardware_sparse) sparse.record_requests(recorder, maps, block, counters, requests);
}

void Frame::record_shadows(gpu::Recorder& recorder, const FramePlan& plan, gpu::RetireQueue& retired) {
  // Directional lights → cascades, of which only what moved or came into view is drawn anew (C1…C8).
  if (plan.cascades) cascades.record(recorder, {scene, block, caster_shape(), counters, plan.serial}, retired);

  if (scene.light_slots() > 0 && plan.store == Store::fixed_cubes) record_fixed_cubes(recorder, plan);
  if (scene.light_slots() > 0 && plan.store != Store::fixed_cubes) record_virtual_maps(recorder, plan);

  // Everything a lookup reads → the host's shading.
  publish(recorder, plan);
}

void Frame::record_virtual_maps(gpu::Recorder& recorder, const FramePlan& plan) {
  // Maps → the batches whose shadows their receivers can see (O5…O7) → depth.
  const culling::MapCulling::Inputs cull = cull_inputs(plan);
  map_culling.record_count(recorder, cull);
  if (plan.store == Store::page_pool)
    record_pages(recorder, plan, cull);
  else
    record_layers(recorder, plan, cull);
}

void Frame::record_pages(gpu::Recorder& recorder, const FramePlan& plan, const culling::MapCulling::Inputs& cull) {
  for (uint32_t round = 0; round < plan.caster_rounds; ++round) {
    map_culling.record_round(recorder, cull, round);
    const raster::PageWriterInputs write = page_inputs(plan);
    if (plan.settings.writer == Writer::fragments) {
      gpu::Scope scope(recorder, "raster fragments");
      page_fragments.record(recorder, write, plan.settings.max_resolution);
    } else {
      page_raster.record(recorder, write);
    }
  }
}

culling::MapCulling::Inputs Frame::cull_inputs(const FramePlan& plan) const {
  return {scene,
          block,
          counters,
          views.buffer(),
          maps.maps(),
          maps.projection(),
          maps.receiver_depth(),
          clusters.used_lights(),
          caster_shape(),
          plan.settings.caster_culling};
}

raster::PageWriterInputs Frame::page_inputs(const FramePlan& plan) const {
  return {scene,
          block,
          views.buffer(),
          maps.maps(),
          maps.page_bits(),
          maps.page_first(),
          pool.pool(),
          map_culling.items(),
          map_culling.draw_counts(),
          map_culling.capacity(),
          &counters,
          plan.settings.caster_culling == CasterCulling::receiver_grid ? &maps.receiver_depth() : nullptr,
          draws_samples_only(plan) ? &pool.texel_bits() : nullptr};
}

bool Frame::draws_samples_only(const FramePlan& plan) {
  return plan.store == Store::page_pool && plan.settings.writer != Writer::fragments &&
         plan.settings.receiver_boxes == ReceiverBoxes::samples;
}

void Frame::record_layers(gpu::Recorder& recorder, const FramePlan& plan, const culling::MapCulling::Inputs& cull) {
  const raster::LayerWriter::Inputs write{scene,
                                          block,
                                          counters,
                                          views.buffer(),
                                          maps.maps(),
                                          map_culling.items(),
                                          map_culling.draw_counts(),
                                          map_culling.capacity(),
                                          map_images(plan.store),
                                          maps.page_bits(),
                                          plan.settings.max_resolution,
                                          image_table()};
  layer_writer.record_clear(recorder, write);
  for (uint32_t round = 0; round < plan.caster_rounds; ++round) {
    map_culling.record_round(recorder, cull, round);
    layer_writer.record(recorder, write);
  }
}

maps::Maps::Backing Frame::backing(Store kind) const {
  if (kind == Store::page_pool) return {.capacity_units = pool.capacity_units()};
  const store::ImageLayout& layout = map_images(kind).layout();
  maps::Maps::Backing backing{.block = {1, 1},
                              .capacity_units = UINT32_MAX,
                              .images = image_table(),
                              .image_count = static_cast<uint32_t>(layout.images.size()),
                              .most_views = layout.most_views,
                              .whole_images = true};
  if (kind == Store::physical_pool) return backing;
  backing.block = sparse.form().page;
  backing.capacity_units = sparse.layout().pages * (backing.block.x * backing.block.y / shared::PoolUnit);
  backing.most_views = sparse.layout().images.most_views;
  backing.whole_images = false;
  return backing;
}

void Frame::publish(gpu::Recorder& recorder, const FramePlan& plan) {
  published_.assign({&block, &counters, &scene.light_buffer(), &scene.light_order_buffer(), &views.buffer()});
  for (const gpu::Buffer* buffer : clusters.published()) published_.push_back(buffer);
  if (plan.store != Store::fixed_cubes)
    for (const gpu::Buffer* buffer : maps.published()) published_.push_back(buffer);
  if (plan.store == Store::page_pool) published_.push_back(&pool.pool());
  if (draws_samples_only(plan)) published_.push_back(&pool.texel_bits());
  if (plan.cascades)
    for (const gpu::Buffer* buffer : cascades.published()) published_.push_back(buffer);
  published_images_.assign({&store.atlas()});
  for (const gpu::Image* image : map_images(plan.store).published()) published_images_.push_back(image);
  recorder.publish(published_, published_images_, plan.consumer_stages);
}

void Frame::record_fixed_cubes(gpu::Recorder& recorder, const FramePlan& plan) {
  // Views → the batches each needs (O6) → depth (O12), by one multi-draw or a pass per view.
  const culling::CasterCulling::Inputs cull{
      scene, views.buffer(), counters, clusters.used_lights(), block, caster_shape(), plan.settings.caster_culling};
  const raster::Writers::Inputs write{scene, store, culling, cull, max_draws};
  if (plan.settings.writer == Writer::traditional) {
    writers.record_traditional(recorder, write);
    return;
  }
  culling.record_count(recorder, cull);
  writers.record_multi_draw(recorder, write, plan.caster_rounds);
}

void Frame::record_statistics(gpu::Recorder& recorder, const gpu::Buffer& target) {
  const gpu::Functions& vk = recorder.device().vk();
  {
    gpu::Pass pass = recorder.pass("statistics");
    pass.read(counters, gpu::Access::transfer_read);
    pass.read(clusters.used_lights(), gpu::Access::transfer_read);
    pass.write(target, gpu::Access::transfer_write);
    const VkCommandBuffer commands = pass.commands();
    const VkBufferCopy count{0, offsetof(shared::FrameReport, counters), sizeof(shared::FrameCounters)};
    vk.vkCmdCopyBuffer(commands, counters.handle(), target.handle(), 1, &count);
    const VkBufferCopy lights{0, sizeof(shared::FrameReport), scene.light_slots() * sizeof(uint32_t)};
    if (lights.size) vk.vkCmdCopyBuffer(commands, clusters.used_lights().handle(), target.handle(), 1, &lights);
  }
  gpu::Pass pass = recorder.pass("statistics to host");
  pass.read(target, gpu::Access::host_read);
  pass.commands();
}

Result<void> Frame::create_sparse(const gpu::Device& device, const gpu::PipelineFactory& factory, SparseTexels texels) {
  using Target = raster::LayerWriter::Target;
  const auto form = store::choose_sparse_form(device, texels);
  if (!form) return form.error();
  auto images_made = store::SparseImages::create(device, factory, *form);
  if (!images_made) return images_made.error();
  sparse = std::move(*images_made);
  const Target words = device.capabilities().shader_residency ? Target::resident_words : Target::words;
  auto writer = raster::LayerWriter::create(factory, form->is_attachment ? Target::depth16 : words);
  if (!writer) return writer.error();
  layer_writer = std::move(*writer);
  return {};
}

Result<std::unique_ptr<Frame>> Frame::create(const gpu::Device& device, gpu::Memory& memory,
                                             const gpu::PipelineFactory& factory, const StaticSettings& settings) {
  std::unique_ptr<Frame> frame(new Frame(device, memory, settings));
  const auto make = [&](auto& target, auto made) -> Result<void> {
    if (!made) return made.error();
    target = std::move(*made);
    return {};
  };
  const auto buffer = [&](VkDeviceSize bytes, const char* name) {
    return gpu::Buffer::create(device, memory, bytes, gpu::MemoryKind::device, name);
  };
  if (auto ok = make(frame->scene_pipelines, scene::ScenePipelines::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->clusters, clusters::Clusters::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->views, maps::Views::create(factory)); !ok) return ok.error();
  if (auto ok = make(frame->others, maps::OtherReceivers::create(factory)); !ok) return ok.error();
  if (settings.store != Store::fixed_cubes) {
    if (auto ok = make(frame->maps, maps::Maps::create(factory)); !ok) return ok.error();
    if (auto ok = make(frame->map_culling, culling::MapCulling::create(factory)); !ok) return ok.error();
  }
  if (settings.store == Store::page_pool) {
    if (auto ok = make(frame->pool, store::PagePool::create(factory)); !ok) return ok.error();
    if (auto ok = make(frame->page_raster, raster::PageRaster::create(factory)); !ok) return ok.error();
    if (auto ok = make(frame->page_fragments, raster::PageFragments::create(factory)); !ok) return ok.error();
  } else if (settings.store == Store::physical_pool) {
    if (auto ok = make(frame->layer_writer, raster::LayerWriter::create(factory, raster::LayerWriter::Target::depth16));
        !ok)
      return ok.error();
  } else if (settings.store == Store::hardware_sparse) {
    if (auto ok = frame->create_sparse(device, factory, settings.sparse_texels); !ok) return ok.error();
  } else {
    if (auto ok = make(frame->culling, culling::CasterCulling::create(factory)); !ok) return ok.error();
    if (auto ok = make(frame->writers, raster::Writers::create(factory)); !ok) return ok.error();
  }
  if (auto ok = make(frame->block, buffer(sizeof(FrameBlock), "frame")); !ok) return ok.error();
  if (auto ok = make(frame->counters, buffer(sizeof(shared::FrameCounters), "counters")); !ok) return ok.error();
  frame->published_.reserve(32);
  frame->published_images_.reserve(shared::MaxMapImages + 1);
  frame->max_draws = device.limits().max_draw_indirect_count;
  return frame;
}

}  // namespace umbrage
