// What begin_frame decides about the cascades of directional lights, and what frames report of them.
#include <algorithm>
#include <cstring>

#include "shadow_system_state.hpp"

namespace umbrage {

namespace {
cascades::CascadeSettings cascade_settings(const FrameSettings& settings) {
  using cascades::Mode;
  static_assert(static_cast<int>(CascadeMode::guard_band) - 1 == static_cast<int>(Mode::guard_band));
  return {.mode = static_cast<Mode>(static_cast<int>(settings.cascades) - 1),
          .count = settings.cascade_count,
          .resolution = settings.cascade_resolution,
          .distance_m = static_cast<float>(settings.cascade_distance_m),
          .log_share = static_cast<float>(settings.cascade_log_percent) / 100,
          .reach_m = static_cast<float>(settings.cascade_reach_m),
          .guard_texels = settings.cascade_guard_texels,
          .blend = static_cast<float>(settings.cascade_blend_percent) / 100,
          .static_after = settings.static_after_ms * (shared::TicksPerSecond / 1000)};
}
}  // namespace

uint32_t most_cascade_lights(const FrameSettings& settings) {
  return settings.cascades == CascadeMode::none ? 0 : shared::MaxCascades / settings.cascade_count;
}

/// The most important directional lights; further ones keep maps in the store.
void ShadowSystem::State::choose_cascade_lights(const FrameSettings& frame_settings) {
  IdPool<scene::HostLight>& lights = frame->scene.lights();
  std::vector<uint32_t> casting;
  for (uint32_t slot = 0; slot < lights.slots(); ++slot) {
    if (!lights.alive(slot)) continue;
    lights.at(slot).has_cascades = false;
    if (lights.at(slot).desc.type == LightType::directional && lights.at(slot).desc.casts_shadow)
      casting.push_back(slot);
  }
  std::stable_sort(casting.begin(), casting.end(),
                   [&](uint32_t a, uint32_t b) { return lights.at(a).desc.priority > lights.at(b).desc.priority; });
  casting.resize(std::min<size_t>(casting.size(), most_cascade_lights(frame_settings)));
  cascade_lights.clear();
  for (const uint32_t slot : casting) {
    scene::HostLight& light = lights.at(slot);
    light.has_cascades = true;
    cascade_lights.push_back(
        {.slot = slot, .direction_ws = light.record.direction_ws, .light_mask = light.record.light_mask});
  }
}

Result<void> ShadowSystem::State::begin_cascades(FrameSlot& slot, const shared::CameraRecord& camera,
                                                 const FrameDesc& desc) {
  slot.cascades.clear();
  if (cascade_lights.empty()) {
    frame->cascades.stop();
    return {};
  }
  if (auto ok = frame->cascades.prepare(*pipelines); !ok) return ok;
  if (auto ok = frame->cascades.begin(*device, *memory, frame->scene,
                                      {.camera = camera,
                                       .lights = cascade_lights,
                                       .settings = cascade_settings(desc.settings),
                                       .time_s = desc.time_s},
                                      outgrown);
      !ok)
    return ok;
  if (!slot.cascade_states) {
    auto made = gpu::Buffer::create(*device, *memory, shared::MaxCascades * sizeof(shared::CascadeState),
                                    gpu::MemoryKind::readback, "cascade statistics");
    if (!made) return made.error();
    slot.cascade_states = std::move(*made);
  }
  slot.known.shadow_memory_bytes += frame->cascades.map_bytes();
  slot.known.table_memory_bytes = bytes_beside(slot.known.shadow_memory_bytes);
  const shared::CascadeTable& table = frame->cascades.planned();
  for (const shared::CascadeRecord& record : std::span(table.records, table.cascades))
    slot.cascades.push_back({.light = frame->scene.lights().at(record.light).desc.host_index,
                             .begin_m = record.begin_m,
                             .end_m = record.end_m,
                             .texel_m = record.texel_m,
                             .side = record.side});
  return {};
}

void ShadowSystem::State::read_cascade_statistics(const FrameSlot& slot) {
  cascade_statistics.assign(slot.cascades.begin(), slot.cascades.end());
  for (size_t i = 0; i < cascade_statistics.size(); ++i) {
    shared::CascadeState state;
    std::memcpy(&state, slot.cascade_states.mapped() + i * sizeof state, sizeof state);
    CascadeStatistics& cascade = cascade_statistics[i];
    cascade.action = static_cast<CascadeStatistics::Action>(state.action);
    cascade.texels_exposed = state.texels_exposed;
    cascade.static_casters = state.statics;
    cascade.active_casters = state.actives;
    cascade.occluded_casters = state.occluded;
    cascade.static_triangles = state.static_triangles;
    cascade.active_triangles = state.active_triangles;
    statistics.batches_drawn += state.statics + state.actives - state.occluded;
    statistics.triangles_drawn += cascade.static_triangles + cascade.active_triangles;
    statistics.texels_allocated += 3ull * cascade.side * cascade.side;
  }
  statistics.cascades = cascade_statistics;
}

}  // namespace umbrage
