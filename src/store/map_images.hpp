// Where maps are images: arrays of square depth images in resolution classes, made beforehand. Which map gets which layers is
// decided on the device (maps/place_maps.comp).
#pragma once
#include "clusters/clusters.hpp"
#include "store/page_pool.hpp"

namespace umbrage::store {

struct ImageLayout {
  std::vector<shared::MapImage> images;  ///< Finest first; several of one side where a device allows few layers.
  uint32_t most_views = 0;               ///< That find a layer, however they are spread over maps of six and of one.
  uint64_t texels = 0;
};

/// What a layout is made for.
struct ImageDemand {
  uint32_t views = 0;         ///< Of all lights that cast shadows.
  uint32_t finest = 8192;     ///< Texels along a side, at most; a power of two.
  uint64_t texels = 0;        ///< Of all images together, at most.
  uint32_t most_side = 4096;  ///< Limits of the device.
  uint32_t most_layers = 256;
};

/// Layers of the coarsest class, in which so many maps of every light have a place.
uint64_t coarsest_layers(uint64_t views, uint64_t maps_per_light);
/// Its side: the largest of `finest` and its halves, down to 4, with which it takes at most a quarter of the texels.
uint32_t coarsest_side(uint64_t layers, uint64_t texels, uint32_t finest);
/// Puts images of a side in front of coarser ones, as many as so many layers need.
void add_images(ImageLayout&, uint32_t side, uint64_t layers, uint32_t most_layers);
/// Numbers the layers of a finished layout.
void number_layers(ImageLayout&);
bool same_images(const ImageLayout&, const ImageLayout&);
/// Views that even the smallest such class has room for.
LeastRoom least_room_of_images(const ImageDemand&, uint64_t maps_per_light, uint64_t texel_bytes);
/// Maps of every light that a layout of whole images has room for at least: its coarsest one and its whole map.
constexpr uint64_t kLeastMaps = 2;
/// Classes of 16, 32 … texels that share what there is; none has more layers than there are views, so that coarse classes leave
/// more to fine ones.
ImageLayout lay_out_images(const ImageDemand&);

class MapImages {
 public:
  /// Images for a layout; former ones are retired.
  /// like: format, usage, and whether images of a page and more are sparse.
  Result<void> reserve(const gpu::Device&, gpu::Memory&, const ImageLayout&, const gpu::ImageDesc& like,
                       gpu::RetireQueue&, uint64_t serial);
  const ImageLayout& layout() const { return layout_; }
  const std::vector<gpu::Image>& images() const { return images_; }
  const std::vector<const gpu::Image*>& published() const { return published_; }

 private:
  ImageLayout layout_;
  std::vector<gpu::Image> images_;
  std::vector<const gpu::Image*> published_;
};

}  // namespace umbrage::store
