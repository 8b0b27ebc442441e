// An oracle for measurements: how many of the triangles that a frame has drawn anyone looked at.
#pragma once
#include "gpu/pipeline.hpp"
#include "gpu/recorder.hpp"
#include "raster/page_writer.hpp"
#include "raster/raster_types.shared.h"

namespace umbrage::raster {

class NeededTriangles {
 public:
  static Result<NeededTriangles> create(const gpu::PipelineFactory&);
  /// texels: a bit for each texel of the pool; count: a word that the pairs are added to. Both are the host's, and visible to it
  /// when its own barrier says so.
  void record(gpu::Recorder&, const PageWriterInputs&, VkDeviceAddress texels, VkDeviceAddress count) const;

 private:
  gpu::Pipeline count_[2];  // opaque, masked
};

}  // namespace umbrage::raster
