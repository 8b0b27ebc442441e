// Cascades as users run them: every preset shows the same shadows, and the suite measures what the paper claims.
#include <gtest/gtest.h>

#include <map>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace {

constexpr const char* kSun =
    R"({"lights": [{"type": "directional", "direction": [0.4, -1, 0.3], "intensity": 20, "name": "sun"}]})";

TEST(Cascades, EveryPresetShowsThePictureOfARedraw) {
  const TemporaryFolder folder;
  const std::string sun = folder.write("sun.json", kSun).string();
  std::map<std::string, std::string> pictures;
  for (const std::string preset : {"redraw", "cached", "scrolled"}) {
    const std::string picture = folder.file(preset + ".png").string(), stats = folder.file(preset + ".json").string();
    const Outcome outcome = run_program({"render", data_file("room.gltf"), "-o", picture, "--size", "160x96",
                                         "--no-scene-lights", "--lights", sun, "--frames", "2", "--preset",
                                         "cascades-" + preset, "--stats", stats, "--validate"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    pictures[preset] = read_all(picture);
    const nlohmann::json document = parse_json(read_all(stats));
    ASSERT_EQ(document["cascades"].size(), 4u);
    const std::string expected = preset == "redraw" ? "cleared" : "kept";
    for (const auto& cascade : document["cascades"]) EXPECT_EQ(cascade["static_map"], expected);
  }
  EXPECT_EQ(pictures["redraw"], pictures["cached"]);
  EXPECT_EQ(pictures["redraw"], pictures["scrolled"]);
}

TEST(Cascades, AreRightAgainstTheRayTracer) {
  for (const char* preset : {"cascades-scrolled", "cascades-guard-band"}) {
    const Outcome outcome =
        run_program({"compare", "builtin:houses-lod", "--no-scene-lights", "--lights", data_file("sun.json"), "--size",
                     "480x270", "--preset", preset});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = parse_json(outcome.out);
    EXPECT_GT(report["pairs"]["evaluated"], 10000);
    EXPECT_LT(report["pairs"]["false_lit"], report["pairs"]["evaluated"]);
    EXPECT_LE(report["wrong_outside_texel_band"], 0.005) << preset;
    EXPECT_LE(report["leak"], 1e-3) << preset;
  }
}

TEST(Cascades, AreShownAndRefusedWithoutAPresetThatHasThem) {
  const TemporaryFolder folder;
  const std::string sun = folder.write("sun.json", kSun).string(), picture = folder.file("a.png").string();
  const std::vector<std::string> show{"render",  data_file("room.gltf"), "-o",       picture, "--size",
                                      "160x96",  "--no-scene-lights",    "--lights", sun,     "--show",
                                      "cascades"};
  std::vector<std::string> with_preset = show;
  with_preset.insert(with_preset.end(), {"--preset", "cascades-scrolled"});
  EXPECT_EQ(run_program(with_preset).status, 0);
  const Outcome refused = run_program(show);
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("cascades-scrolled"), std::string::npos) << refused.err;
}

// Measures, so it is apart, in a program run of its own.
TEST(CascadeBenchLongScene, QuickShowsWhatThePaperClaims) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"bench", "cascades", "--quick", "-o", folder.file("results").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json document = parse_json(read_all(folder.file("results/results.json")));
  const auto value = [&](const std::string& motion, const std::string& preset, const char* key) {
    for (const auto& row : document["rows"])
      if (row["case"] == motion && row["preset"] == "cascades-" + preset) return row[key].get<double>();
    ADD_FAILURE() << motion << ", " << preset;
    return 0.0;
  };
  EXPECT_EQ(document["rows"].size(), 35u);
  EXPECT_GE(value("translation 15 m/s", "redraw", "triangles"),
            10 * value("translation 15 m/s", "scrolled", "triangles"));
  EXPECT_GE(value("translation 15 m/s", "redraw", "gpu_ms"), 3 * value("translation 15 m/s", "scrolled", "gpu_ms"));
  for (const char* preset : {"cached", "scrolled", "guard-band"}) {
    EXPECT_EQ(value("standing still", preset, "triangles"), 0);
    EXPECT_EQ(value("standing still with movers", preset, "static_triangles"), 0);
    EXPECT_GT(value("standing still with movers", preset, "active_triangles"), 0);
  }
  for (const char* name :
       {"results.csv", "report.html", "figure-3-landscape.png", "figure-4-landscape.png", "figure-5-landscape.png"})
    EXPECT_GT(read_all(folder.file(std::string("results/") + name)).size(), 500u) << name;
}

}  // namespace
