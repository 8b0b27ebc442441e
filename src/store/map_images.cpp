// From coarse to fine: what a class does not need goes to the finer ones.
#include "store/map_images.hpp"

#include <algorithm>

namespace umbrage::store {

namespace {
constexpr uint32_t kCubeLayers = shared::CubeFaceCount;
/// Layers of every image that a cube may leave unused: what is left of it does not take six.
constexpr uint32_t kLost = kCubeLayers - 1;
constexpr uint32_t kSmallestSide = 1u << shared::MinLevel;
}  // namespace

uint64_t coarsest_layers(uint64_t views, uint64_t maps_per_light) {
  return maps_per_light * views + uint64_t(kLost) * shared::MaxMapImages + kCubeLayers;
}

uint32_t coarsest_side(uint64_t layers, uint64_t texels, uint32_t finest) {
  uint32_t side = finest;
  while (side > kSmallestSide && layers * side * side > texels / 4) side /= 2;
  return side;
}

void add_images(ImageLayout& layout, uint32_t side, uint64_t layers, uint32_t most_layers) {
  while (layers > 0 && layout.images.size() < shared::MaxMapImages) {
    const auto count = static_cast<uint32_t>(std::min<uint64_t>(layers, most_layers));
    layout.images.insert(layout.images.begin(), {.side = side, .layers = count});
    layout.texels += uint64_t(count) * side * side;
    layers -= count;
  }
}

void number_layers(ImageLayout& layout) {
  uint32_t layers = 0;
  for (shared::MapImage& image : layout.images) {
    image.first_layer = layers;
    layers += image.layers;
  }
  const auto lost = static_cast<uint32_t>(kLost * layout.images.size());
  layout.most_views = layers > lost ? layers - lost : 0;
}

bool same_images(const ImageLayout& a, const ImageLayout& b) {
  const auto same = [](const shared::MapImage& x, const shared::MapImage& y) {
    return x.side == y.side && x.layers == y.layers;
  };
  return std::equal(a.images.begin(), a.images.end(), b.images.begin(), b.images.end(), same);
}

LeastRoom least_room_of_images(const ImageDemand& demand, uint64_t maps_per_light, uint64_t texel_bytes) {
  // A third of the images are left to the finer classes.
  const uint64_t layers = std::min<uint64_t>(demand.texels / (kSmallestSide * kSmallestSide),
                                             uint64_t(shared::MaxMapImages) * 2 / 3 * demand.most_layers);
  const uint64_t spare = coarsest_layers(0, 0);
  return {layers > spare ? (layers - spare) / maps_per_light : 0,
          maps_per_light * kSmallestSide * kSmallestSide * texel_bytes};
}

ImageLayout lay_out_images(const ImageDemand& demand) {
  ImageLayout layout;
  const uint64_t least = coarsest_layers(demand.views, kLeastMaps);
  const uint32_t coarsest = coarsest_side(least, demand.texels, 16);
  const uint32_t finest = std::max(std::min(demand.finest, demand.most_side), coarsest);
  add_images(layout, coarsest, least, demand.most_layers);
  for (uint32_t side = 2 * coarsest; side <= finest && layout.images.size() < shared::MaxMapImages; side *= 2) {
    const uint64_t room = demand.texels - layout.texels, layer = uint64_t(side) * side;
    uint64_t classes = 1;
    for (uint32_t finer = 2 * side; finer <= finest; finer *= 2) ++classes;
    const uint64_t share = std::max(room / classes / layer, std::min<uint64_t>(room / layer, kCubeLayers));
    const uint64_t wanted = (uint64_t(demand.views) + kCubeLayers - 1) / kCubeLayers * kCubeLayers;
    add_images(layout, side, std::min(share, wanted) / kCubeLayers * kCubeLayers, demand.most_layers);
  }
  number_layers(layout);
  return layout;
}

Result<void> MapImages::reserve(const gpu::Device& device, gpu::Memory& memory, const ImageLayout& layout,
                                const gpu::ImageDesc& like, gpu::RetireQueue& retired, uint64_t serial) {
  if (same_images(layout, layout_)) return {};
  std::vector<gpu::Image> made;
  for (const shared::MapImage& image : layout.images) {
    gpu::ImageDesc desc = like;
    desc.width = desc.height = image.side;
    desc.layers = image.layers;
    desc.sparse = like.sparse && image.side >= shared::LeastSparseSide;
    auto one = gpu::Image::create(device, memory, desc, "shadow maps");
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
