// Two pipelines a mode; a workgroup a map.
#include "culling/map_culling.hpp"

#include <algorithm>
#include <cstddef>

#include "culling/receivers.shared.h"

namespace umbrage::culling {

namespace {
constexpr uint32_t kCount[] =
#include "shaders/count_items.comp.inc"
    ;
constexpr uint32_t kWrite[] =
#include "shaders/write_items.comp.inc"
    ;

using enum umbrage::CasterCulling;
static_assert(static_cast<uint32_t>(light_volume) == shared::CullLightVolume &&
              static_cast<uint32_t>(view_mask) == shared::CullViewMask &&
              static_cast<uint32_t>(projection_map) == shared::CullProjectionMap &&
              static_cast<uint32_t>(projection_map_depth) == shared::CullProjectionMapDepth &&
              static_cast<uint32_t>(receiver_grid) == shared::CullReceiverGrid &&
              shared::CullReceiverGrid + 1 == MapCulling::kModes);

constexpr VkDeviceSize kMapGroups = offsetof(shared::FrameCounters, map_groups);
}  // namespace

Result<MapCulling> MapCulling::create(const gpu::PipelineFactory& factory, uint32_t node_test) {
  MapCulling out;
  out.node_test_ = node_test;
  auto scan = gpu::PrefixSum::create(factory);
  if (!scan) return scan.error();
  out.scan_ = std::move(*scan);
  return out;
}

Result<void> MapCulling::prepare(const gpu::PipelineFactory& factory, umbrage::CasterCulling mode) {
  const auto constant = static_cast<uint32_t>(mode);
  if (write_[constant].handle()) return {};
  auto count = factory.compute(kCount, "count items", {{0, constant}, {1, node_test_}});
  if (!count) return count.error();
  auto write = factory.compute(kWrite, "write items", {{0, constant}, {1, node_test_}});
  if (!write) return write.error();
  count_[constant] = std::move(*count);
  write_[constant] = std::move(*write);
  return {};
}

Result<void> MapCulling::reserve(const gpu::Device& device, gpu::Memory& memory, uint32_t map_capacity,
                                 uint32_t item_capacity, std::vector<gpu::Buffer>& retired) {
  const uint32_t maps = std::max(map_capacity, 1u), items = std::max(item_capacity, 1u);
  struct Need {
    gpu::Buffer& target;
    VkDeviceSize bytes;
    const char* name;
    gpu::Buffer made;
  };
  Need needs[] = {{counts_, VkDeviceSize(maps) * shared::TraverseThreads * sizeof(glm::uvec2), "item counts", {}},
                  {totals_, VkDeviceSize(2) * maps * sizeof(uint32_t), "items of maps", {}},
                  {items_, items * kBytesAnItem, "caster items", {}},
                  {draw_counts_, sizeof(shared::DrawCounts), "item draw counts", {}}};
  for (Need& need : needs) {
    if (need.target && need.target.size() >= need.bytes) continue;
    auto made = gpu::Buffer::create(device, memory, need.bytes, gpu::MemoryKind::device, need.name);
    if (!made) return made.error();
    need.made = std::move(*made);
  }
  if (auto ok = scan_.reserve(device, memory, 2 * maps, retired); !ok) return ok.error();
  for (Need& need : needs) {
    if (!need.made) continue;
    std::swap(need.target, need.made);
    if (need.made) retired.push_back(std::move(need.made));
  }
  map_capacity_ = maps;
  capacity_ = items;
  return {};
}

shared::ItemPush MapCulling::inputs(gpu::Pass& pass, const Inputs& in) const {
  const scene::BoxTree& tree = in.scene.caster_tree();
  pass.read(in.scene.light_buffer());
  pass.read(in.views);
  pass.read(in.maps);
  pass.read(in.projection);
  pass.read(in.receiver_depth);
  pass.read(in.counters, gpu::Access::indirect_read);
  return {.frame = pass.read(in.frame),
          .casters = pass.read(in.scene.caster_buffer()),
          .instances = pass.read(in.scene.instance_buffer()),
          .batches = pass.read(in.scene.batch_buffer()),
          .order = pass.read(tree.order()),
          .leaves = pass.read(tree.leaves()),
          .nodes = pass.read(tree.nodes()),
          .shape = in.tree_shape};
}

void MapCulling::record_count(gpu::Recorder& recorder, const Inputs& in) {
  gpu::Scope scope(recorder, "count items");
  {
    gpu::Pass pass = recorder.pass("count items");
    shared::ItemPush push = inputs(pass, in);
    push.counts = pass.write(counts_), push.totals = pass.write(totals_);
    pass.dispatch_indirect(count_[static_cast<size_t>(in.mode)], push, in.counters, kMapGroups);
  }
  scan_.record(recorder, totals_, {in.counters, offsetof(shared::FrameCounters, maps), 2}, 2 * map_capacity_,
               in.counters, offsetof(shared::FrameCounters, caster_pairs));
}

void MapCulling::record_round(gpu::Recorder& recorder, const Inputs& in, uint32_t round) {
  gpu::Scope scope(recorder, "write items");
  {
    // With no map at all no workgroup runs that could write them.
    gpu::Pass pass = recorder.pass("clear item draw counts");
    pass.write(draw_counts_, gpu::Access::transfer_write);
    recorder.device().vk().vkCmdFillBuffer(pass.commands(), draw_counts_.handle(), 0, VK_WHOLE_SIZE, 0);
  }
  gpu::Pass pass = recorder.pass("write items");
  shared::ItemPush push = inputs(pass, in);
  push.counts = pass.read(counts_), push.totals = pass.read(totals_), push.counters = pass.write(in.counters);
  pass.write(in.maps);
  push.items = pass.write(items_), push.draw_counts = pass.write(draw_counts_), push.used = pass.write(in.used_lights);
  push.window_first = round * capacity_;
  push.window_size = capacity_;
  pass.dispatch_indirect(write_[static_cast<size_t>(in.mode)], push, in.counters, kMapGroups);
}

}  // namespace umbrage::culling
