// One dispatch: a thread a light.
#include "maps/views.hpp"

#include <algorithm>

namespace umbrage::maps {

namespace {
constexpr uint32_t kBuildViews[] =
#include "shaders/build_views.comp.inc"
    ;
}  // namespace

Result<Views> Views::create(const gpu::PipelineFactory& factory) {
  Views out;
  auto made = factory.compute(kBuildViews, "build views");
  if (!made) return made.error();
  out.build_ = std::move(*made);
  return out;
}

Result<void> Views::reserve(const gpu::Device& device, gpu::Memory& memory, uint32_t views,
                            std::vector<gpu::Buffer>& retired) {
  return gpu::grow(views_, device, memory, std::max(views, 1u) * sizeof(shared::ShadowView), "shadow views", retired);
}

void Views::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Buffer& counters,
                   const scene::GpuScene& scene, const gpu::Buffer& used_lights, bool all_lights) {
  if (scene.light_slots() == 0) return;
  gpu::Scope scope(recorder, "views");
  gpu::Pass pass = recorder.pass("build views");
  const shared::BuildViewsPush push{.frame = pass.read(frame),
                                    .lights = pass.read(scene.light_buffer()),
                                    .used = pass.write(used_lights),
                                    .counters = pass.write(counters),
                                    .views = pass.write(views_),
                                    .scene_bounds = pass.read(scene.caster_tree().bounds()),
                                    .light_slots = scene.light_slots(),
                                    .all_lights = all_lights};
  pass.dispatch(build_, push, (scene.light_slots() + 31) / 32);
}

}  // namespace umbrage::maps
