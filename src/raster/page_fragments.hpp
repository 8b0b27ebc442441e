// Work items → depth in the page pool by the hardware rasteriser: one multi-draw without attachments, and an atomic a fragment.
#pragma once
#include "gpu/recorder.hpp"
#include "raster/page_writer.hpp"
#include "raster/raster_types.shared.h"

namespace umbrage::raster {

class PageFragments {
 public:
  static Result<PageFragments> create(const gpu::PipelineFactory&);
  /// Room for the draws of shared::DrawWindow items, whatever a frame has.
  Result<void> reserve(const gpu::Device&, gpu::Memory&);
  /// Adds the items' depths to the pool. No map has more than max_resolution texels along its side.
  void record(gpu::Recorder&, const PageWriterInputs&, uint32_t max_resolution) const;

 private:
  void record_window(gpu::Recorder&, const PageWriterInputs&, uint32_t max_resolution, bool masked,
                     uint32_t first) const;
  gpu::Pipeline list_, cast_[2];  // [1]: masked
  gpu::Buffer instances_, commands_, draw_count_;
};

}  // namespace umbrage::raster
