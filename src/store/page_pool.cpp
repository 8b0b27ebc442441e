// Units of words → exclusive sums: where each word's pages begin.
#include "store/page_pool.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace umbrage::store {

namespace {
constexpr uint32_t kClear[] =
#include "shaders/clear_pages.comp.inc"
    ;
constexpr uint64_t kUnitBytes = shared::PoolUnit * sizeof(uint32_t);
/// A light's map of the coarsest level and its whole map, a unit each.
constexpr uint64_t kUnitsPerView = 2;
constexpr uint32_t kFinest = 1u << shared::MaxLevel;
}  // namespace

LeastRoom least_room_of_pool(uint64_t budget_bytes) {
  constexpr uint64_t kBytes = kUnitsPerView * kUnitBytes;
  return {budget_bytes / kBytes, kBytes};
}

ViewCount number_views(IdPool<scene::HostLight>& lights, const LeastRoom& room, uint32_t sun_views,
                       std::vector<uint32_t>& changed, std::vector<LightStatus>& without) {
  without.clear();
  const auto views_of = [&](uint32_t slot) {
    return lights.at(slot).record.views == shared::ViewsCube ? shared::CubeFaceCount : 1u;
  };
  std::vector<uint32_t> casting;
  uint64_t views = 0;
  for (uint32_t slot = 0; slot < lights.slots(); ++slot) {
    if (!lights.alive(slot) || !lights.at(slot).needs_map()) continue;
    casting.push_back(slot);
    views += views_of(slot);
  }
  std::vector<bool> has_map(lights.slots(), false);
  std::stable_sort(casting.begin(), casting.end(),
                   [&](uint32_t a, uint32_t b) { return lights.at(a).desc.priority > lights.at(b).desc.priority; });
  while (views > room.views) {
    const uint32_t slot = casting.back();
    casting.pop_back();
    views -= views_of(slot);
    without.push_back({LightId{lights.id_at(slot)}, Degradation::no_map, views_of(slot) * room.bytes_per_view});
  }
  for (const uint32_t slot : casting) has_map[slot] = true;
  ViewCount numbered;
  const auto number = [&](uint32_t slot) {
    scene::HostLight& light = lights.at(slot);
    const uint32_t count = has_map[slot] ? views_of(slot) : 0;
    const uint32_t resolution =
        light.desc.max_resolution ? std::clamp(light.desc.max_resolution, 1u << shared::MinLevel, kFinest) : kFinest;
    shared::LightRecord& record = light.record;
    if (record.first_view != numbered.views || record.view_count != count || record.resolution != resolution) {
      record.first_view = numbered.views, record.view_count = count, record.resolution = resolution;
      changed.push_back(slot);
    }
    const bool is_sun = count > 0 && record.views == shared::ViewsOrtho;
    numbered.views += is_sun ? sun_views : count;
    numbered.suns += is_sun;
  };
  // Suns first: a table of their views needs no room for others.
  for (const bool suns : {true, false})
    for (uint32_t slot = 0; slot < lights.slots(); ++slot)
      if (lights.alive(slot) && (lights.at(slot).record.views == shared::ViewsOrtho) == suns) number(slot);
  return numbered;
}

Result<PagePool> PagePool::create(const gpu::PipelineFactory& factory) {
  PagePool out;
  auto scan = gpu::PrefixSum::create(factory);
  if (!scan) return scan.error();
  out.scan_ = std::move(*scan);
  auto clear = factory.compute(kClear, "clear pages");
  if (!clear) return clear.error();
  out.clear_ = std::move(*clear);
  return out;
}

Result<void> PagePool::reserve(const gpu::Device& device, gpu::Memory& memory, uint64_t budget_bytes,
                               uint32_t word_capacity, std::vector<gpu::Buffer>& retired) {
  if (auto ok = gpu::grow(pool_, device, memory, budget_bytes, "page pool", retired); !ok) return ok;
  if (auto ok =
          gpu::grow(texel_bits_, device, memory, budget_bytes / kUnitBytes * sizeof(uint32_t), "texel bits", retired);
      !ok)
    return ok;
  if (auto ok = gpu::grow(total_, device, memory, sizeof(uint32_t), "units in use", retired); !ok) return ok;
  return scan_.reserve(device, memory, word_capacity, retired);
}

uint32_t PagePool::capacity_units() const {
  return static_cast<uint32_t>(std::min<uint64_t>(pool_.size() / kUnitBytes, 0x7fffffffu));
}

void PagePool::record(gpu::Recorder& recorder, const maps::Maps& maps, const gpu::Buffer& frame,
                      const gpu::Buffer& counters) {
  {
    gpu::Scope scope(recorder, "place pages");
    scan_.record(recorder, maps.page_first(), maps.sizes().words, total_, 0);
  }
  gpu::Scope scope(recorder, "clear pages");
  gpu::Pass pass = recorder.pass("clear pages");
  const shared::MapsPush push{.frame = pass.read(frame), .counters = pass.read(counters)};
  pass.read(counters, gpu::Access::indirect_read);
  pass.write(pool_), pass.write(texel_bits_);
  pass.dispatch_indirect(clear_, push, counters, offsetof(shared::FrameCounters, clear_groups));
}

}  // namespace umbrage::store
