// The shadow views of the lights that clusters use.
#pragma once
#include "clusters/clusters.hpp"
#include "maps/map_push.shared.h"

namespace umbrage::maps {

class Views {
 public:
  static Result<Views> create(const gpu::PipelineFactory&);
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint32_t views, std::vector<gpu::Buffer>& retired);
  void fill(shared::FrameRecord& frame) const { frame.views = views_.address(); }
  /// all_lights: those that no cluster uses too.
  void record(gpu::Recorder&, const gpu::Buffer& frame, const gpu::Buffer& counters, const scene::GpuScene&,
              const gpu::Buffer& used_lights, bool all_lights);
  const gpu::Buffer& buffer() const { return views_; }

 private:
  gpu::Pipeline build_;
  gpu::Buffer views_;
};

}  // namespace umbrage::maps
