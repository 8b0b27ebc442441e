// Points that no depth buffer holds (glass, fog, particles): anywhere, or in boxes that the host names.
#pragma once
#include "clusters/clusters.hpp"
#include "maps/map_push.shared.h"

namespace umbrage::maps {

class OtherReceivers {
 public:
  static Result<OtherReceivers> create(const gpu::PipelineFactory&);
  Result<void> reserve(const gpu::Device&, gpu::Memory&, std::span<const CameraDesc>,
                       std::vector<gpu::Buffer>& retired);
  /// Room that upload() takes of the uploader.
  static VkDeviceSize staged_bytes(std::span<const CameraDesc>);
  /// From now on those of these cameras, taken together.
  void upload(gpu::Uploader&, std::span<const CameraDesc>);
  /// Some camera does not say where: every light has a whole map.
  bool anywhere() const { return anywhere_; }

  /// Lights that reach a box are used, and have a map for its points.
  void record_lights(gpu::Recorder&, const scene::GpuScene&, const gpu::Buffer& used_lights);
  struct Marks {
    const gpu::Buffer& frame;
    const gpu::Buffer& counters;
    const gpu::Buffer& lights;
    const gpu::Buffer& views;
    const gpu::Buffer& maps;
    const gpu::Buffer& page_bits;
    const gpu::Buffer& projection;
    const gpu::Buffer& receiver_depth;
  };
  /// What lookups from the boxes reach, in the maps that are for them.
  void record_marks(gpu::Recorder&, const Marks&);

 private:
  gpu::Pipeline reach_, mark_;
  gpu::Buffer boxes_;
  uint32_t count_ = 0;
  bool anywhere_ = false;
};

}  // namespace umbrage::maps
