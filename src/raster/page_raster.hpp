// Work items → depth in the page pool by compute shaders: small triangles by a thread each, large ones through lists of tiles.
// What it draws depends on nothing but each triangle and its map: the same bits in any order, however full the queue.
#pragma once
#include "gpu/recorder.hpp"
#include "raster/page_writer.hpp"
#include "raster/raster_types.shared.h"

namespace umbrage::raster {

class PageRaster {
 public:
  static Result<PageRaster> create(const gpu::PipelineFactory&);
  /// Room for a frame's large triangles (beyond it they are drawn by one thread each: slower, never missing) and for the tiles
  /// of a pool. Former buffers go to `retired`.
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint32_t large_triangles, VkDeviceSize pool_bytes,
                       std::vector<gpu::Buffer>& retired);
  /// Adds the items' depths to the pool.
  void record(gpu::Recorder&, const PageWriterInputs&);

 private:
  gpu::Pipeline plan_, rasterize_[2], bin_[2], draw_tiles_[2];  // [1]: with masks
  gpu::Buffer arguments_, appended_, triangles_, nodes_, heads_, tiles_;
  uint32_t large_capacity_ = 0, node_capacity_ = 0;
};

}  // namespace umbrage::raster
