// Indexed by whether items are masked.
#include "raster/needed_triangles.hpp"

#include <algorithm>

namespace umbrage::raster {

namespace {
constexpr uint32_t kCount[] =
#include "shaders/count_needed.comp.inc"
    ;
}  // namespace

Result<NeededTriangles> NeededTriangles::create(const gpu::PipelineFactory& factory) {
  NeededTriangles out;
  for (uint32_t masked = 0; masked < 2; ++masked) {
    auto made =
        factory.compute(kCount, masked ? "count needed triangles, masked" : "count needed triangles", {{0, masked}});
    if (!made) return made.error();
    out.count_[masked] = std::move(*made);
  }
  return out;
}

void NeededTriangles::record(gpu::Recorder& recorder, const PageWriterInputs& in, VkDeviceAddress texels,
                             VkDeviceAddress count) const {
  gpu::Pass pass = recorder.pass("count needed triangles");
  for (const gpu::Buffer* buffer :
       {&in.frame, &in.views, &in.maps, &in.page_bits, &in.page_first, &in.items, &in.counts})
    pass.read(*buffer);
  const shared::CountNeededPush push{.frame = in.frame.address(),
                                     .casters = pass.read(in.scene.caster_buffer()),
                                     .instances = pass.read(in.scene.instance_buffer()),
                                     .batches = pass.read(in.scene.batch_buffer()),
                                     .indices = pass.read(in.scene.index_buffer()),
                                     .items = in.items.address(),
                                     .counts = in.counts.address(),
                                     .texels = texels,
                                     .count = count,
                                     .item_capacity = in.item_capacity};
  const uint32_t columns = std::min(in.item_capacity, shared::MaxGroupsX);
  for (uint32_t masked = 0; masked < (in.scene.has_masked() ? 2u : 1u); ++masked)
    pass.dispatch(count_[masked], push, columns, (in.item_capacity + columns - 1) / columns);
}

}  // namespace umbrage::raster
