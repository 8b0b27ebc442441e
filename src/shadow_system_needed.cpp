// The public oracle over raster/needed_triangles.
#include "umbrage/needed_triangles.hpp"

#include "raster/needed_triangles.hpp"
#include "shadow_system_state.hpp"

namespace umbrage {

struct NeededTriangles::State {
  ShadowSystem& system;
  raster::NeededTriangles counter;
};

NeededTriangles::NeededTriangles(std::unique_ptr<State> state) : state_(std::move(state)) {}
NeededTriangles::NeededTriangles(NeededTriangles&&) noexcept = default;
NeededTriangles& NeededTriangles::operator=(NeededTriangles&&) noexcept = default;
NeededTriangles::~NeededTriangles() = default;

Result<NeededTriangles> NeededTriangles::create(ShadowSystem& system) {
  auto& state = SystemAccess::state(system);
  if (state.settings.store != Store::page_pool)
    return Error{ErrorCode::invalid_argument, "NeededTriangles: only the texels of store=page_pool can be told apart"};
  auto counter = raster::NeededTriangles::create(*state.pipelines);
  if (!counter) return counter.error();
  return NeededTriangles(std::unique_ptr<State>(new State{system, std::move(*counter)}));
}

Result<void> NeededTriangles::record(VkCommandBuffer commands, VkDeviceAddress texels, VkDeviceAddress count) {
  auto& s = SystemAccess::state(state_->system);
  if (!s.current) return Error{ErrorCode::invalid_argument, "NeededTriangles::record: no frame has been recorded"};
  gpu::Recorder recorder(*s.device, *s.pipelines, commands, nullptr, s.current->frame_sets[0], s.mask_set,
                         s.hazard_log);
  Frame& frame = *s.frame;
  for (uint32_t round = 0; round < s.plan.caster_rounds; ++round) {
    frame.map_culling.record_round(recorder, frame.cull_inputs(s.plan), round);
    state_->counter.record(recorder, frame.page_inputs(s.plan), texels, count);
  }
  return {};
}

}  // namespace umbrage
