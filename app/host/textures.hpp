// All textures of a scene in one array of combined image samplers (set 0).
#pragma once
#include <map>
#include <tuple>
#include <vector>

#include "host/descriptors.hpp"
#include "host/images.hpp"
#include "import/scene.hpp"

namespace app {

enum class ColorSpace : uint8_t { linear, srgb };

class TextureTable {
 public:
  /// Uploads every image that a material uses, once per colour space, with full mip chains.
  static umbrage::Result<TextureTable> create(GpuContext&, const Scene&);
  /// Index into the array, or gpu::NoTexture. The texture is one of the scene's materials'.
  uint32_t slot(const Texture&, ColorSpace) const;
  VkImageView view(uint32_t slot) const { return images_[slots_[slot].image].view(); }
  VkSampler sampler(uint32_t slot) const { return samplers_[slots_[slot].sampler].get(); }
  /// Slots handed out.
  size_t size() const { return slots_.size(); }
  const DescriptorSet& set() const { return set_; }

 private:
  struct Slot {
    size_t image = 0, sampler = 0;
  };
  using SamplerKey = std::tuple<Wrap, Wrap, bool>;
  using SlotKey = std::tuple<int, ColorSpace, SamplerKey>;
  static SlotKey key_of(const Texture&, ColorSpace);
  umbrage::Result<void> add(GpuContext&, const Scene&, const Texture&, ColorSpace);
  umbrage::Result<size_t> add_image(GpuContext&, const Image&, ColorSpace);
  umbrage::Result<size_t> add_sampler(const GpuContext&, SamplerKey);
  umbrage::Result<void> create_set(const GpuContext&);

  std::vector<DeviceImage> images_;
  std::vector<Handle<VkSampler>> samplers_;
  std::vector<Slot> slots_;
  std::map<SlotKey, uint32_t> slot_of_;
  std::map<std::pair<int, ColorSpace>, size_t> image_of_;
  std::map<SamplerKey, size_t> sampler_of_;
  DescriptorSet set_;
};

}  // namespace app
