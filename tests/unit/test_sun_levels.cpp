// Levels of directional lights: texels that lie where they lie in every window, windows that hold what is asked of them, and which
// level answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "views/sun_levels.shared.h"

namespace {
using namespace umbrage::shared;

struct Random {
  std::mt19937 engine{19};
  float operator()(float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(engine); }
  int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(engine); }
  vec3 direction() {
    std::normal_distribution<float> normal;
    return normalize(vec3(normal(engine), normal(engine), normal(engine)));
  }
};

SunRect rect(vec2 lo, vec2 hi) {
  SunRect out;
  out.lo = lo, out.hi = hi;
  return out;
}

/// Sub-texels from the world's origin, through a window.
glm::i64vec2 sub_texel(const ShadowView& view, const SunWindow& window, vec3 p) {
  const vec4 clip = view_clip_position(view, p);
  const glm::dvec2 texel = (glm::dvec2(clip.x, clip.y) * 0.5 + 0.5) * double(window.side) + glm::dvec2(window.first);
  const glm::dvec2 sub = texel * 256.0;
  EXPECT_EQ(sub, glm::round(sub));
  return glm::i64vec2(sub);
}

TEST(SunLevels, TexelsAreTheSameInEveryWindow) {
  Random random;
  for (int trial = 0; trial < 2000; ++trial) {
    const float reach = std::exp2(random(-3, 12));
    const ShadowView plane = sun_plane(random.direction(), vec3(-reach), vec3(reach));
    const auto level = static_cast<uint>(random.whole(8, SunFinestLevel));
    const vec3 p = vec3(random(-1, 1), random(-1, 1), random(-1, 1)) * reach;
    const SunRect at = sun_rect(plane, p, p);
    glm::i64vec2 known(0);
    for (int i = 0; i < 8; ++i) {
      // Windows of any size, some of them not around the point.
      const float apart = std::exp2(-float(level)) * random(0, 12000);
      const vec2 from = at.lo - vec2(random(0, apart), random(0, apart));
      const SunWindow window = sun_window(rect(from, from + vec2(apart)), level, 1u << random.whole(8, 13));
      const glm::i64vec2 place = sub_texel(sun_window_view(plane, window, level), window, p);
      if (i > 0) { ASSERT_EQ(place, known) << "level " << level << ", window of " << window.side; }
      known = place;
    }
  }
}

TEST(SunLevels, TexelsAndDepthsChangeNothingWhenCastersReachFarther) {
  Random random;
  for (int trial = 0; trial < 500; ++trial) {
    const vec3 direction = random.direction(), p(random(-3, 3), random(-3, 3), random(-3, 3));
    const ShadowView plane = sun_plane(direction, vec3(-3), vec3(4)),
                     same = sun_plane(direction, vec3(-2.1f, 0, 1), vec3(3.3f)),
                     wider = sun_plane(direction, vec3(-3), vec3(4.1f));
    EXPECT_EQ(view_clip_position(plane, p), view_clip_position(same, p));
    EXPECT_EQ(wider.side_m, 2 * plane.side_m);
    // Twice as wide, so that the next finer level has the same texels.
    const SunRect at = sun_rect(plane, p, p);
    const SunWindow window = sun_window(at, 18, 512), other = sun_window(rect(at.lo * 0.5f, at.hi * 0.5f), 19, 512);
    EXPECT_EQ(window.first, other.first);
    EXPECT_EQ(sub_texel(sun_window_view(plane, window, 18), window, p),
              sub_texel(sun_window_view(wider, other, 19), other, p));
  }
}

TEST(SunLevels, PlaneIsContinuousAndOrthonormalAtThePole) {
  for (const vec3 direction : {vec3(0, -1, 0), vec3(1e-9f, -1, 0), vec3(0, -1, 1e-6f), vec3(1e-4f, -1, 1e-4f),
                               vec3(0, 1, 0), vec3(0, 0, -1)}) {
    const ShadowView plane = sun_plane(direction, vec3(-1), vec3(1));
    const glm::dvec3 x = glm::dvec3(plane.x_row) * 16.0, y = glm::dvec3(plane.y_row) * 16.0,
                     z = glm::dvec3(plane.z_row) * -4.0;
    EXPECT_NEAR(glm::length(x), 1, 1e-6);
    EXPECT_NEAR(glm::length(y), 1, 1e-6);
    EXPECT_NEAR(glm::dot(x, y), 0, 1e-6);
    EXPECT_NEAR(glm::distance(z, glm::dvec3(unit_direction(direction))), 0, 1e-6);
  }
}

TEST(SunLevels, WindowsHoldWhatIsAskedOfThemOrLieInItsMiddle) {
  Random random;
  uint held = 0, too_much = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto level = static_cast<uint>(random.whole(SunCoarsestLevel, SunFinestLevel));
    const uint most = 1u << random.whole(2, 13), whole = 1u << level;
    // Casters fill a ninth of the plane at most.
    const vec2 a(random(-0.055f, 0.055f), random(-0.055f, 0.055f));
    const vec2 extent = vec2(random(0, 1), random(0, 1)) * std::min(0.054f, 2.0f * float(most) / float(whole));
    const SunRect asked = rect(a - extent, a + extent);
    const SunWindow window = sun_window(asked, level, most);
    const double half = whole / 2.0;
    ASSERT_TRUE(std::has_single_bit(window.side) && window.side <= std::min(most, whole));
    const int step = static_cast<int>(sun_window_step(window.side));
    if (window.side < whole) { ASSERT_TRUE(window.first.x % step == 0 && window.first.y % step == 0); }
    if (window.side >= SunPagedWindow && window.side < whole) { ASSERT_EQ(step, 64); }
    const glm::dvec2 lo = glm::floor(glm::dvec2(asked.lo) * half - double(FilterTexels)) - glm::dvec2(window.first);
    const glm::dvec2 hi = glm::floor(glm::dvec2(asked.hi) * half + double(FilterTexels)) - glm::dvec2(window.first);
    const bool inside = std::min(lo.x, lo.y) >= 0 && std::max(hi.x, hi.y) < window.side;
    if (window.holds != 0u) {
      ASSERT_TRUE(inside) << "level " << level << ", " << window.side << " of " << most;
      ++held;
    } else {
      ASSERT_EQ(window.side, most);
      ASSERT_LT(most, whole) << "all of the plane holds everything";
      // Around the middle.
      ASSERT_NEAR(lo.x + hi.x, window.side, 2 * step + 2);
      ++too_much;
    }
  }
  EXPECT_GT(held, 5000u);
  EXPECT_GT(too_much, 1000u);
}

TEST(SunLevels, RequestsGetTexelsNoLargerThanTheirPixels) {
  for (int place = 0; place + 1 < int(SunPlaces); ++place) {
    const float texels = std::exp2(float(SunFinestLevel - uint(place)));
    for (const float off : {0.5001f, 0.7f, 0.99f, 0.9999f})
      EXPECT_EQ(sun_place_of_request(texels * off), uint(place)) << off;
  }
  EXPECT_EQ(sun_place_of_request(1e30f), 0u);
  EXPECT_EQ(sun_place_of_request(1e-30f), SunPlaces - 1);
}

TEST(SunLevels, EveryRequestIsAnsweredByItsOwnLevelOrACoarserOne) {
  Random random;
  for (int trial = 0; trial < 20000; ++trial) {
    const uint places = uint(random.whole(1, (1 << SunPlaces) - 1)) & uint(random.whole(0, (1 << SunPlaces) - 1));
    if (places == 0u) continue;
    const auto shift = static_cast<uint>(random.whole(0, 30)), most = static_cast<uint>(random.whole(1, 16));
    const uint shifted = sun_shifted_places(places, shift), kept = sun_kept_places(shifted, most);
    ASSERT_LE(uint(bitCount(kept)), most);
    ASSERT_EQ(findMSB(kept), findMSB(shifted));
    ASSERT_EQ(kept & ~shifted, 0u);
    if (uint(bitCount(shifted)) <= most) { ASSERT_EQ(kept, shifted); }
    for (uint place = 0; place < SunPlaces; ++place) {
      if ((places >> place & 1u) == 0u) continue;
      const uint moved = std::min(place + shift, SunPlaces - 1u), map = sun_map_of_place(kept, moved);
      ASSERT_LT(map, uint(bitCount(kept)));
      uint left = kept;
      for (uint i = 0; i < map; ++i) left &= left - 1u;
      ASSERT_GE(uint(findLSB(left)), moved);
    }
  }
}

TEST(SunLevels, AWindowHoldsWhatWasAskedAndNotWhatLiesBeside) {
  Random random;
  for (int trial = 0; trial < 5000; ++trial) {
    const ShadowView plane = sun_plane(random.direction(), vec3(-50), vec3(50));
    const auto level = static_cast<uint>(random.whole(12, 22));
    const float texel = 2.0f / float(1u << level);
    const vec2 a(random(-0.05f, 0.05f), random(-0.05f, 0.05f));
    const SunRect asked = rect(a, a + vec2(random(0, 3000) * texel, random(0, 3000) * texel));
    const SunWindow window = sun_window(asked, level, 8192);
    if (window.holds == 0u) continue;
    const ShadowView view = sun_window_view(plane, window, level);
    EXPECT_TRUE(sun_window_holds(plane, view, asked));
    const float past = (float(window.first.x + int(window.side)) + 2) * texel;
    EXPECT_FALSE(sun_window_holds(plane, view, rect(asked.lo, vec2(past, asked.hi.y))));
  }
}

}  // namespace
