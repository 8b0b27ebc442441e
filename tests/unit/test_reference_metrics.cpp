// compare's metrics on pictures that are made by hand, and the distance transform against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "commands/compare_metrics.hpp"
#include "commands/error_shapes.hpp"
#include "reference/distance_transform.hpp"

namespace {

using app::ErrorKind;
using reference::no_distance;
using reference::not_evaluated;

uint32_t brute_force(const std::vector<uint8_t>& marks, uint32_t width, uint32_t height, uint32_t x, uint32_t y,
                     uint8_t wanted) {
  uint32_t best = no_distance;
  for (uint32_t v = 0; v < height; ++v) {
    for (uint32_t u = 0; u < width; ++u) {
      if (marks[v * width + u] != wanted) continue;
      const int dx = int(u) - int(x), dy = int(v) - int(y);
      best = std::min(best, uint32_t(dx * dx + dy * dy));
    }
  }
  return best;
}

TEST(ReferenceDistance, EqualsBruteForce) {
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 17u}, {23u, 1u}, {31u, 19u}, {16u, 40u}}) {
    for (const uint32_t density : {0u, 1u, 30u, 700u, 1000u}) {
      std::vector<uint8_t> marks(size_t(width) * height);
      for (uint8_t& mark : marks) mark = random() % 1000 < density;
      const std::vector<uint32_t> distances = reference::squared_distances(marks, width, height);
      for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
          ASSERT_EQ(distances[y * width + x], brute_force(marks, width, height, x, y, 1))
              << width << "x" << height << " density " << density << " at " << x << "," << y;
        }
      }
    }
  }
}

TEST(ReferenceDistance, ToTheOtherValueEqualsBruteForce) {
  std::mt19937 random(2);
  constexpr uint32_t width = 33, height = 21;
  for (const uint32_t ones : {0u, 2u, 50u, 100u}) {
    std::vector<uint8_t> values(width * height, not_evaluated);
    for (uint32_t y = 4; y < 18; ++y) {
      for (uint32_t x = 7; x < 30; ++x) {
        if (random() % 3 != 0) values[y * width + x] = random() % 100 < ones;
      }
    }
    const std::vector<uint32_t> distances = reference::squared_distances_to_other(values, width, height);
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        const uint8_t value = values[y * width + x];
        const uint32_t expected =
            value > 1 ? no_distance : brute_force(values, width, height, x, y, uint8_t(1 - value));
        ASSERT_EQ(distances[y * width + x], expected) << ones << "% at " << x << "," << y;
      }
    }
  }
}

/// A picture of the floor y = 0, one pixel a decimetre, lit by a point light above its middle; all of it required.
struct Picture {
  static constexpr uint32_t width = 48, height = 32, pixels = width * height;
  std::vector<float> positions, normals;
  std::vector<uint8_t> visibility = std::vector<uint8_t>(pixels, 254), traced = std::vector<uint8_t>(pixels, 1), band;
  reference::Light light;
  reference::EvaluationMargins margins{.facing = 0.01f};

  Picture() {
    light.position = {0, 5, 0};
    light.range = 20;
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        positions.insert(positions.end(), {0.1f * (float(x) - 23.5f), 0, 0.1f * (float(y) - 15.5f)});
        normals.insert(normals.end(), {0, 1, 0});
      }
    }
  }
  static size_t at(uint32_t x, uint32_t y) { return size_t(y) * width + x; }
  using Test = std::function<bool(uint32_t x, uint32_t y)>;
  static void fill(std::vector<uint8_t>& picture, uint8_t value, const Test& where) {
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        if (where(x, y)) picture[at(x, y)] = value;
      }
    }
  }
  reference::SurfaceImage image() const { return {width, height, positions, normals}; }
  app::CompareReport report() const {
    app::CompareAccumulator accumulator(image(), margins);
    accumulator.add_light(7, "lamp", light, {visibility, band, traced});
    return accumulator.report();
  }
};

TEST(CompareMetrics, EqualPicturesHaveNoErrors) {
  Picture picture;
  Picture::fill(picture.traced, 0, [](uint32_t x, uint32_t) { return x < 20; });
  Picture::fill(picture.visibility, 0, [](uint32_t x, uint32_t) { return x < 20; });
  const app::CompareReport report = picture.report();
  EXPECT_EQ(report.counts.evaluated, Picture::pixels);
  EXPECT_EQ(report.counts.wrong(), 0u);
  EXPECT_EQ(report.counts.missing + report.counts.unexpected, 0u);
  EXPECT_EQ(report.luminance_rmse, 0);
  EXPECT_TRUE(report.worst.empty());
}

// The ray's shadow ends before column 20, the renderer's before column 26: columns 20, 21, 22 lie 1, 2, 3 pixels from the dark.
TEST(CompareMetrics, BandIsThreePixelsWide) {
  Picture picture;
  Picture::fill(picture.traced, 0, [](uint32_t x, uint32_t) { return x < 20; });
  Picture::fill(picture.visibility, 0, [](uint32_t x, uint32_t) { return x < 26; });
  const app::PairCounts counts = picture.report().counts;
  EXPECT_EQ(counts.false_dark, 6 * Picture::height);
  EXPECT_EQ(counts.false_lit, 0u);
  EXPECT_EQ(counts.wrong_inside_band, 3 * Picture::height);
  EXPECT_EQ(counts.wrong_outside_band, 3 * Picture::height);
  EXPECT_EQ(counts.wrong_outside_texel_band, 3 * Picture::height) << "no texel band given: as wide as the band";
  EXPECT_DOUBLE_EQ(counts.fraction(counts.wrong_outside_band), 3.0 / Picture::width);
}

TEST(CompareMetrics, TexelBandIsNeverNarrowerThanTheBand) {
  Picture picture;
  Picture::fill(picture.traced, 0, [](uint32_t x, uint32_t) { return x < 20; });
  Picture::fill(picture.visibility, 0, [](uint32_t x, uint32_t) { return x < 26; });
  for (const auto& [band_px, columns] : {std::pair{0u, 3u}, {3u, 3u}, {5u, 1u}, {6u, 0u}, {255u, 0u}}) {
    picture.band.assign(Picture::pixels, uint8_t(band_px));
    EXPECT_EQ(picture.report().counts.wrong_outside_texel_band, columns * Picture::height) << band_px;
  }
}

TEST(CompareMetrics, HalfVisibleCountsAsLit) {
  Picture picture;
  picture.visibility.assign(Picture::pixels, 127);
  EXPECT_EQ(picture.report().counts.false_dark, 0u);
  picture.visibility.assign(Picture::pixels, 126);
  EXPECT_EQ(picture.report().counts.false_dark, Picture::pixels);
}

TEST(CompareMetrics, UniformlyWrongIsOutsideEveryBand) {
  Picture picture;
  picture.traced.assign(Picture::pixels, 0);
  picture.band.assign(Picture::pixels, 255);
  EXPECT_EQ(picture.report().counts.wrong_outside_texel_band, Picture::pixels);
}

TEST(CompareMetrics, WhatHadToBeEvaluatedAndWasNotIsMissing) {
  Picture picture;
  Picture::fill(picture.visibility, not_evaluated, [](uint32_t x, uint32_t) { return x < 5; });
  Picture::fill(picture.traced, not_evaluated, [](uint32_t x, uint32_t) { return x < 5; });
  app::PairCounts counts = picture.report().counts;
  EXPECT_EQ(counts.missing, 5 * Picture::height);
  EXPECT_EQ(counts.evaluated, 43 * Picture::height);
  picture.light.range = 1;  // nothing is in reach any more
  counts = picture.report().counts;
  EXPECT_EQ(counts.missing, 0u);
  EXPECT_EQ(counts.unexpected, 43 * Picture::height);
}

TEST(CompareMetrics, ConesAndFacingDecideWhatIsRequired) {
  using reference::Evaluation;
  reference::Light spot;
  spot.kind = app::LightKind::spot;
  spot.direction = {0, -1, 0};
  spot.outer_cone = glm::radians(30.0f);
  const auto at = [&](float degrees, glm::vec3 normal) {
    return expected_evaluation(spot, {5 * std::sin(glm::radians(degrees)), -5 * std::cos(glm::radians(degrees)), 0},
                               normal);
  };
  EXPECT_EQ(at(20, {0, 1, 0}), Evaluation::required);
  EXPECT_EQ(at(29.99f, {0, 1, 0}), Evaluation::open);
  EXPECT_EQ(at(31, {0, 1, 0}), Evaluation::forbidden);
  EXPECT_EQ(at(20, {1, 0, 0}), Evaluation::forbidden) << "faces away";
  EXPECT_EQ(at(20, {-1, 0, 0}), Evaluation::open) << "grazing: the shading normal may say no";
}

TEST(CompareMetrics, LuminanceErrorIsRelativeToTheMean) {
  Picture picture;
  picture.visibility.assign(Picture::pixels, 127);  // half the light everywhere
  const double relative = picture.report().luminance_rmse;
  // Irradiance E varies over the floor: √mean((E/2)²) / mean(E) is 0.5 × √mean(E²) / mean(E).
  double squares = 0, sum = 0;
  for (size_t i = 0; i < Picture::pixels; ++i) {
    const glm::vec3 p(picture.positions[3 * i], 0, picture.positions[3 * i + 2]);
    const double d = glm::distance(p, picture.light.position);
    const double e = (1 - std::pow(d / 20, 4)) / (d * d) * 5 / d;
    squares += e * e;
    sum += e;
  }
  EXPECT_NEAR(relative, 0.5 * std::sqrt(squares / Picture::pixels) / (sum / Picture::pixels), 1e-5);
}

TEST(CompareMetrics, LuminanceErrorOfTwoImages) {
  const std::vector<float> a{1, 1, 1, 0, 0, 0, NAN, 0, 0}, b{0, 1, 1, 0, 1, 0, 1, 1, 1}, black(9, 0.0f);
  const double first = 0.7152 + 0.0722, second = 0.7152;
  EXPECT_NEAR(app::luminance_rmse(a, b), std::sqrt((0.2126 * 0.2126 + second * second) / 2) / ((first + second) / 2),
              1e-6);
  EXPECT_EQ(app::luminance_rmse(b, b), 0);
  EXPECT_EQ(app::luminance_rmse(black, black), 0);
  EXPECT_TRUE(std::isinf(app::luminance_rmse(b, black)));
}

TEST(CompareMetrics, WorstLightsComeFirstAndAreTenAtMost) {
  const Picture picture;
  app::CompareAccumulator accumulator(picture.image());
  for (uint32_t i = 0; i < 14; ++i) {
    std::vector<uint8_t> visibility(Picture::pixels, 254);
    Picture::fill(visibility, 0, [&](uint32_t x, uint32_t y) { return x < i && y == 0; });
    accumulator.add_light(100 + i, "light " + std::to_string(i), picture.light, {visibility, {}, picture.traced});
  }
  const app::CompareReport report = accumulator.report();
  ASSERT_EQ(report.worst.size(), 10u);
  EXPECT_EQ(report.worst[0].index, 113u);
  EXPECT_EQ(report.worst[0].name, "light 13");
  EXPECT_EQ(report.worst[0].counts.wrong_outside_band, 13u);
  EXPECT_EQ(report.worst[9].index, 104u);
  EXPECT_EQ(report.counts.wrong_outside_band, 13u * 14 / 2);
}

TEST(CompareMetrics, StripesOfFalseDarkAreAcne) {
  Picture picture;
  Picture::fill(picture.visibility, 0, [](uint32_t x, uint32_t y) { return x >= 4 && x < 44 && y % 3 == 0; });
  const app::PairCounts counts = picture.report().counts;
  EXPECT_GT(counts.acne, counts.false_dark * 9 / 10);
  EXPECT_EQ(counts.leak + counts.detached, 0u);
  Picture::fill(picture.visibility, 0, [](uint32_t x, uint32_t) { return x >= 4 && x < 44; });
  EXPECT_EQ(picture.report().counts.acne, 4 * Picture::height) << "of a wrong shadow only the rim";
}

TEST(CompareMetrics, ThickPatchesOfFalseLightAreLeaks) {
  Picture picture;
  picture.traced.assign(Picture::pixels, 0);
  picture.visibility.assign(Picture::pixels, 0);
  Picture::fill(picture.visibility, 254, [](uint32_t x, uint32_t y) { return x >= 10 && x < 14 && y >= 8 && y < 18; });
  EXPECT_EQ(picture.report().counts.leak, 40u);
  picture.visibility[Picture::at(40, 20)] = 254;
  EXPECT_EQ(picture.report().counts.leak, 40u) << "a speck belongs to no leak";
  Picture::fill(picture.visibility, 0, [](uint32_t x, uint32_t) { return x == 12; });
  const app::PairCounts counts = picture.report().counts;
  EXPECT_EQ(counts.leak, 0u) << "2 pixels and 1 pixel thick";
  EXPECT_EQ(counts.detached, 0u) << "touches no other surface";
}

TEST(CompareMetrics, ThinLightAtAContactIsADetachedShadow) {
  Picture picture;
  picture.traced.assign(Picture::pixels, 0);
  picture.visibility.assign(Picture::pixels, 0);
  const auto caster = [](uint32_t x, uint32_t) { return x < 10; };  // its side faces the camera, not the light
  Picture::fill(picture.traced, not_evaluated, caster);
  Picture::fill(picture.visibility, not_evaluated, caster);
  Picture::fill(picture.visibility, 254, [](uint32_t x, uint32_t) { return x == 10 || x == 11; });
  const app::PairCounts counts = picture.report().counts;
  EXPECT_EQ(counts.detached, 2 * Picture::height);
  EXPECT_EQ(counts.leak, 0u);
}

}  // namespace
