// Assign → count → compact → count lights → scan → write lights.
#include "clusters/clusters.hpp"

#include <algorithm>
#include <cstddef>

namespace umbrage::clusters {

namespace {
constexpr uint32_t kAssign[] =
#include "shaders/assign_clusters.comp.inc"
    ;
constexpr uint32_t kCount[] =
#include "shaders/count_clusters.comp.inc"
    ;
constexpr uint32_t kCompact[] =
#include "shaders/compact_clusters.comp.inc"
    ;
constexpr uint32_t kListLights[] =
#include "shaders/list_lights.comp.inc"
    ;
}  // namespace

Result<Clusters> Clusters::create(const gpu::PipelineFactory& factory) {
  Clusters out;
  auto scan = gpu::PrefixSum::create(factory);
  if (!scan) return scan.error();
  out.scan_ = std::move(*scan);
  const struct {
    gpu::Pipeline& target;
    std::span<const uint32_t> spirv;
    const char* name;
    uint32_t writes, brute_force;
  } all[] = {{out.assign_, kAssign, "assign clusters", 0, 0},
             {out.count_, kCount, "count clusters", 0, 0},
             {out.compact_, kCompact, "compact clusters", 0, 0},
             {out.count_lights_[0], kListLights, "count lights", 0, 0},
             {out.write_lights_[0], kListLights, "write lights", 1, 0},
             {out.count_lights_[1], kListLights, "count lights, brute force", 0, 1},
             {out.write_lights_[1], kListLights, "write lights, brute force", 1, 1}};
  for (const auto& entry : all) {
    auto made = factory.compute(entry.spirv, entry.name, {{0, entry.writes}, {1, entry.brute_force}});
    if (!made) return made.error();
    entry.target = std::move(*made);
  }
  return out;
}

Result<void> Clusters::reserve(const gpu::Device& device, gpu::Memory& memory, uint32_t tile_count,
                               uint32_t pair_capacity, uint32_t light_slots, std::vector<gpu::Buffer>& retired) {
  const uint32_t clusters = std::max(tile_count * shared::ClustersPerTile, 4096u);
  const VkDeviceSize tiles = tile_count;
  struct Need {
    gpu::Buffer& target;
    VkDeviceSize bytes;
    const char* name;
    gpu::Buffer made;
  };
  Need needs[] = {{words_, tiles * shared::SliceWords * sizeof(shared::ClusterWord), "cluster words", {}},
                  {found_, tiles * shared::MaxSlices * sizeof(shared::FoundCluster), "found clusters", {}},
                  {tile_counts_, tiles * sizeof(uint32_t), "tile counts", {}},
                  {cells_, clusters * sizeof(uint32_t), "cluster cells", {}},
                  {boxes_, clusters * sizeof(shared::Box), "cluster boxes", {}},
                  {cones_, clusters * sizeof(glm::vec4), "cluster cones", {}},
                  {counts_, clusters * sizeof(uint32_t), "cluster light counts", {}},
                  {lists_, clusters * sizeof(shared::ClusterList), "cluster lists", {}},
                  {lights_, pair_capacity * sizeof(uint32_t), "cluster lights", {}},
                  {pair_clusters_, pair_capacity * sizeof(uint32_t), "clusters of pairs", {}},
                  {used_, std::max(light_slots, 1u) * sizeof(uint32_t), "used lights", {}}};
  for (Need& need : needs) {
    if (need.target && need.target.size() >= need.bytes) continue;
    auto made = gpu::Buffer::create(device, memory, need.bytes, gpu::MemoryKind::device, need.name);
    if (!made) return made.error();
    need.made = std::move(*made);
  }
  if (auto ok = scan_.reserve(device, memory, clusters, retired); !ok) return ok.error();
  for (Need& need : needs) {
    if (!need.made) continue;
    std::swap(need.target, need.made);
    if (need.made) retired.push_back(std::move(need.made));
  }
  cluster_capacity_ = clusters;
  pair_capacity_ = static_cast<uint32_t>(lights_.size() / sizeof(uint32_t));
  light_slots_ = light_slots;
  return {};
}

void Clusters::fill(shared::FrameRecord& frame) const {
  frame.cluster_words = words_.address();
  frame.cluster_cells = cells_.address();
  frame.cluster_boxes = boxes_.address();
  frame.cluster_cones = cones_.address();
  frame.cluster_lists = lists_.address();
  frame.cluster_lights = lights_.address();
  frame.cluster_capacity = cluster_capacity_;
  frame.pair_capacity = pair_capacity_;
}

void Clusters::record_clusters(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Buffer& counters,
                               std::span<const FrameCamera> cameras) {
  {
    gpu::Scope scope(recorder, "assign clusters");
    gpu::Pass pass = recorder.pass("assign clusters");
    pass.read(frame);
    shared::AssignPush push{
        .words = pass.write(words_), .found = pass.write(found_), .tile_counts = pass.write(tile_counts_)};
    for (const FrameCamera& camera : cameras) {
      recorder.use_frame_set(camera.images);
      push.camera = camera.record, push.normal_encoding = static_cast<uint32_t>(camera.normal_encoding);
      pass.dispatch(assign_, push, camera.tiles.x, camera.tiles.y);
    }
    recorder.use_frame_set(cameras[0].images);
  }
  gpu::Scope scope(recorder, "compact clusters");
  shared::CompactPush push{};
  {
    gpu::Pass pass = recorder.pass("count clusters");
    push.frame = pass.read(frame), push.tile_counts = pass.write(tile_counts_), push.counters = pass.write(counters);
    pass.dispatch(count_, push, 1);
  }
  gpu::Pass pass = recorder.pass("compact clusters");
  push.frame = pass.read(frame), push.words = pass.write(words_), push.found = pass.read(found_);
  push.tile_counts = pass.read(tile_counts_), push.counters = pass.read(counters), push.cells = pass.write(cells_);
  push.boxes = pass.write(boxes_), push.cones = pass.write(cones_);
  for (const FrameCamera& camera : cameras) {
    push.camera = camera.record;
    pass.dispatch(compact_, push, camera.tiles.x, camera.tiles.y);
  }
}

void Clusters::record_lights(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Buffer& counters,
                             const scene::GpuScene& scene, VkDeviceAddress tree_shape, LightAssignment assignment) {
  gpu::Scope scope(recorder, "light lists");
  const size_t brute_force = assignment == LightAssignment::brute_force;
  {
    gpu::Pass pass = recorder.pass("clear used lights");
    pass.write(used_, gpu::Access::transfer_write);
    recorder.device().vk().vkCmdFillBuffer(pass.commands(), used_.handle(), 0, VK_WHOLE_SIZE, 0);
  }
  shared::LightListPush push{.shape = tree_shape};
  const auto inputs = [&](gpu::Pass& pass) {
    push.frame = pass.read(frame), push.boxes = pass.read(boxes_), push.lights = pass.read(scene.light_buffer());
    push.order = pass.read(scene.light_tree().order()), push.nodes = pass.read(scene.light_tree().nodes());
    pass.read(scene.light_order_buffer());
  };
  const uint32_t groups = (cluster_capacity_ + 63) / 64;
  {
    gpu::Pass pass = recorder.pass("count lights");
    inputs(pass);
    push.counters = pass.read(counters), push.counts = pass.write(counts_);
    pass.dispatch(count_lights_[brute_force], push, groups);
  }
  scan_.record(recorder, counts_, cluster_capacity_, counters, offsetof(shared::FrameCounters, pairs_found));
  gpu::Pass pass = recorder.pass("write lights");
  inputs(pass);
  pass.read(counters, gpu::Access::indirect_read);
  push.counters = pass.write(counters), push.counts = pass.read(counts_), push.lists = pass.write(lists_);
  push.cluster_lights = pass.write(lights_), push.used = pass.write(used_),
  push.pair_clusters = pass.write(pair_clusters_);
  pass.dispatch_indirect(write_lights_[brute_force], push, counters, 0);
}

}  // namespace umbrage::clusters
