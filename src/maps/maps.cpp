// Request → (choose → clear → mark → count → fit), again while the pages do not fit the pool. All on the device: the rounds
// that are not needed dispatch nothing.
#include "maps/maps.hpp"

#include <algorithm>
#include <cstddef>

#include "views/sun_levels.shared.h"

namespace umbrage::maps {

namespace {
constexpr uint32_t kRequest[] =
#include "shaders/request_resolutions.comp.inc"
    ;
constexpr uint32_t kBucket[] =
#include "shaders/bucket_requests.comp.inc"
    ;
constexpr uint32_t kPlaceLevels[] =
#include "shaders/place_levels.comp.inc"
    ;
constexpr uint32_t kChoose[] =
#include "shaders/choose_maps.comp.inc"
    ;
constexpr uint32_t kPlace[] =
#include "shaders/place_maps.comp.inc"
    ;
constexpr uint32_t kClear[] =
#include "shaders/clear_marks.comp.inc"
    ;
constexpr uint32_t kMark[] =
#include "shaders/mark_pages.comp.inc"
    ;
constexpr uint32_t kMarkBlocks[] =
#include "shaders/mark_blocks.comp.inc"
    ;
constexpr uint32_t kMarkTexels[] =
#include "shaders/mark_texels.comp.inc"
    ;
constexpr uint32_t kCountPages[] =
#include "shaders/count_pages.comp.inc"
    ;
constexpr uint32_t kCountBlocks[] =
#include "shaders/count_blocks.comp.inc"
    ;
constexpr uint32_t kEstimate[] =
#include "shaders/estimate_demand.comp.inc"
    ;
constexpr uint32_t kFit[] =
#include "shaders/fit_budget.comp.inc"
    ;
}  // namespace

Result<Maps> Maps::create(const gpu::PipelineFactory& factory) {
  Maps out;
  const struct {
    gpu::Pipeline& target;
    std::span<const uint32_t> spirv;
    const char* name;
  } all[] = {{out.request_, kRequest, "request resolutions"},
             {out.bucket_, kBucket, "bucket requests"},
             {out.place_levels_, kPlaceLevels, "place levels"},
             {out.choose_, kChoose, "choose maps"},
             {out.place_, kPlace, "place maps"},
             {out.clear_, kClear, "clear marks"},
             {out.mark_, kMark, "mark pages"},
             {out.mark_blocks_, kMarkBlocks, "mark blocks"},
             {out.mark_texels_, kMarkTexels, "mark texels"},
             {out.count_pages_, kCountPages, "count pages"},
             {out.count_blocks_, kCountBlocks, "count blocks"},
             {out.estimate_, kEstimate, "estimate demand"},
             {out.fit_, kFit, "fit budget"}};
  for (const auto& entry : all) {
    auto made = factory.compute(entry.spirv, entry.name);
    if (!made) return made.error();
    entry.target = std::move(*made);
  }
  return out;
}

Result<void> Maps::reserve(const gpu::Device& device, gpu::Memory& memory, const Sizes& sizes,
                           std::vector<gpu::Buffer>& retired) {
  const VkDeviceSize lights = std::max(sizes.light_slots, 1u),
                     cells = VkDeviceSize(sizes.receiver_grid) * sizes.receiver_grid;
  const struct {
    gpu::Buffer& target;
    VkDeviceSize bytes;
    const char* name;
  } all[] = {{maps_, sizes.maps * sizeof(shared::MapRecord), "maps"},
             {light_maps_, lights * sizeof(shared::LightMaps), "maps of lights"},
             {requests_, lights * sizeof(shared::LightRequest), "requested resolutions"},
             {level_bounds_, 4 * sizeof(uint32_t) * shared::SunViews * std::max(sizes.suns, 1u), "bounds of levels"},
             {demand_, lights * (shared::MaxShift + 1) * sizeof(uint32_t), "demand of lights"},
             {pair_requests_, sizes.pairs * sizeof(uint32_t), "resolutions of pairs"},
             {pair_maps_, sizes.pairs * sizeof(uint32_t), "maps of pairs"},
             {page_bits_, sizes.words * sizeof(uint32_t), "page bits"},
             {page_first_, sizes.words * sizeof(uint32_t), "page places"},
             {projection_, sizeof(uint32_t) * shared::ProjectionSide * sizes.receiver_views, "projection maps"},
             {receiver_depth_, sizes.receiver_views * cells * sizeof(uint32_t), "receiver depths"}};
  for (const auto& entry : all)
    if (auto ok = gpu::grow(entry.target, device, memory, entry.bytes, entry.name, retired); !ok) return ok;
  sizes_ = sizes;
  return {};
}

void Maps::fill(shared::FrameRecord& frame) const {
  frame.maps = maps_.address();
  frame.light_maps = light_maps_.address();
  frame.pair_maps = pair_maps_.address();
  frame.page_bits = page_bits_.address();
  frame.page_first = page_first_.address();
  frame.projection = projection_.address();
  frame.receiver_depth = receiver_depth_.address();
  frame.receiver_grid = sizes_.receiver_grid;
  frame.map_capacity = sizes_.maps;
}

shared::MapsPush Maps::push(const Inputs& in) const {
  const FrameSettings& settings = in.settings;
  uint32_t flags = 0;
  if (settings.layout == MapLayout::exact) flags |= shared::MapsExact;
  if (settings.resolution == ResolutionForm::paper) flags |= shared::MapsPaperResolution;
  if (settings.buckets == HistogramBuckets::linear) flags |= shared::MapsLinearBuckets;
  if (settings.facing_away == FacingAway::dropped) flags |= shared::MapsDropFacingAway;
  if (settings.receiver_boxes != ReceiverBoxes::clusters) flags |= shared::MapsMarkBlocks;
  if (in.others.anywhere()) flags |= shared::MapsAllLights;
  if (in.backing.whole_images) flags |= shared::MapsWholeImages;
  if (in.backing.images && !in.backing.whole_images) flags |= shared::MapsSparse;
  if (has_sun_levels(in)) flags |= shared::MapsSunLevels;
  return {
      .frame = in.frame.address(),
      .counters = in.counters.address(),
      .requests = requests_.address(),
      .pair_requests = pair_requests_.address(),
      .pair_clusters = in.clusters.pair_clusters().address(),
      .used = in.clusters.used_lights().address(),
      .demand = demand_.address(),
      .priority = in.scene.light_order_buffer().address(),
      .views = in.views.address(),
      .level_bounds = level_bounds_.address(),
      .flags = flags,
      .maps_per_light = settings.maps_per_light,
      .round = 0,
      .light_slots = in.scene.light_slots(),
      .capacity_units = in.backing.capacity_units,
      .word_capacity = sizes_.words,
      .receiver_capacity = std::min(sizes_.receiver_views, in.backing.most_views),
      .light_count = in.scene.light_count(),
      .undersampling = float(settings.undersampling),
      .min_resolution = settings.layout == MapLayout::levels
                            ? std::max(settings.min_resolution, std::min(settings.merge_below, settings.max_resolution))
                            : settings.min_resolution,
      .max_resolution = settings.max_resolution,
      .backing = in.backing.block.x | in.backing.block.y << 16};
}

void Maps::record(gpu::Recorder& recorder, const Inputs& in) {
  if (in.scene.light_slots() == 0) return;
  request(recorder, in);
  // Whole images are placed at once, and all of them have a place.
  for (uint32_t round = 0; round < (in.backing.whole_images ? 1 : kRounds); ++round) fit(recorder, in, round);
}

void Maps::request(gpu::Recorder& recorder, const Inputs& in) {
  gpu::Scope scope(recorder, "resolutions");
  const shared::MapsPush push = this->push(in);
  {
    gpu::Pass pass = recorder.pass("clear requests");
    pass.write(requests_, gpu::Access::transfer_write);
    pass.write(demand_, gpu::Access::transfer_write);
    pass.write(level_bounds_, gpu::Access::transfer_write);
    const VkCommandBuffer commands = pass.commands();
    recorder.device().vk().vkCmdFillBuffer(commands, requests_.handle(), 0, VK_WHOLE_SIZE, 0);
    recorder.device().vk().vkCmdFillBuffer(commands, demand_.handle(), 0, VK_WHOLE_SIZE, 0);
    recorder.device().vk().vkCmdFillBuffer(commands, level_bounds_.handle(), 0, VK_WHOLE_SIZE, 0);
  }
  const auto declare = [&](gpu::Pass& pass) {
    pass.read(in.frame), pass.read(in.scene.light_buffer()), pass.read(in.views);
    pass.read(in.clusters.boxes()), pass.read(in.clusters.cells()), pass.read(in.clusters.cones());
    pass.read(in.clusters.lights()), pass.read(in.clusters.pair_clusters());
    pass.read(in.counters), pass.read(in.counters, gpu::Access::indirect_read);
    pass.write(requests_), pass.write(pair_requests_), pass.write(level_bounds_);
  };
  constexpr VkDeviceSize groups = offsetof(shared::FrameCounters, pair_groups);
  {
    gpu::Pass pass = recorder.pass("request resolutions");
    declare(pass);
    pass.dispatch_indirect(request_, push, in.counters, groups);
  }
  if (has_sun_levels(in)) place_levels(recorder, in);
  if (in.settings.layout != MapLayout::exact) return;
  gpu::Pass pass = recorder.pass("bucket requests");
  declare(pass);
  pass.dispatch_indirect(bucket_, push, in.counters, groups);
}

bool Maps::has_sun_levels(const Inputs& in) { return in.settings.layout == MapLayout::levels && !in.backing.images; }

void Maps::place_levels(gpu::Recorder& recorder, const Inputs& in) {
  if (in.scene.directional_lights() == 0) return;
  gpu::Pass pass = recorder.pass("place levels");
  const shared::PlaceLevelsPush push{.frame = pass.read(in.frame),
                                     .requests = pass.write(requests_),
                                     .level_bounds = pass.read(level_bounds_),
                                     .max_resolution = in.settings.max_resolution,
                                     .levels_per_sun = in.settings.levels_per_sun};
  pass.read(in.scene.light_buffer()), pass.read(in.scene.light_order_buffer()), pass.write(in.views);
  pass.dispatch(place_levels_, push, (in.scene.directional_lights() + 31) / 32);
}

void Maps::fit(gpu::Recorder& recorder, const Inputs& in, uint32_t round) {
  shared::MapsPush push = this->push(in);
  push.round = round;
  {
    gpu::Scope scope(recorder, "choose maps");
    gpu::Pass pass = recorder.pass("choose maps");
    pass.read(in.frame), pass.read(in.scene.light_buffer()), pass.read(requests_), pass.read(in.views);
    pass.read(in.clusters.used_lights());
    pass.write(in.counters), pass.write(light_maps_), pass.write(maps_);
    pass.dispatch(choose_, push, 1);
  }
  if (in.backing.images) place(recorder, in);
  {
    gpu::Scope scope(recorder, "mark pages");
    {
      gpu::Pass pass = recorder.pass("clear marks");
      pass.read(in.frame), pass.read(maps_), pass.read(in.counters, gpu::Access::indirect_read);
      pass.write(page_bits_), pass.write(projection_), pass.write(receiver_depth_);
      pass.dispatch_indirect(clear_, push, in.counters, offsetof(shared::FrameCounters, fit_map_groups));
    }
    gpu::Pass pass = recorder.pass("mark pages");
    pass.read(in.frame), pass.read(in.counters), pass.read(in.counters, gpu::Access::indirect_read),
        pass.read(in.views);
    pass.read(in.scene.light_buffer());
    pass.read(in.clusters.boxes()), pass.read(in.clusters.lights()), pass.read(in.clusters.pair_clusters());
    pass.read(pair_requests_), pass.read(requests_), pass.read(light_maps_);
    pass.write(maps_), pass.write(pair_maps_), pass.write(page_bits_), pass.write(projection_),
        pass.write(receiver_depth_);
    pass.dispatch_indirect(mark_, push, in.counters, offsetof(shared::FrameCounters, fit_pair_groups));
    if (in.settings.receiver_boxes != ReceiverBoxes::clusters) mark_blocks(recorder, in);
    in.others.record_marks(recorder, {in.frame, in.counters, in.scene.light_buffer(), in.views, maps_, page_bits_,
                                      projection_, receiver_depth_});
  }
  gpu::Scope scope(recorder, "fit budget");
  if (!in.backing.whole_images) count(recorder, in, push);
  if (round == 0 && !in.backing.whole_images) {
    gpu::Pass pass = recorder.pass("estimate demand");
    pass.read(in.frame), pass.read(maps_), pass.read(page_bits_), pass.read(in.counters),
        pass.read(in.counters, gpu::Access::indirect_read);
    pass.write(demand_);
    pass.dispatch_indirect(estimate_, push, in.counters, offsetof(shared::FrameCounters, fit_map_groups));
  }
  gpu::Pass pass = recorder.pass("fit budget");
  pass.read(in.frame), pass.read(maps_), pass.read(demand_), pass.read(in.scene.light_order_buffer());
  pass.write(in.counters), pass.write(light_maps_), pass.write(in.clusters.used_lights());
  pass.dispatch(fit_, push, 1);
}

void Maps::mark_blocks(gpu::Recorder& recorder, const Inputs& in) {
  gpu::Pass pass = recorder.pass("mark blocks");
  shared::MarkSamplesPush push{.frame = pass.read(in.frame),
                               .counters = pass.read(in.counters),
                               .drop_facing_away = in.settings.facing_away == FacingAway::dropped};
  pass.read(in.scene.light_buffer()), pass.read(in.views);
  pass.read(in.clusters.words()), pass.read(in.clusters.lists()), pass.read(pair_maps_);
  pass.write(maps_), pass.write(page_bits_), pass.write(projection_), pass.write(receiver_depth_);
  for (const clusters::FrameCamera& camera : in.cameras) {
    recorder.use_frame_set(camera.images);
    push.camera = camera.record, push.normal_encoding = static_cast<uint32_t>(camera.normal_encoding);
    pass.dispatch(mark_blocks_, push, camera.tiles.x, camera.tiles.y);
  }
  recorder.use_frame_set(in.cameras[0].images);
}

void Maps::mark_texels(gpu::Recorder& recorder, const Inputs& in, const gpu::Buffer& texel_bits) {
  if (in.scene.light_slots() == 0) return;
  gpu::Scope scope(recorder, "mark texels");
  gpu::Pass pass = recorder.pass("mark texels");
  shared::MarkSamplesPush push{.frame = pass.read(in.frame),
                               .counters = pass.read(in.counters),
                               .drop_facing_away = in.settings.facing_away == FacingAway::dropped};
  pass.read(in.scene.light_buffer()), pass.read(in.views), pass.read(in.clusters.words());
  pass.read(in.clusters.lists()), pass.read(pair_maps_), pass.read(maps_);
  pass.read(page_bits_), pass.read(page_first_), pass.write(texel_bits);
  for (const clusters::FrameCamera& camera : in.cameras) {
    recorder.use_frame_set(camera.images);
    push.camera = camera.record, push.normal_encoding = static_cast<uint32_t>(camera.normal_encoding);
    const glm::uvec2 groups = camera.tiles * (shared::TileSide / (2 * shared::MarkSide));
    pass.dispatch(mark_texels_, push, groups.x, groups.y);
  }
  recorder.use_frame_set(in.cameras[0].images);
}

void Maps::place(gpu::Recorder& recorder, const Inputs& in) {
  gpu::Scope scope(recorder, "place maps");
  gpu::Pass pass = recorder.pass("place maps");
  const shared::PlaceMapsPush push{.frame = pass.read(in.frame),
                                   .counters = pass.write(in.counters),
                                   .priority = pass.read(in.scene.light_order_buffer()),
                                   .images = in.backing.images,
                                   .image_count = in.backing.image_count,
                                   .light_count = in.scene.light_count(),
                                   .whole_images = in.backing.whole_images};
  pass.read(light_maps_), pass.write(maps_);
  pass.dispatch(place_, push, 1);
}

void Maps::count(gpu::Recorder& recorder, const Inputs& in, const shared::MapsPush& push) {
  gpu::Pass pass = recorder.pass("count pages");
  pass.read(in.frame), pass.read(maps_), pass.read(page_bits_), pass.read(in.counters, gpu::Access::indirect_read);
  pass.write(in.counters);
  if (in.backing.images) {
    pass.dispatch_indirect(count_blocks_, push, in.counters, offsetof(shared::FrameCounters, fit_map_groups));
    return;
  }
  pass.write(page_first_);
  pass.dispatch_indirect(count_pages_, push, in.counters, offsetof(shared::FrameCounters, fit_word_groups));
}

}  // namespace umbrage::maps
