// A pool that is too small: everything that is marked stays backed and every answer stays the same from frame to frame, maps
// get coarser by priority, and the statistics say which, why, and what would cure it.
#include <algorithm>
#include <bit>
#include <map>
#include <tuple>

#include "pair_rig.hpp"

namespace umbrage::test {
namespace {

class Budget : public GpuTest {};

uint64_t bytes_of(uint64_t units) { return units * shared::PoolUnit * sizeof(uint32_t); }

/// What was marked lies in the pool, and what is coarser than it was asked for is reported.
void expect_within_budget(PairRig& rig, const DeviceMaps& maps, uint32_t budget_mib) {
  const shared::FrameCounters& counters = maps.counters;
  EXPECT_EQ(counters.fitted, 1u);
  EXPECT_LE(bytes_of(counters.pool_units), uint64_t(budget_mib) << 20);
  EXPECT_LE(rig.system().statistics().shadow_memory_bytes, uint64_t(budget_mib) << 20);
  std::vector<std::pair<uint64_t, uint64_t>> places;  // begin, end of each word's pages
  for (const shared::MapRecord& map : maps.maps) {
    const uint32_t units = shared::page_units_of(map.resolution);
    for (uint32_t word = map.first_word; word < map.first_word + map.words * map.view_count; ++word) {
      const uint64_t first = maps.page_first[word], count = uint64_t(std::popcount(maps.page_bits[word])) * units;
      if (count > 0) places.push_back({first, first + count});
    }
  }
  std::sort(places.begin(), places.end());
  for (size_t i = 0; i < places.size(); ++i)
    ASSERT_LE(places[i].second, i + 1 < places.size() ? places[i + 1].first : counters.pool_units);

  std::map<uint32_t, LightStatus> reported;
  for (const LightStatus& status : rig.system().degraded_lights())
    EXPECT_TRUE(reported.insert({slot_of(status.light), status}).second);
  for (uint32_t slot = 0; slot < maps.light_maps.size(); ++slot) {
    const bool coarser = maps.light_maps[slot].shift > 0 && maps.light_maps[slot].count > 0;
    ASSERT_EQ(reported.contains(slot), coarser) << "slot " << slot;
    if (!coarser) continue;
    EXPECT_EQ(reported[slot].reason, Degradation::coarser);
    EXPECT_EQ(reported[slot].missing_bytes, bytes_of(counters.pool_units_asked) - bytes_of(counters.pool_units));
  }
  EXPECT_EQ(rig.system().statistics().lights_degraded, reported.size());
  EXPECT_EQ(reported.empty(), counters.pool_units_asked == counters.pool_units);
}

/// Resolutions are halved alike, but for one halving less where there is room; unless they are the coarsest there are.
void expect_even(const DeviceMaps& maps) {
  uint32_t least = shared::MaxShift, most = 0;
  for (const shared::LightMaps& light : maps.light_maps) {
    if (light.count == 0) continue;
    least = std::min(least, light.shift), most = std::max(most, light.shift);
  }
  EXPECT_LE(most, least + 1);
}

/// Systems of one budget after the other, from plenty to starvation and back.
void starve(Gpu& gpu, const SeenScene& scene, const FrameSettings& settings, const std::vector<uint32_t>& budgets_mib) {
  std::map<uint32_t, Pairs> before;
  for (const uint32_t budget_mib : budgets_mib) {
    SCOPED_TRACE(std::to_string(budget_mib) + " MiB");
    PairRig rig(gpu, {.budget_mib = budget_mib}, scene);
    const Pairs answers = rig.settle(settings);
    EXPECT_EQ(differences(answers, rig.evaluate(settings)), 0u) << "a still picture flickers";
    const DeviceMaps maps(rig);
    expect_within_budget(rig, maps, budget_mib);
    expect_even(maps);
    const auto [known, is_new] = before.try_emplace(budget_mib, answers);
    if (!is_new) { EXPECT_EQ(differences(known->second, answers), 0u); }
    EXPECT_EQ(rig.system().degraded_lights().empty(), budget_mib == budgets_mib.front())
        << bytes_of(maps.counters.pool_units_asked) << " bytes asked for";
  }
}

TEST_F(Budget, OfFewLightsThatWantMuchFallsAndReturns) {
  starve(gpu(), balls_scene(40, 12, 41), {.min_resolution = 1024}, {256, 16, 4, 256});
}

TEST_F(Budget, OfThousandsOfLightsFallsAndReturns) {
  starve(gpu(), balls_scene(20, 4096, 42, 32, 32), {.undersampling = 4, .merge_below = 16}, {256, 4, 256});
}

// --- A live system ----------------------------------------------------------------------------------------------------------

/// What a host may rely on in every frame, one whose tables are still growing included.
void expect_sound(PairRig& rig, const Pairs& answers, uint32_t budget_mib) {
  const Statistics& statistics = answers.statistics;
  EXPECT_EQ(statistics.unbacked_taps, 0u);
  EXPECT_GT(answers.asked(), 0u);
  EXPECT_LE(statistics.texels_allocated * sizeof(uint32_t), uint64_t(budget_mib) << 20);
  EXPECT_LE(statistics.shadow_memory_bytes, uint64_t(budget_mib) << 20);
  const uint64_t missing = (statistics.texels_requested - statistics.texels_allocated) * sizeof(uint32_t);
  EXPECT_EQ(rig.system().degraded_lights().empty(), missing == 0);
  EXPECT_EQ(statistics.lights_degraded, rig.system().degraded_lights().size());
  for (const LightStatus& status : rig.system().degraded_lights()) {
    EXPECT_EQ(status.reason, Degradation::coarser);
    EXPECT_EQ(status.missing_bytes, missing);
  }
}

/// What one system is asked for during some frames.
struct Demand {
  uint32_t lights;  // of the scene, the first ones
  uint32_t min_resolution;
  bool starves;
  bool operator<(const Demand& other) const {
    return std::tie(lights, min_resolution) < std::tie(other.lights, other.min_resolution);
  }
};

/// Has the system hold the first `count` lights of the scene.
void hold_lights(PairRig& rig, const SeenScene& scene, uint32_t count) {
  for (; rig.light_ids.size() > count; rig.light_ids.pop_back()) take(rig.system().remove(rig.light_ids.back()));
  while (rig.light_ids.size() < count)
    rig.light_ids.push_back(take(rig.system().add_light(scene.scene.lights[rig.light_ids.size()])));
}

TEST_F(Budget, OfALiveSystemFallsAndReturns) {
  constexpr uint32_t kBudgetMib = 12, kStillFrames = 3;
  const SeenScene scene = balls_scene(40, 400, 46);
  const Demand demands[] = {{12, 16, false},  {12, 256, false}, {12, 1024, true},  {12, 64, false}, {96, 16, false},
                            {400, 16, true},  {400, 512, true}, {400, 1024, true}, {400, 16, true}, {96, 16, false},
                            {12, 1024, true}, {12, 256, false}, {12, 16, false}};
  std::map<Demand, Pairs> known;
  uint32_t unsettled = 0;
  PairRig rig(gpu(), {.budget_mib = kBudgetMib, .max_cluster_light_pairs = 1024}, scene);
  for (const Demand& demand : demands) {
    SCOPED_TRACE(std::to_string(demand.lights) + " lights of at least " + std::to_string(demand.min_resolution));
    hold_lights(rig, scene, demand.lights);
    Pairs settled;
    uint32_t still = 0;
    for (uint32_t frame = 0; still < kStillFrames; ++frame) {
      ASSERT_LT(frame, 4 + kStillFrames) << "does not settle";
      const Pairs answers = rig.evaluate({.min_resolution = demand.min_resolution});
      expect_sound(rig, answers, kBudgetMib);
      if (answers.statistics.overflows > 0) {
        EXPECT_EQ(still, 0u) << "settles only once";
        ++unsettled;
        continue;
      }
      EXPECT_EQ(rig.system().degraded_lights().empty(), !demand.starves);
      if (still++ == 0)
        settled = answers;
      else
        EXPECT_EQ(differences(settled, answers), 0u) << "a still picture flickers";
    }
    const auto [before, is_new] = known.try_emplace(demand, settled);
    if (!is_new) { EXPECT_EQ(differences(before->second, settled), 0u) << "depends on what was before"; }
  }
  EXPECT_TRUE(rig.system().degraded_lights().empty());
  EXPECT_GT(unsettled, 0u) << "tables never had to grow";
  // Nor does a system that starves know that it once did not.
  const Demand& starved = demands[2];
  SeenScene fewer = scene;
  fewer.scene.lights.resize(starved.lights);
  PairRig fresh(gpu(), {.budget_mib = kBudgetMib}, fewer);
  EXPECT_EQ(differences(known.at(starved), fresh.settle({.min_resolution = starved.min_resolution})), 0u);
  EXPECT_GT(differences(known.at(demands[0]), known.at(starved)), 0u) << "starving makes no difference";
}

TEST_F(Budget, IsCuredByWhatTheReportSays) {
  const SeenScene scene = balls_scene(20, 30, 43);
  const FrameSettings settings{.min_resolution = 512};
  PairRig poor(gpu(), {.budget_mib = 4}, scene);
  poor.settle(settings);
  ASSERT_FALSE(poor.system().degraded_lights().empty());
  const uint64_t bytes = bytes_of(poor.counters().pool_units) + poor.system().degraded_lights()[0].missing_bytes;
  EXPECT_EQ(bytes, poor.system().statistics().texels_requested * sizeof(uint32_t));
  PairRig cured(gpu(), {.budget_mib = static_cast<uint32_t>((bytes + (1 << 20) - 1) >> 20)}, scene);
  cured.settle(settings);
  EXPECT_TRUE(cured.system().degraded_lights().empty());
  PairRig short_by_a_little(gpu(), {.budget_mib = static_cast<uint32_t>(bytes >> 20)}, scene);
  short_by_a_little.settle(settings);
  EXPECT_FALSE(short_by_a_little.system().degraded_lights().empty());
}

TEST_F(Budget, GoesToImportantLightsFirst) {
  SeenScene scene = balls_scene(20, 0, 44);
  for (uint32_t i = 0; i < 40; ++i) {  // two of each, the later one more important
    const float x = float(i / 2 % 5) * 4 - 8, z = float(i / 10) * 4 - 8;
    scene.scene.lights.push_back(
        {.position = {x, 3, z}, .range_m = 6, .priority = i % 2 ? 2.0f : 1.0f, .host_index = i});
  }
  uint32_t uneven = 0;
  for (const uint32_t budget_mib : {4u, 6u, 9u, 12u}) {
    PairRig rig(gpu(), {.budget_mib = budget_mib}, scene);
    rig.settle({.min_resolution = 512});
    const DeviceMaps maps(rig);
    uint32_t worst_important = 0, best_other = shared::MaxShift, used = 0;
    for (uint32_t i = 0; i < 40; ++i) {
      const shared::LightMaps& light = maps.light_maps[slot_of(rig.light_ids[i])];
      if (light.count == 0) continue;
      ++used;
      if (i % 2)
        worst_important = std::max(worst_important, light.shift);
      else
        best_other = std::min(best_other, light.shift);
    }
    EXPECT_GT(used, 20u);
    uint32_t finer = 0, coarser = 0;
    for (uint32_t i = 1; i < 40; i += 2) {
      const uint32_t important = maps.light_maps[slot_of(rig.light_ids[i])].shift,
                     other = maps.light_maps[slot_of(rig.light_ids[i - 1])].shift;
      finer += important<other, coarser += important> other;
    }
    EXPECT_EQ(coarser, 0u) << budget_mib << " MiB";
    EXPECT_TRUE(worst_important <= best_other || finer == 0)
        << "others are only finer where all are alike: " << budget_mib << " MiB";
    uneven += finer > 0;
  }
  EXPECT_GT(uneven, 1u);
}

/// 4 MiB hold the coarsest maps of 32768 views: of more lights, the least important go without and cast no shadow.
TEST_F(Budget, LeavesTheLeastImportantOfTooManyLightsWithoutMaps) {
  constexpr uint32_t kLights = 5600, kWithMaps = (4u << 20) / (6 * 128);
  SeenScene scene = balls_scene(10, 0, 45, 32, 32);
  for (uint32_t i = 0; i < kLights; ++i)
    scene.scene.lights.push_back({.position = {float(i % 75) * 0.3f - 11, 1.5f, float(i / 75) * 0.3f - 11},
                                  .range_m = 2.5f,
                                  .priority = i % 3 ? 1.0f : 2.0f,
                                  .host_index = i});
  PairRig rig(gpu(), {.budget_mib = 4}, scene);
  const Pairs answers = rig.settle();
  EXPECT_EQ(differences(answers, rig.evaluate()), 0u);
  std::vector<uint32_t> without;
  for (const LightStatus& status : rig.system().degraded_lights()) {
    if (status.reason != Degradation::no_map) continue;
    without.push_back(slot_of(status.light));
    EXPECT_EQ(status.missing_bytes, 6u * 128);
  }
  std::sort(without.begin(), without.end());
  std::vector<uint32_t> expected;  // the last ones among the less important
  for (uint32_t i = kLights; expected.size() < kLights - kWithMaps;)
    if (--i % 3) expected.insert(expected.begin(), slot_of(rig.light_ids[i]));
  EXPECT_EQ(without, expected);
  for (size_t pixel = 0; pixel < answers.clusters.size(); ++pixel)
    for (const uint32_t slot : expected) {
      const float visibility = answers.visibility[pixel * kLights + slot];
      ASSERT_TRUE(visibility < 0 || visibility == 1) << "light " << slot;
    }
}

}  // namespace
}  // namespace umbrage::test
