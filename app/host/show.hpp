// Debug pictures drawn over the finished one.
#pragma once
#include "host/gbuffer.hpp"
#include "host/renderer.hpp"

namespace app {

class ShowPass {
 public:
  static umbrage::Result<ShowPass> create(const GpuContext&, VkPipelineLayout, const Targets&);
  /// Precondition: show is not Show::image, picture in storage use (as afterwards). counters: of FrameData.
  void record(PassContext&, Show, VkBuffer counters) const;

 private:
  void record_boxes(PassContext&, VkBuffer counters) const;
  Handle<VkPipeline> debug_, boxes_;
};

}  // namespace app
