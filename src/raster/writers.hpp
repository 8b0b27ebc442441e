// Casters → depth: the seam behind which every writer lies. Both write the atlas of the fixed-cubes store.
#pragma once
#include "culling/caster_culling.hpp"
#include "raster/raster_types.shared.h"
#include "store/fixed_cubes.hpp"

namespace umbrage::raster {

/// Views whose draws the traditional writer has the device list at once.
constexpr uint32_t kViewsAtOnce = 8;

class Writers {
 public:
  static Result<Writers> create(const gpu::PipelineFactory&);

  struct Inputs {
    const scene::GpuScene& scene;
    const store::FixedCubes& store;
    culling::CasterCulling& culling;
    culling::CasterCulling::Inputs cull;
    uint32_t max_draws;  ///< Of one indirect call on this device.
  };
  /// One pass over the whole atlas a round, one multi-draw each for opaque and masked casters.
  void record_multi_draw(gpu::Recorder&, const Inputs&, uint32_t rounds) const;
  /// A render pass per view.
  void record_traditional(gpu::Recorder&, const Inputs&) const;

 private:
  gpu::Pipeline cast_[2];  // opaque, masked
};

}  // namespace umbrage::raster
