// Array images that layered passes draw into, and their texels on the CPU.
#pragma once
#include <vector>

#include "host/gpu_context.hpp"
#include "umbrage/layered_pass.hpp"

namespace app {

struct LayerImagesDesc {
  uint32_t width = 256, height = 256, layers = 1;
  VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
  VkFormat color_format = VK_FORMAT_UNDEFINED;  ///< UNDEFINED: depth alone.
  bool is_cube = false;                         ///< A cube map (array): layers is a multiple of 6.
};

/// A depth array image and, where wanted, a colour one, ready for LayeredPass::record.
class LayerImages {
 public:
  static umbrage::Result<LayerImages> create(GpuContext&, const LayerImagesDesc&);
  LayerImages(LayerImages&&) noexcept;
  LayerImages& operator=(LayerImages&&) noexcept = delete;
  ~LayerImages();
  const LayerImagesDesc& desc() const { return desc_; }
  umbrage::LayeredTargetDesc target() const;
  /// Drawn into again; what they held is given up.
  void begin_drawing(const GpuContext&, VkCommandBuffer) const;
  /// From here on shaders sample the images: DEPTH_READ_ONLY and SHADER_READ_ONLY; nothing is drawn or read any more.
  void end_drawing(const GpuContext&, VkCommandBuffer) const;
  /// Of all layers of the depth image, or of the colour image.
  umbrage::Result<Handle<VkImageView>> view(const GpuContext&, VkImageViewType, VkImageAspectFlags) const;
  umbrage::Result<Handle<VkImageView>> layer_view(const GpuContext&, uint32_t layer, VkImageAspectFlags) const;
  /// All layers, one after the other, 0…1. Everything submitted has been waited for.
  umbrage::Result<std::vector<float>> read_depth(GpuContext&);
  /// Likewise; 16 bytes (RGBA32F) or 4 (RGBA8) a texel, as the format has it.
  umbrage::Result<std::vector<std::byte>> read_color(GpuContext&);

 private:
  umbrage::Result<Handle<VkImageView>> make_view(const GpuContext&, VkImageViewType, VkImageAspectFlags, uint32_t first,
                                                 uint32_t count) const;
  struct One {
    VkImage image = VK_NULL_HANDLE;
    VmaAllocation allocation = VK_NULL_HANDLE;
  };
  LayerImages() = default;
  umbrage::Result<One> make(VkFormat, VkImageUsageFlags) const;
  umbrage::Result<std::vector<std::byte>> read(GpuContext&, VkImage, VkImageAspectFlags, VkImageLayout,
                                               uint32_t texel_bytes);
  VmaAllocator allocator_ = VK_NULL_HANDLE;
  LayerImagesDesc desc_;
  One depth_, color_;
};

}  // namespace app
