// Bounds → Morton keys → stable radix sort (8 passes of 4 bits) → levels of nodes.
#include "scene/box_tree.hpp"

#include <algorithm>

#include "scene/tree_push.shared.h"

namespace umbrage::scene {

namespace {
constexpr uint32_t kReduceBounds[] =
#include "shaders/reduce_bounds.comp.inc"
    ;
constexpr uint32_t kMakeKeys[] =
#include "shaders/make_keys.comp.inc"
    ;
constexpr uint32_t kSortCount[] =
#include "shaders/sort_count.comp.inc"
    ;
constexpr uint32_t kSortScan[] =
#include "shaders/sort_scan.comp.inc"
    ;
constexpr uint32_t kSortScatter[] =
#include "shaders/sort_scatter.comp.inc"
    ;
constexpr uint32_t kBuildNodes[] =
#include "shaders/build_nodes.comp.inc"
    ;

constexpr uint32_t groups(uint32_t items, uint32_t per_group) { return (items + per_group - 1) / per_group; }
}  // namespace

shared::TreeShape tree_shape(uint32_t count) {
  shared::TreeShape shape{};
  shape.count = count;
  uint32_t first = 0;
  for (uint32_t below = count; below > 0 && shape.levels < shared::MaxTreeLevels;) {
    const uint32_t nodes = groups(below, shared::TreeWidth);
    shape.first[shape.levels] = first;
    shape.nodes[shape.levels] = nodes;
    ++shape.levels;
    first += nodes;
    below = nodes > 1 ? nodes : 0;
  }
  return shape;
}

Result<TreePipelines> TreePipelines::create(const gpu::PipelineFactory& factory) {
  TreePipelines out;
  const struct {
    gpu::Pipeline& target;
    std::span<const uint32_t> spirv;
    const char* name;
  } all[] = {{out.reduce_bounds, kReduceBounds, "reduce bounds"}, {out.make_keys, kMakeKeys, "make keys"},
             {out.sort_count, kSortCount, "sort: count"},         {out.sort_scan, kSortScan, "sort: scan"},
             {out.sort_scatter, kSortScatter, "sort: scatter"},   {out.build_nodes, kBuildNodes, "build nodes"}};
  for (const auto& entry : all) {
    auto made = factory.compute(entry.spirv, entry.name);
    if (!made) return made.error();
    entry.target = std::move(*made);
  }
  return out;
}

Result<void> BoxTree::reserve(const gpu::Device& device, gpu::Memory& memory, uint32_t count,
                              std::vector<gpu::Buffer>& retired) {
  if (count <= capacity_ && bounds_) return {};
  const uint32_t capacity = std::max(count + count / 2, 256u);
  const shared::TreeShape shape = tree_shape(capacity);
  uint32_t nodes = 0;
  for (uint32_t level = 0; level < shape.levels; ++level) nodes += shape.nodes[level];
  const VkDeviceSize words = capacity * sizeof(uint32_t);
  struct Need {
    gpu::Buffer& target;
    VkDeviceSize size;
    const char* name;
    gpu::Buffer made;
  };
  Need needs[] = {
      {keys_[0], words, "tree keys", {}},
      {keys_[1], words, "tree keys (other)", {}},
      {values_[0], words, "tree order", {}},
      {values_[1], words, "tree order (other)", {}},
      {counts_, groups(capacity, shared::SortBlock) * shared::SortDigits * sizeof(uint32_t), "sort counts", {}},
      {leaves_, capacity * sizeof(shared::Box), "tree leaves", {}},
      {nodes_, nodes * sizeof(shared::Box), "tree nodes", {}},
      {bounds_, 6 * sizeof(uint32_t), "tree bounds", {}}};
  for (Need& need : needs) {
    auto made = gpu::Buffer::create(device, memory, need.size, gpu::MemoryKind::device, need.name);
    if (!made) return made.error();
    need.made = std::move(*made);
  }
  for (Need& need : needs) {
    std::swap(need.target, need.made);
    if (need.made) retired.push_back(std::move(need.made));
  }
  capacity_ = capacity;
  return {};
}

void BoxTree::record(gpu::Recorder& recorder, const TreePipelines& pipelines, const gpu::Buffer& boxes,
                     uint32_t count) {
  shape_ = tree_shape(count);
  {
    gpu::Pass pass = recorder.pass("clear bounds");
    pass.write(bounds_, gpu::Access::transfer_write);
    const VkCommandBuffer commands = pass.commands();
    recorder.device().vk().vkCmdFillBuffer(commands, bounds_.handle(), 0, 12, 0xffffffffu);
    recorder.device().vk().vkCmdFillBuffer(commands, bounds_.handle(), 12, 12, 0);
  }
  if (count == 0) return;
  {
    gpu::Pass pass = recorder.pass("reduce bounds");
    const shared::BoundsPush push{.boxes = pass.read(boxes), .bounds = pass.write(bounds_), .count = count};
    pass.dispatch(pipelines.reduce_bounds, push, groups(count, 128 * 16));
  }
  {
    gpu::Pass pass = recorder.pass("make keys");
    const shared::BoundsPush push{.boxes = pass.read(boxes),
                                  .bounds = pass.read(bounds_),
                                  .keys = pass.write(keys_[0]),
                                  .values = pass.write(values_[0]),
                                  .count = count};
    pass.dispatch(pipelines.make_keys, push, groups(count, 128));
  }
  const uint32_t blocks = groups(count, shared::SortBlock);
  for (uint32_t i = 0; i < shared::SortPasses; ++i) {
    const gpu::Buffer &keys_in = keys_[i % 2], &values_in = values_[i % 2], &keys_out = keys_[1 - i % 2],
                      &values_out = values_[1 - i % 2];
    shared::SortPush push{.count = count, .blocks = blocks, .shift = 4 * i};
    {
      gpu::Pass pass = recorder.pass("sort: count");
      push.keys_in = pass.read(keys_in), push.counts = pass.write(counts_);
      pass.dispatch(pipelines.sort_count, push, blocks);
    }
    {
      gpu::Pass pass = recorder.pass("sort: scan");
      pass.write(counts_);
      pass.dispatch(pipelines.sort_scan, push, 1);
    }
    gpu::Pass pass = recorder.pass("sort: scatter");
    pass.read(counts_);
    push.keys_in = pass.read(keys_in), push.values_in = pass.read(values_in);
    push.keys_out = pass.write(keys_out), push.values_out = pass.write(values_out);
    pass.dispatch(pipelines.sort_scatter, push, blocks);
  }
  for (uint32_t level = 0; level < shape_.levels; ++level) {
    gpu::Pass pass = recorder.pass("build nodes");
    const bool leaf_level = level == 0;
    shared::NodesPush push{.child_count = leaf_level ? count : shape_.nodes[level - 1], .is_leaf_level = leaf_level};
    push.nodes = pass.write(nodes_) + shape_.first[level] * sizeof(shared::Box);
    if (leaf_level) {
      push.boxes = pass.read(boxes), push.order = pass.read(order()), push.leaves = pass.write(leaves_);
    } else {
      push.boxes = nodes_.address() + shape_.first[level - 1] * sizeof(shared::Box);
    }
    pass.dispatch(pipelines.build_nodes, push, groups(shape_.nodes[level], 32));
  }
}

}  // namespace umbrage::scene
