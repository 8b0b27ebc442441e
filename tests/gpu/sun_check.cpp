#include "sun_check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "views/sun_levels.shared.h"

namespace umbrage::test {

static_assert(reference::sun_places == shared::SunPlaces);

namespace {

reference::Box reference_box(const shared::Box& box) {
  reference::Box out;
  out.min = box.lo, out.max = box.hi;
  return out;
}

}  // namespace

SunCheck::SunCheck(const DeviceMaps& maps, const shared::Box& casters)
    : maps_(maps), casters_(reference_box(casters)) {}

reference::SunPlane SunCheck::plane(const shared::LightRecord& light) const {
  return reference::sun_plane(light.direction_ws, casters_);
}

uint32_t SunCheck::place(const shared::MapRecord& map) const {
  return map.first_view - maps_.light_records[map.light].first_view - shared::SunFirstWindow;
}

reference::PlaneWindow SunCheck::window(const shared::MapRecord& map) const {
  const shared::ShadowView& view = maps_.views[map.first_view];
  // Clip coordinate -1, where x_offset is that of the world's origin.
  const double half = map.resolution / 2.0;
  return {glm::dvec2(-1 - double(view.x_offset), -1 - double(view.y_offset)) * half, double(map.resolution)};
}

void SunCheck::expect_window(const shared::MapRecord& map, const reference::PlaneRect& asked, uint32_t most) const {
  SCOPED_TRACE("place " + std::to_string(place(map)));
  const reference::SunPlane plane = this->plane(maps_.light_records[map.light]);
  const shared::ShadowView& view = maps_.views[map.first_view];
  const double texel = plane.texel_m(place(map)), whole = 32 * plane.reach_m / texel;
  EXPECT_EQ(view.side_m, texel * map.resolution);
  EXPECT_TRUE(std::has_single_bit(map.resolution) && map.resolution <= std::min(double(most), whole));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(view.x_row[i] * view.side_m / 2, plane.right[i], 1e-6);
    EXPECT_NEAR(view.y_row[i] * view.side_m / 2, plane.down[i], 1e-6);
    EXPECT_NEAR(view.z_row[i], -plane.forward[i] / (4 * plane.reach_m), 1e-6 / plane.reach_m);
  }
  EXPECT_EQ(view.z_offset, 0.5f);
  // Begins on a whole page, small ones on a quarter of their side; all of the plane may begin anywhere.
  const reference::PlaneWindow window = this->window(map);
  const double step = std::min(map.resolution / 4.0, double(reference::sun_window_step));
  for (int i = 0; i < 2 && map.resolution < whole; ++i) EXPECT_EQ(std::fmod(window.first[i], step), 0);
  const double far =
      asked.empty() ? 0 : std::max({-asked.low.x, -asked.low.y, asked.high.x, asked.high.y, 0.0}) / texel;
  const double slack = 1e-2 + 2e-6 * far;
  const bool is_largest = map.resolution == std::min(double(most), whole);
  EXPECT_TRUE(holds(window, plane, place(map), asked, -slack) || is_largest);
  // Half of it, begun on its own steps around what was asked for, would not do.
  if (map.resolution <= std::min({256.0, double(most), whole}) || asked.empty()) return;
  const double half = map.resolution / 2.0, half_step = std::min(half / 4, double(reference::sun_window_step));
  const glm::dvec2 first = glm::floor((asked.low / texel - 1.05 - slack) / half_step) * half_step;
  EXPECT_FALSE(holds({first, half}, plane, place(map), asked, slack)) << map.resolution << " texels";
}

bool SunCheck::expect_maps(uint32_t slot, const std::vector<uint32_t>& pairs, const FrameSettings& settings) const {
  SCOPED_TRACE("sun " + std::to_string(slot));
  const shared::LightRecord& light = maps_.light_records[slot];
  const shared::LightMaps& own = maps_.light_maps[slot];
  const reference::SunPlane plane = this->plane(light);
  const shared::ShadowView& all = maps_.views[light.first_view];
  const glm::dvec2 middle(glm::dot(plane.right, glm::dvec3(all.origin)), glm::dot(plane.down, glm::dvec3(all.origin)));
  const reference::PlaneRect lit{middle - all.side_m / 2.0, middle + all.side_m / 2.0};
  const uint32_t most = std::bit_floor(std::min(settings.max_resolution, light.resolution));

  std::vector<uint32_t> places;
  std::vector<reference::PlaneRect> rects;
  for (const uint32_t pair : pairs) {
    const double request = maps_.pair_requests[pair];
    places.push_back(reference::sun_place_of_request(request));
    if (places.back() != reference::sun_place_of_request(request * (1 + 1e-5)) ||
        places.back() != reference::sun_place_of_request(request * (1 - 1e-5)))
      return false;
    rects.push_back(intersection(rect_on_plane(plane, reference_box(maps_.boxes[maps_.pair_clusters[pair]])), lit));
  }
  std::vector<const shared::MapRecord*> maps;
  for (uint32_t i = 0; i < own.count; ++i) maps.push_back(&maps_.maps[own.first + i]);
  for (const shared::MapRecord* map : maps) {
    reference::PlaneRect asked;  // of its own level and all finer ones
    for (size_t i = 0; i < pairs.size(); ++i)
      if (places[i] <= place(*map)) asked = union_of(asked, rects[i]);
    expect_window(*map, asked, most);
  }
  EXPECT_LE(own.count, settings.levels_per_sun);
  // With room for all, every level that is asked for has a map.
  for (const uint32_t asked : std::set<uint32_t>(places.begin(), places.end()))
    EXPECT_TRUE(own.count == settings.levels_per_sun ||
                std::any_of(maps.begin(), maps.end(), [&](const auto* map) { return place(*map) == asked; }) ||
                settings.levels_per_sun < 16);
  for (size_t i = 0; i < pairs.size(); ++i) {
    const uint32_t chosen = maps_.pair_maps[pairs[i]] - own.first;
    if (chosen >= own.count) {
      ADD_FAILURE() << "pair " << pairs[i] << " has a map of another light";
      continue;
    }
    EXPECT_GE(place(*maps[chosen]), places[i]);
    const auto fits = [&](size_t map, double slack) {
      return holds(window(*maps[map]), plane, place(*maps[map]), rects[i], slack);
    };
    EXPECT_TRUE(chosen + 1 == own.count || fits(chosen, -0.1));
    EXPECT_TRUE(fits(own.count - 1, -0.1)) << "the coarsest holds everything";
    for (size_t finer = 0; finer < chosen; ++finer)
      EXPECT_TRUE(place(*maps[finer]) < places[i] || !fits(finer, 0.1))
          << "pair " << pairs[i] << " could have a finer map";
  }
  return true;
}

}  // namespace umbrage::test
