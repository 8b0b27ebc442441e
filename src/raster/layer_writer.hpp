// Work items → depth in layers of images: a multi-draw for each image, a layer from instance and face mask (O12).
#pragma once
#include "gpu/recorder.hpp"
#include "raster/page_writer.hpp"
#include "raster/raster_types.shared.h"
#include "store/map_images.hpp"

namespace umbrage::raster {

/// Items whose draws are listed at once: a round of the culling has no more.
constexpr uint32_t kLayerItems = 16384;

class LayerWriter {
 public:
  /// How texels are written.
  enum class Target : uint8_t {
    depth16,         ///< By the depth test of D16 attachments.
    words,           ///< By atomics of fragments, where the page bits allow it.
    resident_words,  ///< The same, where the texel's residency code does (Capabilities::shader_residency).
  };
  static Result<LayerWriter> create(const gpu::PipelineFactory&, Target);
  Result<void> reserve(const gpu::Device&, gpu::Memory&, const store::ImageLayout&, std::vector<gpu::Buffer>& retired);

  struct Inputs {
    const scene::GpuScene& scene;
    const gpu::Buffer& frame;     ///< FrameRecord first.
    const gpu::Buffer& counters;  ///< FrameCounters: map_groups.
    const gpu::Buffer& views;
    const gpu::Buffer& maps;
    const gpu::Buffer& items;   ///< CasterItem: opaque ones from 0, masked ones from item_capacity on.
    const gpu::Buffer& counts;  ///< DrawCounts.
    uint32_t item_capacity;     ///< At most kLayerItems; of both kinds together no round has more.
    const store::MapImages& images;
    const gpu::Buffer& page_bits;
    uint32_t max_resolution;      ///< Of any map.
    VkDeviceAddress image_table;  ///< shared::MapImage, in `frame`.
  };
  /// Empties the layers that maps use.
  void record_clear(gpu::Recorder&, const Inputs&) const;
  /// Adds the items' depths.
  void record(gpu::Recorder&, const Inputs&) const;

 private:
  Result<void> create_for_attachments(const gpu::PipelineFactory&);
  Result<void> create_for_words(const gpu::PipelineFactory&);
  void record_word_clear(gpu::Recorder&, const Inputs&) const;
  void list_draws(gpu::Recorder&, const Inputs&) const;
  Target target_ = Target::depth16;
  gpu::Pipeline list_clears_, clear_, list_draws_, cast_[2];  // opaque, masked
  gpu::Buffer layers_, clears_, clear_counts_, instances_, commands_, draw_counts_;
};

}  // namespace umbrage::raster
