// The street plan of HOUSES and the lie of its land.
#include "scenes/town_site.hpp"

#include <algorithm>
#include <cmath>

namespace app {
namespace {

using glm::vec2;

/// Crossings of the street plan, moved a little off their lattice; row and column 2 hold the main streets.
constexpr std::array<float, 5> columns{-84, -43, 0, 44, 85}, rows{-86, -50, 2, 45, 86};
constexpr std::array<std::array<vec2, 5>, 5> offsets{{{{{2, 3}, {-3, -1}, {0, 2}, {3, -2}, {-2, 2}}},
                                                      {{{-3, -2}, {2, 2}, {0, 1}, {-2, -2}, {3, 1}}},
                                                      {{{1, -3}, {-1, 2}, {0, 0}, {2, -2}, {-3, 3}}},
                                                      {{{-2, 3}, {3, -3}, {2, 1}, {-3, 2}, {1, -3}}},
                                                      {{{3, -2}, {-2, 1}, {-4, 2}, {1, 3}, {-2, -2}}}}};

vec2 crossing(size_t column, size_t row) { return vec2(columns[column], rows[row]) + offsets[row][column]; }

float height(vec2 p) {
  const float climb = -0.022f * std::clamp(p.y, -100.0f, 110.0f);
  const float rolls =
      0.55f * std::sin(0.043f * p.x + 0.6f) * std::cos(0.037f * p.y) + 0.35f * std::sin(0.061f * p.y - 0.031f * p.x);
  const float out = std::max(glm::length(p), std::max(std::abs(p.x), std::abs(p.y)) * 1.1f);
  const float hills = smooth_ramp(112, 178, out) * (6.5f + 3.5f * std::sin(0.05f * p.x + 1) * std::cos(0.045f * p.y));
  return climb + rolls + hills;
}

}  // namespace

TownSite houses_site() {
  TownSite site{.half_m = 100, .streets = {}, .height = height, .outlying_trees = 52};
  const auto add = [&](vec2 a, vec2 b, float half_width) { site.streets.push_back({a, b, half_width}); };
  for (size_t row = 0; row < 5; ++row) {
    for (size_t column = 0; column < 5; ++column) {
      const vec2 here = crossing(column, row);
      if (column < 4) add(here, crossing(column + 1, row), row == 2 ? main_street_half_m : lane_half_m);
      // The church stands between the square and the street behind it.
      const bool church = column == 2 && row == 1;
      if (row < 4 && !church) add(here, crossing(column, row + 1), column == 2 ? main_street_half_m : lane_half_m);
    }
  }
  add(crossing(2, 4), {-9, town_world_half_m}, main_street_half_m);
  add(crossing(0, 2), {-town_world_half_m, -8}, lane_half_m);
  add(crossing(4, 2), {town_world_half_m, 14}, lane_half_m);
  return site;
}

void add_town_ground(MeshBuilder& builder, const Terrain& terrain, Detail detail) {
  constexpr std::array kinds{GroundKind{.mat = Mat::cobble, .below_m = kerb_m}, GroundKind{.mat = Mat::flagstone}};
  const GroundDesc desc{.kinds = kinds, .rest = {.mat = Mat::grass}, .height = height, .fields = [&](vec2 p) {
                          const float street = terrain.street_distance(p);
                          return GroundFields{street, street - pavement_m};
                        }};
  const float step = detail == Detail::low ? 5.0f : 2.1f;
  add_ground(builder, desc,
             grid_lines({.half = town_world_half_m,
                         .fine_half = terrain.site().half_m + 4,
                         .step = step,
                         .coarse = std::max(step, 6.0f)}));
}

}  // namespace app
