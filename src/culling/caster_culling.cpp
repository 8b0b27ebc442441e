// Pipelines are indexed by whether a light's views are told apart.
#include "culling/caster_culling.hpp"

#include <algorithm>
#include <cstddef>

namespace umbrage::culling {

namespace {
constexpr uint32_t kCount[] =
#include "shaders/count_casters.comp.inc"
    ;
constexpr uint32_t kWrite[] =
#include "shaders/write_casters.comp.inc"
    ;
constexpr uint32_t kWriteViews[] =
#include "shaders/write_view_casters.comp.inc"
    ;
}  // namespace

Result<CasterCulling> CasterCulling::create(const gpu::PipelineFactory& factory) {
  CasterCulling out;
  auto scan = gpu::PrefixSum::create(factory);
  if (!scan) return scan.error();
  out.scan_ = std::move(*scan);
  for (uint32_t masks_views = 0; masks_views < 2; ++masks_views) {
    const struct {
      gpu::Pipeline& target;
      std::span<const uint32_t> spirv;
      const char* name;
    } all[] = {{out.count_[masks_views], kCount, "count casters"},
               {out.write_[masks_views], kWrite, "write casters"},
               {out.write_views_[masks_views], kWriteViews, "write view casters"}};
    for (const auto& entry : all) {
      auto made = factory.compute(entry.spirv, entry.name, {{0, masks_views}});
      if (!made) return made.error();
      entry.target = std::move(*made);
    }
  }
  return out;
}

Result<void> CasterCulling::reserve(const gpu::Device& device, gpu::Memory& memory, uint32_t light_slots,
                                    uint32_t capacity, uint32_t views_at_once, uint32_t caster_slots,
                                    std::vector<gpu::Buffer>& retired) {
  const uint32_t entries = std::max(light_slots, 1u) * shared::TraverseThreads;
  const VkDeviceSize commands = std::max<VkDeviceSize>(2ull * capacity, 2ull * views_at_once * caster_slots);
  struct Need {
    gpu::Buffer& target;
    VkDeviceSize bytes;
    const char* name;
    gpu::Buffer made;
  };
  Need needs[] = {
      {counts_, entries * sizeof(uint32_t), "caster counts", {}},
      {instances_,
       std::max<VkDeviceSize>(capacity, 2ull * views_at_once * caster_slots) * sizeof(shared::CasterInstance),
       "caster instances",
       {}},
      {commands_, commands * sizeof(shared::DrawCommand), "draw commands", {}},
      {draw_counts_, std::max(views_at_once, 1u) * sizeof(shared::DrawCounts), "draw counts", {}}};
  for (Need& need : needs) {
    if (need.target && need.target.size() >= need.bytes) continue;
    auto made = gpu::Buffer::create(device, memory, need.bytes, gpu::MemoryKind::device, need.name);
    if (!made) return made.error();
    need.made = std::move(*made);
  }
  if (auto ok = scan_.reserve(device, memory, entries, retired); !ok) return ok.error();
  for (Need& need : needs) {
    if (!need.made) continue;
    std::swap(need.target, need.made);
    if (need.made) retired.push_back(std::move(need.made));
  }
  capacity_ = capacity;
  view_range_ = caster_slots;
  return {};
}

shared::TraversePush CasterCulling::inputs(gpu::Pass& pass, const Inputs& in) const {
  const scene::BoxTree& tree = in.scene.caster_tree();
  pass.read(in.frame);
  return {.lights = pass.read(in.scene.light_buffer()),
          .views = pass.read(in.views),
          .casters = pass.read(in.scene.caster_buffer()),
          .instances = pass.read(in.scene.instance_buffer()),
          .batches = pass.read(in.scene.batch_buffer()),
          .order = pass.read(tree.order()),
          .leaves = pass.read(tree.leaves()),
          .nodes = pass.read(tree.nodes()),
          .shape = in.tree_shape};
}

void CasterCulling::clear_draw_counts(gpu::Recorder& recorder) {
  gpu::Pass pass = recorder.pass("clear draw counts");
  pass.write(draw_counts_, gpu::Access::transfer_write);
  recorder.device().vk().vkCmdFillBuffer(pass.commands(), draw_counts_.handle(), 0, VK_WHOLE_SIZE, 0);
}

void CasterCulling::record_count(gpu::Recorder& recorder, const Inputs& in) {
  gpu::Scope scope(recorder, "count casters");
  const uint32_t slots = in.scene.light_slots();
  {
    gpu::Pass pass = recorder.pass("count casters");
    shared::TraversePush push = inputs(pass, in);
    push.counts = pass.write(counts_);
    pass.dispatch(count_[in.mode != umbrage::CasterCulling::light_volume], push, slots);
  }
  scan_.record(recorder, counts_, slots * shared::TraverseThreads, in.counters,
               offsetof(shared::FrameCounters, caster_pairs));
}

void CasterCulling::record_round(gpu::Recorder& recorder, const Inputs& in, uint32_t round) {
  gpu::Scope scope(recorder, "write casters");
  clear_draw_counts(recorder);
  gpu::Pass pass = recorder.pass("write casters");
  shared::TraversePush push = inputs(pass, in);
  push.counts = pass.read(counts_), push.counters = pass.write(in.counters), push.drawn = pass.write(instances_);
  push.commands = pass.write(commands_), push.draw_counts = pass.write(draw_counts_);
  push.used = pass.write(in.used_lights);
  push.window_first = round * capacity_;
  push.window_size = capacity_;
  pass.dispatch(write_[in.mode != umbrage::CasterCulling::light_volume], push, in.scene.light_slots());
}

void CasterCulling::record_views(gpu::Recorder& recorder, const Inputs& in, uint32_t first, uint32_t count) {
  clear_draw_counts(recorder);
  gpu::Pass pass = recorder.pass("write view casters");
  shared::TraversePush push = inputs(pass, in);
  push.counters = pass.write(in.counters), push.drawn = pass.write(instances_), push.commands = pass.write(commands_);
  push.draw_counts = pass.write(draw_counts_);
  push.window_first = first;
  push.window_size = view_range_;
  pass.dispatch(write_views_[in.mode != umbrage::CasterCulling::light_volume], push, count);
}

}  // namespace umbrage::culling
