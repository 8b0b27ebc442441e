// The landscape against its promise: one low sun over 200 lamps, a town at a lake, the same with few triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "builtin_scene.hpp"
#include "scenes/country_plan.hpp"
#include "scenes/land.hpp"

namespace {

using app::LightKind;
using app::Scene;
using glm::vec2;
using glm::vec3;

class EveryLandscape : public testing::TestWithParam<std::string> {};

size_t lights_of(const Scene& scene, LightKind kind) {
  return static_cast<size_t>(std::count_if(scene.lights.begin(), scene.lights.end(),
                                           [&](const app::Light& light) { return light.kind == kind; }));
}

TEST_P(EveryLandscape, HasOneSunAndTwoHundredLamps) {
  const Scene& s = builtin(GetParam());
  EXPECT_EQ(lights_of(s, LightKind::directional), 1u);
  EXPECT_EQ(s.lights.size(), 201u);
  EXPECT_GE(lights_of(s, LightKind::spot), 20u);
  EXPECT_GE(lights_of(s, LightKind::point), 130u);
  for (const PlacedLight& placed : placed_lights(s)) {
    const app::Light& light = *placed.light;
    if (light.kind == LightKind::directional) continue;
    EXPECT_GE(light.range, 9) << light.name;
    EXPECT_LE(light.range, 34) << light.name;
    EXPECT_GE(light.intensity / 9, 2) << light.name << ": too dim at 3 m";
    EXPECT_GT(placed.position.y, app::land_height({placed.position.x, placed.position.z})) << light.name;
  }
}

TEST_P(EveryLandscape, SunIsLowAndCastsLongShadows) {
  const Scene& s = builtin(GetParam());
  for (const app::Node& node : s.nodes) {
    if (node.light < 0 || s.lights[static_cast<size_t>(node.light)].kind != LightKind::directional) continue;
    const vec3 down = node.rotation * vec3(0, 0, -1);
    const float shadow = glm::length(vec2(down.x, down.z)) / -down.y;  // Metres a metre of height.
    EXPECT_GE(shadow, 4);
    EXPECT_LE(shadow, 7);
  }
}

TEST_P(EveryLandscape, Cameras) {
  const Scene& s = builtin(GetParam());
  ASSERT_EQ(s.cameras.size(), 3u);
  EXPECT_EQ(s.cameras[0].name, "overview");
  EXPECT_EQ(s.cameras[1].name, "street");
  EXPECT_EQ(s.cameras[2].name, "quay");
}

TEST_P(EveryLandscape, ReachesFarEnoughForCascades) {
  vec3 low(1e9f), high(-1e9f);
  for (const app::Mesh& mesh : builtin(GetParam()).meshes) {
    if (mesh.name != "land") continue;
    for (const app::Primitive& primitive : mesh.primitives)
      for (vec3 p : primitive.positions) low = glm::min(low, p), high = glm::max(high, p);
  }
  EXPECT_GE(high.x - low.x, 800);
  EXPECT_GE(high.z - low.z, 800);
  EXPECT_GE(high.y - low.y, 40);
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryLandscape, testing::Values("landscape", "landscape-lod"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Landscape, TriangleCounts) {
  const size_t full = drawn_triangles(builtin("landscape")), low = drawn_triangles(builtin("landscape-lod"));
  EXPECT_GE(full, 1'300'000u);
  EXPECT_LE(full, 1'700'000u);
  EXPECT_LE(low, full / 5);
}

TEST(Landscape, OnlyTheLakeIsUnderWater) {
  for (float z = -app::land_half_m; z <= app::land_half_m; z += 5) {
    for (float x = -app::land_half_m; x <= app::land_half_m; x += 5) {
      const float height = app::land_height({x, z}), shore = app::shore_distance({x, z});
      ASSERT_TRUE(std::isfinite(height));
      EXPECT_EQ(height < 0, shore < 0) << x << ", " << z;
    }
  }
}

TEST(Landscape, NothingGrowsInWaterRoadsOrStreets) {
  const app::Terrain town(app::land_site());
  const app::CountryPlan plan = app::plan_country(town);
  size_t trees = 0;
  for (const app::Standing& standing : plan.standing) {
    const vec2 at{standing.position.x, standing.position.z};
    const bool is_tree = (standing.model >= app::Model::oak && standing.model <= app::Model::bush) ||
                         (standing.model >= app::Model::fir && standing.model <= app::Model::birch);
    if (!is_tree) continue;
    ++trees;
    EXPECT_GT(app::land_height(at), 0);
    EXPECT_GT(app::road_distance(at), 1);
    EXPECT_GT(town.street_distance(at), 1);
  }
  EXPECT_GE(trees, 1500u);
  for (const app::Standing& lamp : plan.road_lamps) {
    const float edge = app::road_distance({lamp.position.x, lamp.position.z});
    EXPECT_GT(edge, 0);
    EXPECT_LT(edge, 1);
  }
}

}  // namespace
