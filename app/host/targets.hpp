// The images of a frame: G-buffer, linear colour, picture; and the set (1) that hands them to shaders.
#pragma once
#include <array>

#include "host/descriptors.hpp"
#include "host/images.hpp"

namespace app {

/// In the order of shaders/targets.glsl.
enum class Target : uint8_t { depth, geometric_normal, surface, color, picture };
constexpr size_t target_count = 5;

class Targets {
 public:
  /// Errors: a size that the device does not take, a format that it lacks.
  static umbrage::Result<Targets> create(const GpuContext&, uint32_t width, uint32_t height);
  DeviceImage& operator[](Target target) { return images_[static_cast<size_t>(target)]; }
  const DeviceImage& operator[](Target target) const { return images_[static_cast<size_t>(target)]; }
  const DescriptorSet& set() const { return set_; }
  /// The cube map that the mirror ball shows.
  void set_reflection(const GpuContext&, const VkDescriptorImageInfo&);
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  uint32_t pixels() const { return width_ * height_; }
  VkRect2D area() const { return {{0, 0}, {width_, height_}}; }

 private:
  std::array<DeviceImage, target_count> images_;
  DescriptorSet set_;
  uint32_t width_ = 0, height_ = 0;
};

/// What the G-buffer pass draws into, in the order of write_gbuffer.frag's outputs.
inline constexpr std::array gbuffer_targets{Target::geometric_normal, Target::surface};

VkRenderingAttachmentInfo attachment(const DeviceImage&, ImageUse, VkAttachmentLoadOp, VkAttachmentStoreOp);
/// Viewport and scissor of the whole picture, no culling.
void set_whole_viewport(const GpuContext&, VkCommandBuffer, const Targets&);
/// Begins rendering onto what a target holds, tested against the depth buffer, which stays as it is.
void begin_drawing_over(const GpuContext&, VkCommandBuffer, Targets&, Target);

}  // namespace app
