// What the writers of the page pool have in common.
#pragma once
#include "scene/gpu_scene.hpp"

namespace umbrage::raster {

struct PageWriterInputs {
  const scene::GpuScene& scene;
  const gpu::Buffer& frame;  ///< FrameRecord first, with the addresses of the next five.
  const gpu::Buffer& views;
  const gpu::Buffer& maps;
  const gpu::Buffer& page_bits;
  const gpu::Buffer& page_first;
  const gpu::Buffer& pool;    ///< Depth keys, cleared where pages are new.
  const gpu::Buffer& items;   ///< CasterItem: opaque ones from 0, masked ones from item_capacity on.
  const gpu::Buffer& counts;  ///< DrawCounts; items beyond item_capacity are left out.
  uint32_t item_capacity;
  const gpu::Buffer* counters;  ///< FrameCounters, told of large_triangles; may be null.
  /// With it triangles that no receiver can see are dropped one by one; may be null.
  const gpu::Buffer* receiver_depth;
  /// With it only texels are drawn that lookups of samples read (FrameRecord::texel_bits); may be null.
  const gpu::Buffer* texel_bits = nullptr;
};

}  // namespace umbrage::raster
