// Resolution classes of images: within what there is, every light with a place, no class finer than it may be.
#include <gtest/gtest.h>

#include <numeric>

#include "store/map_images.hpp"

namespace umbrage::store {
namespace {

constexpr uint64_t kMiB = 1 << 20, kTexelBytes = 2;

uint64_t texels_of(const ImageLayout& layout) {
  return std::accumulate(
      layout.images.begin(), layout.images.end(), uint64_t(0),
      [](uint64_t sum, const shared::MapImage& i) { return sum + uint64_t(i.side) * i.side * i.layers; });
}

TEST(MapImages, KeepToBudgetAndLimitsAndHaveAPlaceForAll) {
  for (const uint64_t budget_mib : {4u, 9u, 64u, 256u, 4096u}) {
    for (const uint32_t views : {0u, 1u, 6u, 66u, 390u, 2200u, 24576u}) {
      for (const uint32_t most_layers : {256u, 2048u}) {
        SCOPED_TRACE(std::to_string(budget_mib) + " MiB, " + std::to_string(views) + " views, " +
                     std::to_string(most_layers) + " layers");
        const ImageDemand demand{.views = views,
                                 .finest = 4096,
                                 .texels = budget_mib * kMiB / kTexelBytes,
                                 .most_side = 16384,
                                 .most_layers = most_layers};
        if (views > least_room_of_images(demand, kLeastMaps, kTexelBytes).views) continue;
        const ImageLayout layout = lay_out_images(demand);
        EXPECT_LE(texels_of(layout), demand.texels);
        EXPECT_EQ(texels_of(layout), layout.texels);
        EXPECT_LE(layout.images.size(), shared::MaxMapImages);
        EXPECT_GE(layout.most_views, 2 * views) << "each light's coarsest map and its whole map";
        uint32_t side = 4096, layers = 0;
        for (const shared::MapImage& image : layout.images) {
          EXPECT_LE(image.side, side);
          EXPECT_LE(image.layers, most_layers);
          EXPECT_EQ(image.first_layer, layers);
          side = image.side;
          layers += image.layers;
        }
        EXPECT_LE(side, 16u);
        EXPECT_LE(texels_of(layout), demand.texels);
      }
    }
  }
}

TEST(MapImages, AreAsFineAsTheBudgetAllows) {
  const auto finest = [](uint64_t budget_mib, uint32_t views, uint32_t limit = 8192) {
    return lay_out_images({.views = views,
                           .finest = limit,
                           .texels = budget_mib * kMiB / kTexelBytes,
                           .most_side = 16384,
                           .most_layers = 2048})
        .images[0]
        .side;
  };
  EXPECT_EQ(finest(4, 6), 256u);  // a cube of 512² takes 3 MiB, all coarser ones another
  EXPECT_EQ(finest(8, 6), 512u);
  EXPECT_EQ(finest(256, 6), 2048u);  // one of 4096² takes 192 MiB
  EXPECT_EQ(finest(256, 66), 2048u);
  EXPECT_EQ(finest(4096, 6), 8192u);
  EXPECT_EQ(finest(4096, 6, 1024), 1024u);
}

TEST(MapImages, LeaveLightsOutOnlyWhenTheSmallestMapsOfAllDoNotFit) {
  const ImageDemand demand{.texels = 4 * kMiB / kTexelBytes, .most_side = 16384, .most_layers = 2048};
  const LeastRoom room = least_room_of_images(demand, kLeastMaps, kTexelBytes);
  EXPECT_GE(room.views, 6u * 1024);
  EXPECT_EQ(room.bytes_per_view, 2u * 4 * 4 * kTexelBytes);
  EXPECT_EQ(coarsest_side(coarsest_layers(room.views, kLeastMaps), demand.texels, 16), 4u);
  EXPECT_EQ(coarsest_side(coarsest_layers(6, kLeastMaps), demand.texels, 16), 16u);
}

}  // namespace
}  // namespace umbrage::store
