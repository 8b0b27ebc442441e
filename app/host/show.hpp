// Debug pictures drawn over the finished one.
#pragma once
#include "host/gbuffer.hpp"
#include "host/renderer.hpp"

namespace app {

class ShowPass {
 public:
  /// max_lights: that any frame will have.
  static umbrage::Result<ShowPass> create(const GpuContext&, VkPipelineLayout, const Targets&, uint32_t max_lights);
  /// Precondition: show is not Show::image, picture in storage use (as afterwards). light: as FrameInput::show_light.
  /// counters: of FrameData.
  void record(PassContext&, Show show, std::optional<uint32_t> light, VkBuffer counters) const;

 private:
  umbrage::Result<void> create_line_pipelines(const GpuContext&, VkPipelineLayout, const Targets&);
  void dispatch(const PassContext&, const gpu::ShowPush&, VkPipeline, uint32_t x, uint32_t y) const;
  void begin_lines(const PassContext&, const gpu::ShowPush&, VkPipeline) const;
  void end_lines(const PassContext&) const;
  Handle<VkPipeline> debug_, maps_, projection_, cascades_, choose_light_, choose_receiver_, boxes_, lines_;
  DeviceBuffer subject_;  ///< GpuSubject, then a GpuLightUse per light.
};

}  // namespace app
