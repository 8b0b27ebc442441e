// Images that know their layout, and the table from a use to its stages, accesses and layout.
#pragma once
#include "host/gpu_context.hpp"

namespace app {

enum class ImageUse : uint8_t {
  undefined,  ///< Contents are given up.
  color_target,
  depth_target,
  depth_read,  ///< Tested against and sampled at once, as umbrage takes it.
  sampled,
  storage,
  transfer_source,
  transfer_target,
};

struct ImageDesc {
  const char* name = "";
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t width = 1, height = 1, mip_levels = 1;
  VkImageUsageFlags usage = 0;
};

/// A 2D image and a view of the whole.
class DeviceImage {
 public:
  static umbrage::Result<DeviceImage> create(const GpuContext&, const ImageDesc&);
  DeviceImage() = default;
  DeviceImage(DeviceImage&& other) noexcept { swap(other); }
  DeviceImage& operator=(DeviceImage&& other) noexcept {
    swap(other);
    return *this;
  }
  ~DeviceImage();
  VkImage get() const { return image_; }
  VkImageView view() const { return view_.get(); }
  VkFormat format() const { return desc_.format; }
  /// From here on the image is used so: waits for what was before and moves the layout.
  void use(const GpuContext&, VkCommandBuffer, ImageUse);
  /// One mip level after the other is halved from the one before; all end as `sampled`. Precondition: a transfer_target
  /// with level 0 written.
  void make_mips(const GpuContext&, VkCommandBuffer);

 private:
  void swap(DeviceImage& other) noexcept;
  VmaAllocator allocator_ = VK_NULL_HANDLE;
  VmaAllocation allocation_ = VK_NULL_HANDLE;
  VkImage image_ = VK_NULL_HANDLE;
  Handle<VkImageView> view_;
  ImageDesc desc_;
  ImageUse current_ = ImageUse::undefined;
};

/// The layout of a use.
VkImageLayout layout_of(ImageUse use);
VkImageAspectFlags aspect_of(VkFormat format);

}  // namespace app
