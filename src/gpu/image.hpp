// Images of the library's own: depth, or 32-bit words that shaders write.
#pragma once
#include "gpu/memory.hpp"

namespace umbrage::gpu {

struct ImageDesc {
  VkFormat format = VK_FORMAT_D32_SFLOAT;
  uint32_t width = 0, height = 0;
  uint32_t layers = 0;  ///< 0: no array.
  VkImageUsageFlags usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  bool sparse = false;  ///< Without memory: pages of it are bound later.
};

/// A 2D image, or an array of them, with one view over all layers. Move-only.
class Image {
 public:
  static Result<Image> create(const Device&, Memory&, const ImageDesc&, const char* name);
  Image() = default;
  Image(Image&&) noexcept;
  Image& operator=(Image&&) noexcept;
  ~Image();
  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }
  uint32_t width() const { return desc_.width; }
  uint32_t height() const { return desc_.height; }
  uint32_t layers() const { return desc_.layers ? desc_.layers : 1; }
  VkFormat format() const { return desc_.format; }
  bool is_sparse() const { return desc_.sparse; }
  VkImageAspectFlags aspect() const;
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  const char* name() const { return name_; }
  mutable SyncState sync;

 private:
  Result<void> bind_memory(Memory&);
  Result<void> create_view();
  const Device* device_ = nullptr;
  VkImage handle_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  ImageDesc desc_;
  const char* name_ = "";
  Allocation allocation_;
};

}  // namespace umbrage::gpu
