// Indexed by whether masks are sampled.
#include "raster/page_raster.hpp"

#include <algorithm>
#include <cstddef>

namespace umbrage::raster {

namespace {
constexpr uint32_t kPlan[] =
#include "shaders/plan_dispatches.comp.inc"
    ;
constexpr uint32_t kRasterize[] =
#include "shaders/rasterize_triangles.comp.inc"
    ;
constexpr uint32_t kBin[] =
#include "shaders/bin_triangles.comp.inc"
    ;
constexpr uint32_t kDrawTiles[] =
#include "shaders/draw_tiles.comp.inc"
    ;
constexpr VkDeviceSize kTileBytes = VkDeviceSize(shared::PageSide) * shared::PageSide * sizeof(uint32_t);
/// Shares of tiles that there is room for, per large triangle on average.
constexpr uint32_t kNodesPerTriangle = 8;
}  // namespace

Result<PageRaster> PageRaster::create(const gpu::PipelineFactory& factory) {
  PageRaster out;
  auto plan = factory.compute(kPlan, "plan dispatches");
  if (!plan) return plan.error();
  out.plan_ = std::move(*plan);
  for (uint32_t masked = 0; masked < 2; ++masked) {
    const struct {
      gpu::Pipeline& target;
      std::span<const uint32_t> spirv;
      const char* name;
    } all[] = {{out.rasterize_[masked], kRasterize, masked ? "rasterize triangles, masked" : "rasterize triangles"},
               {out.bin_[masked], kBin, masked ? "bin triangles, masked" : "bin triangles"},
               {out.draw_tiles_[masked], kDrawTiles, masked ? "draw tiles, masked" : "draw tiles"}};
    for (const auto& entry : all) {
      auto made = factory.compute(entry.spirv, entry.name, {{0, masked}});
      if (!made) return made.error();
      entry.target = std::move(*made);
    }
  }
  return out;
}

Result<void> PageRaster::reserve(const gpu::Device& device, gpu::Memory& memory, uint32_t large_triangles,
                                 VkDeviceSize pool_bytes, std::vector<gpu::Buffer>& retired) {
  const uint32_t nodes = std::max(large_triangles, 1u) * kNodesPerTriangle;
  const VkDeviceSize tiles = pool_bytes / kTileBytes + 1;
  struct Need {
    gpu::Buffer& target;
    VkDeviceSize bytes;
    const char* name;
    gpu::Buffer made;
  };
  Need needs[] = {{arguments_, sizeof(shared::RasterArguments), "raster arguments", {}},
                  {appended_, sizeof(shared::RasterCounts), "raster counts", {}},
                  {triangles_, std::max(large_triangles, 1u) * sizeof(shared::RasterTriangle), "large triangles", {}},
                  {nodes_, nodes * sizeof(shared::TileNode), "tile nodes", {}},
                  {heads_, tiles * sizeof(uint32_t), "tile heads", {}},
                  {tiles_, tiles * sizeof(shared::RasterTile), "raster tiles", {}}};
  for (Need& need : needs) {
    if (need.target && need.target.size() >= need.bytes) continue;
    auto made = gpu::Buffer::create(device, memory, need.bytes, gpu::MemoryKind::device, need.name);
    if (!made) return made.error();
    need.made = std::move(*made);
  }
  for (Need& need : needs) {
    if (!need.made) continue;
    std::swap(need.target, need.made);
    if (need.made) retired.push_back(std::move(need.made));
  }
  large_capacity_ = large_triangles;
  node_capacity_ = large_triangles * kNodesPerTriangle;
  return {};
}

void PageRaster::record(gpu::Recorder& recorder, const PageWriterInputs& in) {
  const bool masked = in.scene.has_masked();
  shared::PageRasterPush push{.frame = in.frame.address(),
                              .casters = in.scene.caster_buffer().address(),
                              .instances = in.scene.instance_buffer().address(),
                              .batches = in.scene.batch_buffer().address(),
                              .indices = in.scene.index_buffer().address(),
                              .items = in.items.address(),
                              .counts = in.counts.address(),
                              .arguments = arguments_.address(),
                              .appended = appended_.address(),
                              .triangles = triangles_.address(),
                              .nodes = nodes_.address(),
                              .heads = heads_.address(),
                              .tiles = tiles_.address(),
                              .counters = in.counters ? in.counters->address() : 0,
                              .item_capacity = in.item_capacity,
                              .large_capacity = large_capacity_,
                              .node_capacity = node_capacity_,
                              .flags = shared::PlanItems};
  const auto plan = [&](uint32_t step) {
    gpu::Pass pass = recorder.pass("plan dispatches");
    pass.read(in.counts);
    if (in.counters) pass.write(*in.counters);
    pass.write(arguments_);
    pass.write(appended_);
    push.flags = step;
    pass.dispatch(plan_, push, 1);
  };
  const auto read_places = [&](gpu::Pass& pass) {
    for (const gpu::Buffer* buffer : {&in.frame, &in.maps, &in.page_bits, &in.page_first, &in.scene.batch_buffer()})
      pass.read(*buffer);
    pass.write(in.pool);
    pass.read(arguments_, gpu::Access::indirect_read);
    if (in.receiver_depth) pass.read(*in.receiver_depth);
    if (in.texel_bits) pass.read(*in.texel_bits);
    push.flags = (in.receiver_depth ? shared::TestReceivers : 0u) | (in.texel_bits ? shared::TestTexels : 0u);
  };
  {
    gpu::Pass pass = recorder.pass("clear tile heads");
    pass.write(heads_, gpu::Access::transfer_write);
    recorder.device().vk().vkCmdFillBuffer(pass.commands(), heads_.handle(), 0, VK_WHOLE_SIZE, shared::NoIndex);
  }
  plan(shared::PlanItems);
  {
    gpu::Scope scope(recorder, "rasterize triangles");
    gpu::Pass pass = recorder.pass("rasterize triangles");
    read_places(pass);
    for (const gpu::Buffer* buffer : {&in.views, &in.items, &in.counts}) pass.read(*buffer);
    for (const gpu::Buffer* buffer : {&in.scene.caster_buffer(), &in.scene.instance_buffer(), &in.scene.index_buffer()})
      pass.read(*buffer);
    pass.write(appended_);
    pass.write(triangles_);
    for (uint32_t kind = 0; kind < (masked ? 2u : 1u); ++kind)
      pass.dispatch_indirect(rasterize_[kind], push, arguments_,
                             offsetof(shared::RasterArguments, items) + kind * 3 * sizeof(uint32_t));
  }
  plan(shared::PlanTriangles);
  {
    gpu::Scope scope(recorder, "bin triangles");
    gpu::Pass pass = recorder.pass("bin triangles");
    read_places(pass);
    pass.read(triangles_), pass.read(in.views);
    for (const gpu::Buffer* buffer : {&appended_, &nodes_, &heads_, &tiles_}) pass.write(*buffer);
    pass.dispatch_indirect(bin_[masked], push, arguments_, offsetof(shared::RasterArguments, triangles));
  }
  plan(shared::PlanTiles);
  gpu::Scope scope(recorder, "draw tiles");
  gpu::Pass pass = recorder.pass("draw tiles");
  read_places(pass);
  for (const gpu::Buffer* buffer : {&appended_, &triangles_, &nodes_, &heads_, &tiles_}) pass.read(*buffer);
  pass.dispatch_indirect(draw_tiles_[masked], push, arguments_, offsetof(shared::RasterArguments, tiles));
}

}  // namespace umbrage::raster
