// The mill, the shore and the farms first, lamps along the roads, then trees where nothing else is.
#include "scenes/country_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/country.hpp"
#include "scenes/house.hpp"
#include "scenes/land.hpp"
#include "scenes/props.hpp"
#include "scenes/random.hpp"

namespace app {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float half_turn = 3.1415927f;

/// A point on a road's middle line.
struct Milestone {
  vec2 at, left;  ///< Of the way out of the town, unit length.
};

/// Every `spacing` metres along a road, from `first` to `last`.
std::vector<Milestone> milestones(const Road& road, float first, float spacing, float last) {
  std::vector<Milestone> result;
  float gone = 0, next = first;
  for (size_t i = 0; i + 1 < road.size(); ++i) {
    const float length = glm::distance(road[i], road[i + 1]);
    const vec2 along = (road[i + 1] - road[i]) / length;
    for (; next < std::min(gone + length, last); next += spacing)
      result.push_back({road[i] + along * (next - gone), {along.y, -along.x}});
    gone += length;
  }
  return result;
}

class CountryPlanner {
 public:
  explicit CountryPlanner(const Terrain& town) : town_(town) {}

  CountryPlan run() {
    place_mill();
    place_shore();
    place_farms();
    place_road_lamps();
    place_bales();
    place_orchard();
    place_avenues();
    place_woods();
    place_hedges();
    return std::move(plan_);
  }

 private:
  struct Circle {
    vec2 middle;
    float radius;
  };
  void put(Model model, vec2 at, float turn, float scale = 1) {
    plan_.standing.push_back({model, {at.x, ground(at), at.y}, turn, scale});
  }
  void put_lamp(vec2 at, float turn) {
    plan_.yard_lamps.push_back({Model::yard_lamp, {at.x, ground(at), at.y}, turn, 1});
  }
  float ground(vec2 p) const { return road_distance(p) < 0 ? town_.height(p) - kerb_m : town_.ground(p); }
  bool is_free(vec2 p, float radius) const {
    return std::none_of(taken_.begin(), taken_.end(),
                        [&](const Circle& other) { return glm::distance(other.middle, p) < other.radius + radius; });
  }
  bool in_town(vec2 p, float margin) const {
    return std::max(std::abs(p.x), std::abs(p.y)) < town_.site().half_m + margin;
  }
  bool plant(Model model, vec2 at, float radius, float scale) {
    const bool open = !in_town(at, 5) && shore_distance(at) > 7 && road_distance(at) > 1.5f + radius &&
                      town_.street_distance(at) > 3 && is_free(at, radius);
    if (open) put(model, at, random_.around(half_turn), scale);
    return open;
  }

  void place_mill();
  void place_shore();
  void place_farms();
  void place_road_lamps();
  void place_bales();
  void place_orchard();
  void place_avenues();
  void place_woods();
  void place_hedges();

  const Terrain& town_;
  CountryPlan plan_;
  std::vector<Circle> taken_;
  Random random_{1881};
};

void CountryPlanner::place_mill() {
  const vec2 at{212, -88};
  put(Model::windmill, at, -2.1f);
  taken_.push_back({at, 14});
  put_lamp(at + vec2(-5.5f, 5.0f), 2.6f);
}

void CountryPlanner::place_shore() {
  // The jetty begins where the bank is as high as its planks.
  vec2 foot{-80, 9};
  while (town_.height(foot) > 0.75f) foot.x -= 0.25f;
  foot.x += 1;
  plan_.standing.push_back({Model::jetty, {foot.x, 0.8f, foot.y}, -half_turn / 2, 1});
  for (float along : {2.0f, 13.0f, 24.5f})
    plan_.yard_lamps.push_back({Model::yard_lamp, {foot.x - along, 0.8f, foot.y - jetty_half_m - 0.4f}, half_turn, 1});
  constexpr std::array<vec3, 5> boats{
      vec3{-9, 2.4f, 1.65f}, {-16, -3.4f, -1.4f}, {-21, 2.6f, 1.5f}, {-37, -14, 0.6f}, {-60, 17, 2.3f}};
  for (vec3 boat : boats) plan_.standing.push_back({Model::boat, {foot.x + boat.x, 0, foot.y + boat.y}, boat.z, 1});
  taken_.push_back({foot, 9});
  for (int i = 0; i < 1000; ++i) {
    const vec2 at{random_.range(lake_low.x, lake_high.x), random_.range(lake_low.y, lake_high.y)};
    const float height = land_height(at);
    if (height > 0.15f || height < -0.55f || !is_free(at, 5) || std::abs(at.y - 9) < 14) continue;
    plan_.standing.push_back(
        {Model::reeds, {at.x, std::max(height, -0.4f), at.y}, random_.around(half_turn), random_.range(0.8f, 1.2f)});
  }
}

void CountryPlanner::place_farms() {
  struct Building {
    size_t style;
    vec2 at;
    float turn;
  };
  constexpr std::array<Building, 9> buildings{
      Building{8, {66, 128}, -1.2f}, {18, {82, 143}, -2.6f}, {14, {64, 150}, 0.3f},
      {9, {176, 12}, 2.9f},          {19, {160, 4}, 2.2f},   {8, {24, -186}, -0.4f},
      {14, {42, -192}, -0.9f},       {18, {-60, -96}, 1.4f}, {9, {-64, -112}, 1.7f}};
  for (const Building& building : buildings) {
    const HouseStyle& style = house_styles()[building.style];
    const vec2 front{std::sin(building.turn), std::cos(building.turn)}, side{front.y, -front.x};
    float floor = -1e9f;
    for (float u : {-1.0f, 1.0f})
      for (float v : {0.0f, 1.0f})
        floor = std::max(floor, land_height(building.at + side * u * style.width * 0.5f - front * v * style.depth));
    const auto model = static_cast<Model>(static_cast<size_t>(Model::first_house) + building.style);
    plan_.standing.push_back({model,
                              {building.at.x, std::min(floor, land_height(building.at) + 0.7f) + 0.1f, building.at.y},
                              building.turn,
                              1});
    taken_.push_back({building.at - front * (style.depth * 0.5f), 8.5f + style.wing_m * 0.5f});
    put_lamp(building.at + front * 3.2f + side * 2.6f, building.turn + half_turn);
    put(Model::firewood, building.at + front * 1.0f - side * (style.width * 0.5f + 1.6f), building.turn);
    for (int i = 0; i < 3; ++i)
      plant(i % 2 ? Model::lime : Model::oak, building.at - front * random_.range(12, 19) + side * random_.around(13),
            2, random_.range(0.9f, 1.25f));
  }
}

void CountryPlanner::place_road_lamps() {
  constexpr float spacing = 21, last[] = {330, 190, 100};
  for (size_t r = 0; r < country_roads().size(); ++r) {
    int count = 0;
    for (const Milestone& stone : milestones(country_roads()[r], 12, spacing, last[r])) {
      const vec2 side = stone.left * (count++ % 2 ? 1.0f : -1.0f), at = stone.at + side * (road_half_m + 0.5f);
      if (in_town(at, -1)) continue;
      plan_.road_lamps.push_back({Model::street_lamp, {at.x, land_height(at), at.y}, std::atan2(-side.x, -side.y), 1});
      taken_.push_back({at, 1.5f});
    }
  }
}

void CountryPlanner::place_bales() {
  for (const Field& field : fields()) {
    if (field.crop != Mat::stubble) continue;
    for (int i = 0; i < 26; ++i) {
      const vec2 at = field.middle + field.half * vec2(random_.around(0.85f), random_.around(0.8f));
      if (road_distance(at) < 2 || field_distance(at) > -2 || !is_free(at, 4.5f)) continue;
      taken_.push_back({at, 2});
      put(Model::hay_bale, at, random_.around(half_turn));
    }
  }
}

void CountryPlanner::place_orchard() {
  for (int row = 0; row < 5; ++row) {
    for (int tree = 0; tree < 9; ++tree) {
      const vec2 at = vec2(8, 82) + 6.8f * vec2(static_cast<float>(tree), static_cast<float>(row)) +
                      vec2(random_.around(0.5f), random_.around(0.5f));
      if (!random_.chance(0.9f)) continue;
      plant(random_.chance(0.8f) ? Model::beech : Model::birch, at, 1.5f, random_.range(0.42f, 0.54f));
    }
  }
}

void CountryPlanner::place_avenues() {
  for (size_t r : {size_t{1}, size_t{2}}) {
    for (const Milestone& stone : milestones(country_roads()[r], 4, 15, 260)) {
      for (float side : {-1.0f, 1.0f})
        plant(r == 1 ? Model::poplar : Model::beech, stone.at + stone.left * side * (road_half_m + 3.2f), 1.2f,
              random_.range(0.85f, 1.15f));
    }
  }
}

void CountryPlanner::place_woods() {
  constexpr float spacing = 7.2f, edge = 560;
  for (float z = -edge; z < edge; z += spacing) {
    for (float x = -edge; x < edge; x += spacing) {
      const vec2 at = vec2(x, z) + vec2(random_.around(3), random_.around(3));
      const float pick = random_.unit(), wood = wood_distance(at), out = glm::length(at);
      if (wood > -1.5f || out > edge) continue;
      // Sparser where only the edge and the crowns show.
      if (pick > (out > 330 ? 0.36f : wood < -14 ? 0.62f : 1.0f)) continue;
      const bool broad = random_.chance(wood > -9 ? 0.45f : 0.12f);
      const Model model = broad ? (random_.chance(0.3f) ? Model::birch : Model::beech)
                                : (random_.chance(0.4f) ? Model::tall_fir : Model::fir);
      plant(model, at, 1, random_.range(0.75f, 1.2f));
    }
  }
}

void CountryPlanner::place_hedges() {
  constexpr std::array trees{Model::oak,   Model::lime,  Model::maple, Model::birch,
                             Model::beech, Model::birch, Model::beech};
  for (int i = 0; i < 2100; ++i) {
    const vec2 at{random_.range(-130, 300), random_.range(-210, 270)};
    const float field = field_distance(at), pick = random_.unit();
    if (field < 1 || wood_distance(at) < 6) continue;
    if (field < 3.2f) {
      if (pick < 0.75f)
        plant(Model::bush, at, 0.8f, random_.range(0.9f, 1.7f));
      else if (plant(trees[random_.index(trees.size())], at, 3, random_.range(0.8f, 1.2f)))
        taken_.push_back({at, 4});
    } else if (pick < 0.055f && plant(trees[random_.index(trees.size())], at, 5, random_.range(0.9f, 1.35f))) {
      taken_.push_back({at, 6});
    }
  }
}

}  // namespace

CountryPlan plan_country(const Terrain& town) { return CountryPlanner(town).run(); }

}  // namespace app
