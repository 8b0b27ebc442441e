// One resolution for all: the largest power of two that fits budget and image limits.
#include "store/fixed_cubes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace umbrage::store {

namespace {
constexpr uint64_t kTexelBytes = sizeof(uint32_t);

uint32_t views_of(const scene::HostLight& light) {
  if (!light.needs_map()) return 0;
  return light.record.views == shared::ViewsCube ? shared::CubeFaceCount : 1;
}

/// The squarest grid of tiles for so many views.
AtlasLayout grid(uint32_t views, uint32_t resolution, uint32_t max_side) {
  const uint32_t widest = std::max(max_side / resolution, 1u);
  AtlasLayout layout{.resolution = resolution, .views = views};
  layout.columns = std::clamp(static_cast<uint32_t>(std::ceil(std::sqrt(double(views)))), 1u, widest);
  layout.rows = std::max((views + layout.columns - 1) / layout.columns, 1u);
  return layout;
}

bool fits(const AtlasLayout& layout, uint64_t budget_bytes, uint32_t max_side) {
  return layout.rows * layout.resolution <= max_side &&
         uint64_t(layout.columns) * layout.rows * layout.resolution * layout.resolution * kTexelBytes <= budget_bytes;
}
}  // namespace

AtlasLayout lay_out(IdPool<scene::HostLight>& lights, uint64_t budget_bytes, uint32_t max_side,
                    const FrameSettings& settings, std::vector<uint32_t>& changed, std::vector<LightStatus>& without) {
  without.clear();
  std::vector<uint32_t> casting;
  uint32_t views = 0;
  for (uint32_t slot = 0; slot < lights.slots(); ++slot) {
    if (!lights.alive(slot) || views_of(lights.at(slot)) == 0) continue;
    casting.push_back(slot);
    views += views_of(lights.at(slot));
  }
  const uint32_t finest = std::clamp(settings.max_resolution, 16u, 1024u),
                 coarsest = std::clamp(settings.min_resolution, 16u, 1024u);
  AtlasLayout layout = grid(views, finest, max_side);
  while (layout.resolution > coarsest && !fits(layout, budget_bytes, max_side))
    layout = grid(views, layout.resolution / 2, max_side);
  if (!fits(layout, budget_bytes, max_side)) {
    std::stable_sort(casting.begin(), casting.end(),
                     [&](uint32_t a, uint32_t b) { return lights.at(a).desc.priority > lights.at(b).desc.priority; });
    while (!fits(layout, budget_bytes, max_side) && !casting.empty()) {
      const uint32_t slot = casting.back();
      casting.pop_back();
      views -= views_of(lights.at(slot));
      without.push_back({LightId{lights.id_at(slot)}, Degradation::no_map,
                         views_of(lights.at(slot)) * kTexelBytes * layout.resolution * layout.resolution});
      layout = grid(views, layout.resolution, max_side);
    }
    std::sort(casting.begin(), casting.end());
  }

  std::vector<bool> has_map(lights.slots(), false);
  for (const uint32_t slot : casting) has_map[slot] = true;
  uint32_t next = 0;
  for (uint32_t slot = 0; slot < lights.slots(); ++slot) {
    if (!lights.alive(slot)) continue;
    scene::HostLight& light = lights.at(slot);
    const uint32_t count = has_map[slot] ? views_of(light) : 0;
    const uint32_t limit =
        light.desc.max_resolution ? std::max(std::bit_floor(light.desc.max_resolution), 16u) : layout.resolution;
    const uint32_t resolution = std::min(layout.resolution, limit);
    shared::LightRecord& record = light.record;
    if (record.first_view != next || record.view_count != count || record.resolution != resolution) {
      record.first_view = next, record.view_count = count, record.resolution = resolution;
      changed.push_back(slot);
    }
    next += count;
    layout.maps += count > 0;
  }
  return layout;
}

Result<void> FixedCubes::reserve(const gpu::Device& device, gpu::Memory& memory, const AtlasLayout& layout,
                                 gpu::RetireQueue& retired, uint64_t serial) {
  const uint32_t width = layout.columns * layout.resolution, height = layout.rows * layout.resolution;
  if (!atlas_ || atlas_.width() != width || atlas_.height() != height) {
    auto made = gpu::Image::create(device, memory, {.width = width, .height = height}, "shadow atlas");
    if (!made) return made.error();
    if (atlas_) retired.retire(std::move(atlas_), serial);
    atlas_ = std::move(*made);
  }
  layout_ = layout;
  return {};
}

void FixedCubes::fill(shared::FrameRecord& frame) const {
  frame.atlas_columns = layout_.columns;
  frame.atlas_resolution = layout_.resolution;
}

}  // namespace umbrage::store
