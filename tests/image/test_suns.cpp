// Outdoor scenes under suns against the ray tracer: wrong pixel × light pairs outside the three-pixel band ≤ 0.3 %.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "program.hpp"

namespace {

struct Case {
  const char* name;
  const char* scene;   ///< Built-in, or shared.
  const char* lights;  ///< Of the tests' data.
  std::vector<std::string> options;
};

std::ostream& operator<<(std::ostream& stream, const Case& test) { return stream << test.name; }

void expect_right_shadows(const Case& test) {
  const std::string name = test.scene, scene = name.starts_with("builtin:") ? name : shared_scene(name);
  if (scene.empty()) GTEST_SKIP() << test.scene << " is not in " << UMBRAGE_SCENES_DIR;
  std::vector<std::string> arguments = {"compare", scene, "--no-scene-lights", "--lights", data_file(test.lights)};
  arguments.insert(arguments.end(), test.options.begin(), test.options.end());
  const Outcome outcome = run_program(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json report = parse_json(outcome.out);
  EXPECT_GT(report["pairs"]["evaluated"], 10000);
  EXPECT_LT(report["pairs"]["false_lit"], report["pairs"]["evaluated"]);
  EXPECT_LE(report["wrong_outside_band"], 0.003) << report["worst_lights"].dump(1).substr(0, 2000);
  EXPECT_EQ(report["unbacked_taps"], 0);
  EXPECT_EQ(report["overflows"], 0);
  EXPECT_EQ(report["lights_degraded"], 0);
  testing::Test::RecordProperty("wrong_outside_band", report["wrong_outside_band"].dump());
}

/// The landscape under its own sun and lamps: each kind of light by itself.
void expect_right_sun_and_lamps(std::vector<std::string> options) {
  options.insert(options.begin(), "compare");
  const Outcome outcome = run_program(options);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json report = parse_json(outcome.out);
  const auto& worst = report["worst_lights"];
  const auto sun =
      std::find_if(worst.begin(), worst.end(), [](const auto& light) { return light["type"] == "directional"; });
  const int evaluated = report["pairs"]["evaluated"], wrong = report["pairs"]["wrong_outside_band"];
  EXPECT_GT(evaluated, 20000);
  EXPECT_EQ(report["overflows"], 0);
  EXPECT_EQ(report["unbacked_taps"], 0);
  EXPECT_EQ(report["lights_degraded"], 0);
  EXPECT_LE(report["acne"], 1e-3);
  EXPECT_LE(report["leak"], 1e-4);
  // Ten lights are listed; a sun with next to nothing wrong need not be one.
  if (sun == worst.end()) {
    EXPECT_LE(wrong, 0.002 * evaluated);
    return;
  }
  const int of_sun = (*sun)["pairs"]["evaluated"], wrong_of_sun = (*sun)["pairs"]["wrong_outside_band"];
  EXPECT_LE(wrong_of_sun, 0.003 * of_sun);
  EXPECT_LE(wrong - wrong_of_sun, 0.002 * (evaluated - of_sun));
}

TEST(LandscapeFastScene, SunAndLampsAreRight) {
  expect_right_sun_and_lamps({"builtin:landscape-lod", "--size", "320x180"});
}

class LandscapeLongScene : public testing::TestWithParam<const char*> {};
TEST_P(LandscapeLongScene, SunAndLampsAreRight) {
  expect_right_sun_and_lamps({"builtin:landscape", "--size", "640x360", "--camera", GetParam(), "--validate"});
}
INSTANTIATE_TEST_SUITE_P(Suns, LandscapeLongScene, testing::Values("overview", "street", "quay"),
                         [](const auto& tested) { return std::string(tested.param); });

class FastSunScene : public testing::TestWithParam<Case> {};
class LongSunScene : public testing::TestWithParam<Case> {};
TEST_P(FastSunScene, ShadowsAreRight) { expect_right_shadows(GetParam()); }
TEST_P(LongSunScene, ShadowsAreRight) { expect_right_shadows(GetParam()); }

const auto name_of = [](const testing::TestParamInfo<Case>& info) { return std::string(info.param.name); };

const std::string kMiddle = "640x360";
constexpr const char *kHouses = "builtin:houses", *kForest = "stk_black_forest/black_forest.gltf",
                     *kNecropolis = "zad_necropolis/necropolis.gltf";

INSTANTIATE_TEST_SUITE_P(
    Suns, FastSunScene,
    testing::Values(Case{"houses_lod", "builtin:houses-lod", "sun.json", {"--size", "480x270", "--validate"}},
                    Case{"forest", kForest, "sun.json", {"--size", kMiddle}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Suns, LongSunScene,
    testing::Values(Case{"houses", kHouses, "sun.json", {"--size", kMiddle}},
                    Case{"houses_3", kHouses, "suns.json", {"--size", kMiddle}},
                    Case{"houses_fragments", kHouses, "sun.json", {"--size", kMiddle, "--set", "writer=fragments"}},
                    Case{"houses_4_levels", kHouses, "sun.json", {"--size", "1280x720", "--set", "levels_per_sun=4"}},
                    Case{"forest_1", kForest, "sun.json", {"--size", kMiddle, "--camera", "1"}},
                    Case{"forest_2", kForest, "sun.json", {"--size", kMiddle, "--camera", "2"}},
                    Case{"forest_3", kForest, "suns.json", {"--size", kMiddle, "--camera", "1"}},
                    Case{"necropolis", kNecropolis, "sun.json", {"--size", "320x180"}},
                    Case{"necropolis_1", kNecropolis, "sun.json", {"--size", "320x180", "--camera", "1"}},
                    Case{"necropolis_3", kNecropolis, "suns.json", {"--size", "320x180"}}),
    name_of);

}  // namespace
