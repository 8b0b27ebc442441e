// Three dispatches, whatever the count.
#include "gpu/prefix_sum.hpp"

#include <algorithm>

#include "gpu/scan.shared.h"

namespace umbrage::gpu {

namespace {
constexpr uint32_t kSum[] =
#include "shaders/scan_sum.comp.inc"
    ;
constexpr uint32_t kBlocks[] =
#include "shaders/scan_blocks.comp.inc"
    ;
constexpr uint32_t kItems[] =
#include "shaders/scan_items.comp.inc"
    ;
constexpr uint32_t blocks_of(uint32_t count) {
  return std::max((count + shared::ScanBlock - 1) / shared::ScanBlock, 1u);
}
}  // namespace

Result<PrefixSum> PrefixSum::create(const PipelineFactory& factory) {
  PrefixSum out;
  const struct {
    Pipeline& target;
    std::span<const uint32_t> spirv;
    const char* name;
  } all[] = {
      {out.sum_, kSum, "scan: sum"}, {out.blocks_, kBlocks, "scan: blocks"}, {out.items_, kItems, "scan: items"}};
  for (const auto& entry : all) {
    auto made = factory.compute(entry.spirv, entry.name);
    if (!made) return made.error();
    entry.target = std::move(*made);
  }
  return out;
}

Result<void> PrefixSum::reserve(const Device& device, Memory& memory, uint32_t count, std::vector<Buffer>& retired) {
  const VkDeviceSize bytes = blocks_of(count) * sizeof(uint32_t);
  if (sums_ && sums_.size() >= bytes) return {};
  auto made = Buffer::create(device, memory, bytes, MemoryKind::device, "scan sums");
  if (!made) return made.error();
  if (sums_) retired.push_back(std::move(sums_));
  sums_ = std::move(*made);
  return {};
}

void PrefixSum::record(Recorder& recorder, const Buffer& values, uint32_t count, const Buffer& total,
                       VkDeviceSize total_offset) {
  record(recorder, values, nullptr, count, total, total_offset);
}

void PrefixSum::record(Recorder& recorder, const Buffer& values, const DeviceCount& counted, uint32_t capacity,
                       const Buffer& total, VkDeviceSize total_offset) {
  record(recorder, values, &counted, capacity, total, total_offset);
}

void PrefixSum::record(Recorder& recorder, const Buffer& values, const DeviceCount* counted, uint32_t capacity,
                       const Buffer& total, VkDeviceSize total_offset) {
  const uint32_t blocks = blocks_of(capacity);
  shared::ScanPush push{.count = capacity};
  const auto read_count = [&](Pass& pass) {
    if (counted) push.counted = pass.read(counted->buffer) + counted->offset, push.scale = counted->scale;
  };
  {
    Pass pass = recorder.pass("scan: sum");
    read_count(pass);
    push.values = pass.read(values), push.sums = pass.write(sums_);
    pass.dispatch(sum_, push, blocks);
  }
  {
    Pass pass = recorder.pass("scan: blocks");
    read_count(pass);
    push.sums = pass.write(sums_), push.total = pass.write(total) + total_offset;
    pass.dispatch(blocks_, push, 1);
  }
  Pass pass = recorder.pass("scan: items");
  read_count(pass);
  push.sums = pass.read(sums_), push.values = pass.write(values);
  pass.dispatch(items_, push, blocks);
}

}  // namespace umbrage::gpu
