// From linear colour to the picture: exposure, then tone mapping.
#pragma once
#include "host/gbuffer.hpp"

namespace app {

class PostPass {
 public:
  static umbrage::Result<PostPass> create(const GpuContext&, VkPipelineLayout);
  /// Histogram and exposure of this frame alone, so that a frame's picture depends on nothing before it.
  void record_exposure(PassContext&) const;
  /// Afterwards the picture is in storage use.
  void record_tone_map(PassContext&) const;

 private:
  Handle<VkPipeline> count_luminance_, choose_exposure_, tone_map_;
};

}  // namespace app
