// One frame's camera, lights and counters as shaders read them, and the same camera for umbrage.
#pragma once
#include "host/renderer.hpp"
#include "host/scene_buffers.hpp"
#include "host/shaders/host.shared.h"
#include "host/targets.hpp"

namespace app {

/// A camera's matrices. Depth is reversed: 1 at the near plane, 0 at the far plane or at infinity.
struct CameraMatrices {
  glm::mat4 view_from_world{1}, clip_from_view{1}, clip_from_offset{1};
  glm::vec3 eye{0}, right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1};
  glm::vec2 lens_scale{1};
  glm::vec4 lens_depth{0};  ///< As GpuFrame::lens_depth.
};

/// World box of all items at the scene's first pose.
struct SceneExtent {
  glm::vec3 lowest{0}, highest{0};
};
SceneExtent measure_extent(const Pose&, const SceneBuffers&, std::span<const SceneItem>);

/// A picture narrower than the lens's aspect ratio shows the lens's whole width, a wider one its whole height.
umbrage::Result<CameraMatrices> camera_matrices(const ViewCamera&, uint32_t width, uint32_t height, const SceneExtent&);

class FrameData {
 public:
  static umbrage::Result<FrameData> create(const GpuContext&, uint32_t max_lights, const SceneExtent&);
  const SceneExtent& extent() const { return extent_; }
  /// Errors: more lights than max_lights.
  umbrage::Result<void> set_lights(std::span<const ActiveLight>);
  /// Fills everything but the addresses of instances, primitives, materials and umbrage.
  void set_camera(const CameraMatrices&, const ViewCamera&, const Targets&);
  gpu::GpuFrame& frame() { return frame_; }
  /// Hands the frame to the device. No submission that reads it is under way.
  void flush() { frame_buffer_.write(std::span<const gpu::GpuFrame>(&frame_, 1)); }
  VkDeviceAddress address() const { return frame_buffer_.address(); }
  VkBuffer counters() const { return counters_.get(); }

  /// Counters: zeroed at the start of a frame, copied to the CPU at its end.
  void record_clear(const GpuContext&, VkCommandBuffer) const;
  void record_read_back(const GpuContext&, VkCommandBuffer) const;
  const gpu::GpuCounters& read_counters() const;

 private:
  gpu::GpuFrame frame_{};
  SceneExtent extent_;
  uint32_t max_lights_ = 0;
  DeviceBuffer frame_buffer_, lights_, counters_, counters_read_back_;
};

/// Surfaces that are shaded too, though the depth buffer does not hold them.
struct OtherReceivers {
  bool any = false;
  std::span<const umbrage::Aabb> boxes;  ///< Around all of them; empty: not known.
};
umbrage::CameraDesc umbrage_camera(const CameraMatrices&, const Targets&, const OtherReceivers&);

}  // namespace app
