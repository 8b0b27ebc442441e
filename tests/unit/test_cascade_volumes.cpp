// Volumes of cascades: large enough, of constant size, moved by whole steps of a grid that is fixed in the world (C7).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <random>

#include "cascades/cascade_planner.hpp"
#include "clusters/camera.hpp"

namespace umbrage {
namespace {

using namespace cascades;

Mat4 matrix(const glm::mat4& m) {
  Mat4 out;
  for (int i = 0; i < 16; ++i) out.m[i] = m[i / 4][i % 4];
  return out;
}

shared::CameraRecord camera_at(const glm::vec3& eye, const glm::vec3& forward, float jitter = 0) {
  glm::mat4 projection(0);  // reversed, infinite
  const float focal = 1 / std::tan(0.5f);
  projection[0][0] = focal / 1.6f, projection[1][1] = -focal;
  projection[2][0] = jitter;
  projection[2][3] = -1, projection[3][2] = 0.1f;
  const glm::vec3 up = std::abs(forward.y) > 0.99f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const CameraDesc desc{.view_from_world = matrix(glm::translate(glm::lookAt(glm::vec3(0), forward, up), -eye)),
                        .clip_from_view = matrix(projection),
                        .width = 1280,
                        .height = 800};
  return clusters::camera_record(desc).value();
}

glm::vec3 random_direction(std::mt19937& engine) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(engine), normal(engine), normal(engine)));
}

const CascadeLight kSun{.slot = 3, .direction_ws = glm::normalize(glm::vec3(0.4f, -1, 0.3f))};

TEST(CascadeVolumes, SplitsGrowAndEndWhereTheyShould) {
  for (const float share : {0.0f, 0.5f, 1.0f}) {
    const CascadeSettings settings{.count = 5, .distance_m = 300, .log_share = share};
    const auto splits = split_depths(0.1, settings);
    EXPECT_GT(splits[0], 0.1);
    for (size_t i = 1; i < 5; ++i) EXPECT_GT(splits[i], splits[i - 1]);
    EXPECT_EQ(splits[4], 300);
    if (share == 0.0f) {
      EXPECT_NEAR(splits[1] - splits[0], splits[4] - splits[3], 1e-9);
    } else if (share == 1.0f) {
      EXPECT_NEAR(splits[1] / splits[0], splits[4] / splits[3], 1e-9);
    }
  }
}

TEST(CascadeVolumes, HoldTheirSubFrustumWithATexelToSpareWhateverTheCameraDoes) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> place(-500, 500);
  const CascadeSettings settings;
  for (int i = 0; i < 500; ++i) {
    CascadePlanner planner;
    const auto camera = camera_at({place(engine), place(engine), place(engine)}, random_direction(engine));
    const CascadeLight light{.direction_ws = random_direction(engine)};
    for (const shared::CascadeRecord& record : planner.plan(camera, {&light, 1}, settings, true)) {
      EXPECT_EQ(record.side, settings.resolution);
      for (const glm::dvec3& corner : frustum_corners(camera, record.begin_m, record.end_m)) {
        const glm::dvec3 at(glm::dot(glm::dvec3(record.x_row), corner) - record.origin.x,
                            glm::dot(glm::dvec3(record.y_row), corner) - record.origin.y,
                            glm::dot(glm::dvec3(record.z_row), corner) - record.origin.z);
        EXPECT_GE(std::min(at.x, at.y), -0.01);
        EXPECT_LE(std::max(at.x, at.y), settings.resolution + 0.01);
        EXPECT_GE(at.z * record.unit_m, settings.reach_m - 0.01);
        EXPECT_LE(at.z, shared::FarDepth);
      }
    }
  }
}

TEST(CascadeVolumes, AreNoLargerThanTheDiameterNeeds) {
  const CascadeSettings settings;
  CascadePlanner planner;
  const auto camera = camera_at({1, 2, 3}, {0, 0, -1});
  for (const shared::CascadeRecord& record : planner.plan(camera, {&kSun, 1}, settings, true)) {
    const double diameter = diameter_of(frustum_corners(camera, record.begin_m, record.end_m));
    const double inner_m = double(record.texel_m) * (settings.resolution - 2);
    const bool has_overlap = record.begin_m > 1;  // with the cascade before
    EXPECT_GE(inner_m, diameter * 0.9999);
    EXPECT_LE(inner_m, diameter * (has_overlap ? 1.3 : 1.009));
  }
}

TEST(CascadeVolumes, KeepSizeAndAxesWhileTheCameraMovesTurnsAndJitters) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> place(-300, 300), jitter(-0.0005f, 0.0005f);
  CascadePlanner planner;
  std::vector<shared::CascadeRecord> first;
  for (int i = 0; i < 200; ++i) {
    const auto camera =
        camera_at({place(engine), place(engine), place(engine)}, random_direction(engine), i ? jitter(engine) : 0);
    const auto records = planner.plan(camera, {&kSun, 1}, {}, true);
    if (i == 0) first.assign(records.begin(), records.end());
    for (size_t c = 0; c < records.size(); ++c) {
      EXPECT_EQ(records[c].texel_m, first[c].texel_m);
      EXPECT_EQ(records[c].unit_m, first[c].unit_m);
      EXPECT_EQ(records[c].x_row, first[c].x_row);
      EXPECT_EQ(records[c].flags & shared::CascadeHolds, i ? shared::CascadeHolds : 0u) << i << ", " << c;
    }
  }
}

TEST(CascadeVolumes, HaveOneFrameOfHistory) {
  CascadePlanner planner;
  glm::ivec3 last(0);
  for (int i = 0; i < 20; ++i) {
    const auto at = static_cast<float>(i);
    const auto records = planner.plan(camera_at({0.5f * at, 0, 0.2f * at}, {0, 0, -1}), {&kSun, 1}, {}, true);
    if (i) {
      EXPECT_EQ(records[0].former, last);
      EXPECT_NE(records[0].origin, last);
    }
    last = records[0].origin;
  }
}

TEST(CascadeVolumes, StandStillUnderMotionBelowATexel) {
  // The middle of the sub-frustum's box within one texel and one unit: the same volume, so not one texel changes.
  CascadePlanner planner;
  const auto first = planner.plan(camera_at({0, 0, 0}, {0, 0, -1}), {&kSun, 1}, {}, true)[3];
  int same = 0;
  for (int i = 1; i <= 100; ++i) {
    const shared::CascadeRecord record = planner.plan(
        camera_at({first.texel_m * 0.001f * static_cast<float>(i), 0, 0}, {0, 0, -1}), {&kSun, 1}, {}, true)[3];
    const glm::ivec3 by = glm::abs(record.origin - first.origin);
    EXPECT_LE(std::max(by.x, by.y), 1);
    same += by.x == 0 && by.y == 0;
  }
  EXPECT_GE(same, 50);
}

TEST(CascadeVolumes, GiveMapsUpWhenTheProjectionChanges) {
  const auto camera = camera_at({0, 0, 0}, {0, 0, -1});
  const auto holds = [&](const CascadeLight& second, const CascadeSettings& settings, bool is_continued = true) {
    CascadePlanner planner;
    planner.plan(camera, {&kSun, 1}, {}, true);
    return (planner.plan(camera, {&second, 1}, settings, is_continued)[0].flags & shared::CascadeHolds) != 0;
  };
  EXPECT_TRUE(holds(kSun, {}));
  EXPECT_FALSE(holds(kSun, {}, false));
  CascadeLight turned = kSun;
  turned.direction_ws = glm::normalize(turned.direction_ws + glm::vec3(1e-4f, 0, 0));
  EXPECT_FALSE(holds(turned, {}));
  CascadeLight other = kSun;
  other.light_mask = 1;
  EXPECT_FALSE(holds(other, {}));
  EXPECT_FALSE(holds(kSun, {.resolution = 256}));
  EXPECT_FALSE(holds(kSun, {.distance_m = 150}));
  EXPECT_FALSE(holds(kSun, {.static_after = 5}));
  EXPECT_FALSE(holds(kSun, {.mode = Mode::redraw}));
}

TEST(CascadeVolumes, AreHeldOnlyWhereTheModeCanUseThem) {
  const auto held_after = [&](Mode mode, float metres) {
    CascadePlanner planner;
    CascadeSettings settings;
    settings.mode = mode;
    planner.plan(camera_at({0, 0, 0}, {0, 0, -1}), {&kSun, 1}, settings, true);
    const auto records = planner.plan(camera_at({metres, 0, 0}, {0, 0, -1}), {&kSun, 1}, settings, true);
    return std::pair((records[0].flags & shared::CascadeHolds) != 0, records[0].origin == records[0].former);
  };
  EXPECT_EQ(held_after(Mode::redraw, 0).first, false);
  EXPECT_EQ(held_after(Mode::cached, 0).first, true);
  EXPECT_EQ(held_after(Mode::cached, 1).first, false);
  EXPECT_EQ(held_after(Mode::scrolled, 1), std::pair(true, false));
  EXPECT_EQ(held_after(Mode::scrolled_literal, 1), std::pair(true, false));
  EXPECT_EQ(held_after(Mode::guard_band, 0.5f), std::pair(true, true));
  EXPECT_EQ(held_after(Mode::guard_band, 50).first, false);
}

TEST(CascadeVolumes, OfTheGuardBandHoldTheirSubFrustumWhereverTheyStay) {
  CascadeSettings settings;
  settings.mode = Mode::guard_band;
  CascadePlanner planner;
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> step(-0.4f, 0.6f);
  glm::vec3 eye(0);
  for (int i = 0; i < 300; ++i) {
    eye += glm::vec3(step(engine), step(engine), step(engine));
    const auto camera = camera_at(eye, {0, 0, -1});
    for (const shared::CascadeRecord& record : planner.plan(camera, {&kSun, 1}, settings, true)) {
      EXPECT_EQ(record.side, 512u + 2 * 64);
      for (const glm::dvec3& corner : frustum_corners(camera, record.begin_m, record.end_m)) {
        const glm::dvec3 at(glm::dot(glm::dvec3(record.x_row), corner) - record.origin.x,
                            glm::dot(glm::dvec3(record.y_row), corner) - record.origin.y,
                            glm::dot(glm::dvec3(record.z_row), corner) - record.origin.z);
        EXPECT_GE(std::min({at.x, at.y, at.z}), -0.01);
        EXPECT_LE(std::max(at.x, at.y), record.side + 0.01);
        EXPECT_LE(at.z, shared::FarDepth);
      }
    }
  }
}

TEST(CascadeVolumes, StayOnTheGridFarFromTheOriginAndOverThePole) {
  CascadePlanner planner;
  for (const glm::vec3& direction :
       {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(1e-6f, -1, 0), glm::vec3(0, 0, 1)})
    for (const float place : {0.0f, 1e4f, 1e7f, 1e12f}) {
      const CascadeLight light{.direction_ws = glm::normalize(direction)};
      for (const shared::CascadeRecord& record :
           planner.plan(camera_at({place, place, -place}, {0, 0, -1}), {&light, 1}, {}, true)) {
        EXPECT_LT(glm::abs(record.origin.x), int(shared::MostTexels));
        EXPECT_LT(glm::abs(record.origin.z), int(shared::MostUnits));
        EXPECT_TRUE(std::isfinite(record.texel_m) && record.texel_m > 0);
      }
    }
}

}  // namespace
}  // namespace umbrage
