// From coarse to fine: what a class does not need goes to the finer ones.
#include "store/map_images.hpp"

#include <algorithm>

namespace umbrage::store {

namespace {
constexpr uint32_t kCubeLayers = shared::CubeFaceCount;
/// A light's maps are at least its coarsest one and its whole map.
constexpr uint64_t kMapsPerLight = 2;
/// Layers of every image that a cube may leave unused: what is left of it does not take six.
constexpr uint32_t kLost = kCubeLayers - 1;
constexpr uint32_t kSmallestSide = 1u << shared::MinLevel;

uint64_t coarsest_layers(uint64_t views) {
  return kMapsPerLight * views + uint64_t(kLost) * shared::MaxMapImages + kCubeLayers;
}

/// As many images of this side as the device's limit on layers asks for, in front of coarser ones.
void add_images(ImageLayout& layout, uint32_t side, uint64_t layers, const ImageDemand& demand) {
  while (layers > 0 && layout.images.size() < shared::MaxMapImages) {
    const auto count = static_cast<uint32_t>(std::min<uint64_t>(layers, demand.most_layers));
    layout.images.insert(layout.images.begin(), {.side = side, .layers = count});
    layout.texels += uint64_t(count) * side * side;
    layers -= count;
  }
}
}  // namespace

uint32_t coarsest_side(uint32_t views, uint64_t texels) {
  uint32_t side = 16;
  while (side > kSmallestSide && coarsest_layers(views) * side * side > texels / 4) side /= 2;
  return side;
}

LeastRoom least_room_of_images(const ImageDemand& demand, uint64_t texel_bytes) {
  // A third of the images are left to the finer classes.
  const uint64_t layers = std::min<uint64_t>(demand.texels / (kSmallestSide * kSmallestSide),
                                             uint64_t(shared::MaxMapImages) * 2 / 3 * demand.most_layers);
  const uint64_t spare = coarsest_layers(0);
  return {layers > spare ? (layers - spare) / kMapsPerLight : 0,
          kMapsPerLight * kSmallestSide * kSmallestSide * texel_bytes};
}

ImageLayout lay_out_images(const ImageDemand& demand) {
  ImageLayout layout;
  const uint32_t coarsest = coarsest_side(demand.views, demand.texels);
  const uint32_t finest = std::max(std::min(demand.finest, demand.most_side), coarsest);
  add_images(layout, coarsest, coarsest_layers(demand.views), demand);
  for (uint32_t side = 2 * coarsest; side <= finest && layout.images.size() < shared::MaxMapImages; side *= 2) {
    const uint64_t room = demand.texels - layout.texels, layer = uint64_t(side) * side;
    uint64_t classes = 1;
    for (uint32_t finer = 2 * side; finer <= finest; finer *= 2) ++classes;
    const uint64_t share = std::max(room / classes / layer, std::min<uint64_t>(room / layer, kCubeLayers));
    const uint64_t wanted = (uint64_t(demand.views) + kCubeLayers - 1) / kCubeLayers * kCubeLayers;
    add_images(layout, side, std::min(share, wanted) / kCubeLayers * kCubeLayers, demand);
  }
  uint32_t layers = 0;
  for (shared::MapImage& image : layout.images) {
    image.first_layer = layers;
    layers += image.layers;
  }
  const auto lost = static_cast<uint32_t>(kLost * layout.images.size());
  layout.most_views = layers > lost ? layers - lost : 0;
  return layout;
}

Result<void> MapImages::reserve(const gpu::Device& device, gpu::Memory& memory, const ImageLayout& layout,
                                VkFormat format, gpu::RetireQueue& retired, uint64_t serial) {
  const auto same = [](const shared::MapImage& a, const shared::MapImage& b) {
    return a.side == b.side && a.layers == b.layers;
  };
  if (std::equal(layout.images.begin(), layout.images.end(), layout_.images.begin(), layout_.images.end(), same))
    return {};
  std::vector<gpu::Image> made;
  for (const shared::MapImage& image : layout.images) {
    auto one = gpu::Image::create(device, memory,
                                  {.format = format, .width = image.side, .height = image.side, .layers = image.layers},
                                  "shadow maps");
    if (!one) return one.error();
    made.push_back(std::move(*one));
  }
  for (gpu::Image& image : images_) retired.retire(std::move(image), serial);
  images_ = std::move(made);
  published_.clear();
  for (const gpu::Image& image : images_) published_.push_back(&image);
  layout_ = layout;
  return {};
}

}  // namespace umbrage::store
