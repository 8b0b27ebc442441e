// The town of HOUSES against what the paper says of it: its triangles, and 256 lights of similar size, evenly spread.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "builtin_scene.hpp"

namespace {

using app::Scene;

class EveryHouses : public testing::TestWithParam<std::string> {};

TEST_P(EveryHouses, LightsAreOfSimilarSizeAndSpread) {
  const Scene& s = builtin(GetParam());
  ASSERT_EQ(s.lights.size(), 256u);
  for (const app::Light& light : s.lights) {
    EXPECT_EQ(light.kind, app::LightKind::point);
    EXPECT_GE(light.range, 9) << light.name;
    EXPECT_LE(light.range, 14) << light.name;
    EXPECT_GE(light.intensity / 9, 2) << light.name << ": too dim at 3 m";
  }
  constexpr float half = 100, cell = 40;
  std::array<std::array<int, 5>, 5> count{};
  for (const PlacedLight& light : placed_lights(s)) {
    ASSERT_LT(std::max(std::abs(light.position.x), std::abs(light.position.z)), half);
    const auto index = [&](float x) { return static_cast<size_t>((x + half) / cell); };
    ++count[index(light.position.z)][index(light.position.x)];
  }
  for (const auto& row : count) {
    for (int lights : row) {
      EXPECT_GE(lights, 5);  // 10.2 on average.
      EXPECT_LE(lights, 20);
    }
  }
}

TEST_P(EveryHouses, Cameras) {
  const Scene& s = builtin(GetParam());
  ASSERT_EQ(s.cameras.size(), 3u);
  EXPECT_EQ(s.cameras[0].name, "overview");
  EXPECT_EQ(s.cameras[1].name, "street");
  EXPECT_EQ(s.cameras[2].name, "square");
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryHouses, testing::Values("houses", "houses-lod"), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Houses, TriangleCounts) {
  const size_t full = drawn_triangles(builtin("houses")), low = drawn_triangles(builtin("houses-lod"));
  EXPECT_GE(full, 960'000u);
  EXPECT_LE(full, 1'060'000u);
  EXPECT_GE(low, full / 20);
  EXPECT_LE(low, full / 10);
}

}  // namespace
