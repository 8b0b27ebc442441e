// Results of bench layered: kept whole between runs, and claims and figures that follow from the rows.
#include <gtest/gtest.h>

#include "layered/layered_results.hpp"

namespace app {
namespace {

LayeredResults some_results() {
  LayeredResults results{
      .circumstances = {"device", "driver 1", "1.3", "0.1.0", true}, .date = "2026-01-02", .rows = {}};
  for (const uint32_t maps : {1u, 6u, 32u})
    for (const auto& [writer, ms] : {std::pair{"traditional", 1.0}, {"geometry_invocations", maps == 1 ? 1.5 : 0.6}})
      for (const auto& [test_case, figure] :
           {std::pair{"simple", "19.3"}, {"simple, discard", "19.4"}, {"skeletal", "19.6"}, {"four instances", "19.7"}})
        results.rows.push_back({"dragon", test_case, figure, writer, 256, maps, ms * maps, 0.01,
                                writer[0] == 't' ? 2.0 * maps : 3.0, writer[0] == 't' ? maps : 1});
  return results;
}

TEST(LayeredResults, ComeBackFromJson) {
  const LayeredResults results = some_results();
  const auto document = nlohmann::json::parse(to_json(results).dump());
  const auto read = results_from_json(document, "results.json");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->circumstances, results.circumstances);
  ASSERT_EQ(read->rows.size(), results.rows.size());
  for (size_t i = 0; i < results.rows.size(); ++i) {
    EXPECT_TRUE(read->rows[i].is_same_measurement(results.rows[i]));
    EXPECT_NEAR(read->rows[i].gpu_ms, results.rows[i].gpu_ms, 5e-5);  // kept in tenths of a microsecond
    EXPECT_EQ(read->rows[i].rounds, results.rows[i].rounds);
  }
  EXPECT_NE(read->find("dragon", "skeletal", "traditional", 256, 6), nullptr);
  EXPECT_EQ(read->find("dragon", "skeletal", "traditional", 512, 6), nullptr);
}

TEST(LayeredResults, AreBetterKnownByEveryRound) {
  LayeredResults results;
  results.add(
      {.scene = "s", .maps = 6, .gpu_ms = 4, .gpu_ms_spread = 1, .cpu_us = 3, .splits = 1, .rounds = 1, .repeats = 5});
  results.add({.scene = "s",
               .maps = 6,
               .gpu_ms = 3,
               .gpu_ms_spread = 0.5,
               .cpu_us = 5,
               .splits = 1,
               .rounds = 1,
               .repeats = 3});
  results.add(
      {.scene = "s", .maps = 8, .gpu_ms = 7, .gpu_ms_spread = 0, .cpu_us = 9, .splits = 1, .rounds = 1, .repeats = 5});
  ASSERT_EQ(results.rows.size(), 2u);
  EXPECT_EQ(results.rows[0].gpu_ms, 3);
  EXPECT_EQ(results.rows[0].gpu_ms_spread, 2) << "up to the worse round's median";
  EXPECT_EQ(results.rows[0].cpu_us, 3);
  EXPECT_EQ(results.rows[0].rounds, 2u);
  EXPECT_EQ(results.rows[0].repeats, 8u);
}

TEST(LayeredResults, RefuseWhatIsNotTheirs) {
  for (const char* text : {"{}", "[]", "{\"suite\": \"other\"}", "{\"suite\": \"layered\", \"rows\": [{}]}"})
    EXPECT_FALSE(results_from_json(nlohmann::json::parse(text), "results.json")) << text;
  auto document = nlohmann::json::parse(to_json(some_results()).dump());
  document["rows"][0]["maps"] = 0;
  EXPECT_FALSE(results_from_json(document, "results.json"));
}

TEST(LayeredResults, ClaimsSayWhatCameOut) {
  const auto claims = layered_claims(some_results());
  const auto found = [&](const std::string& begins) {
    for (const LayeredClaim& claim : claims)
      if (claim.claim.starts_with(begins)) return claim.found;
    return std::string("no such claim");
  };
  EXPECT_EQ(found("Simple shader, rasterised"), "+50 % (1), -40 % (6), -40 % (32)");
  EXPECT_EQ(found("Skeletal"), "-40 % (6), -40 % (32)");
  EXPECT_EQ(found("Four instances, no culling"), "from 6 maps on");
  EXPECT_EQ(found("The time per map"), "at 6 maps");
  EXPECT_NE(found("Recording cost").find("geometry_invocations 3.0 µs → 3.0 µs in 1 pass"), std::string::npos);
  EXPECT_EQ(found("All combined"), "no such claim") << "nothing is claimed without rows";
}

TEST(LayeredResults, FiguresHaveALineAWriter) {
  const auto figures = layered_figures(some_results());
  ASSERT_EQ(figures.size(), 5u);  // 19.3 to 19.7
  EXPECT_EQ(figures[0].stem, "figure-19.3-dragon");
  for (const LayeredFigure& figure : figures) {
    size_t lines = 0;
    for (size_t at = 0; (at = figure.svg.find("<polyline", at)) != std::string::npos; ++at) ++lines;
    EXPECT_EQ(lines, figure.stem == "figure-19.3-dragon" ? 2u : 4u) << figure.stem;
  }
  EXPECT_NE(layered_report_html(some_results()).find("driver 1"), std::string::npos);
  EXPECT_EQ(to_csv(some_results()).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace app
