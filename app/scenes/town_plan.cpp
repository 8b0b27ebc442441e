// The plan: church and square first, then houses along every street, then lamps, yards and what stands in them. A thing
// is placed where its footprint is free of everything placed before.
#include "scenes/town_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/props.hpp"

namespace app {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float half_turn = 3.1415927f;

/// Local (x, z) of something turned around y, in the world's (x, z).
vec2 turned(vec2 local, float turn) {
  const float c = std::cos(turn), s = std::sin(turn);
  return {c * local.x + s * local.y, c * local.y - s * local.x};
}

/// A line that houses look over: the street is on the side of `facing`.
struct Frontage {
  vec2 from, to, facing;
  float setback;     ///< From the kerb line to the houses' fronts.
  float gap_chance;  ///< Of a gap after a house, of 6.5 m to this:
  float widest_gap;
};

class Planner {
 public:
  explicit Planner(const Terrain& terrain) : terrain_(terrain), half_m_(terrain.site().half_m) {}

  TownPlan run() {
    place_church();
    place_square();
    for (const Frontage& frontage : frontages()) place_houses(frontage);
    place_street_lamps();
    place_roadside();
    place_yard_walls();
    place_yards();
    place_country();
    drop_blocked_lamp_spots();
    return std::move(plan_);
  }

 private:
  void put(Model model, vec2 at, float turn, float scale = 1, float lift = 0) {
    plan_.standing.push_back({model, {at.x, terrain_.ground(at) + lift, at.y}, turn, scale});
  }
  bool is_free(const Footprint& f) const {
    return std::none_of(taken_.begin(), taken_.end(), [&](const Footprint& other) { return overlap(f, other); });
  }
  /// Lets a thing stand if its footprint (half sizes, local) is free and `clearance` away from streets.
  bool try_put(Model model, vec2 at, float turn, vec2 half, float clearance = 0.3f, float scale = 1) {
    const Footprint f{at, half * scale, turn};
    for (vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
      if (terrain_.street_distance(at + turned(corner * f.half, turn)) < clearance) return false;
    }
    if (!is_free(f)) return false;
    taken_.push_back(f);
    put(model, at, turn, scale);
    return true;
  }

  std::vector<Frontage> frontages();
  void place_church();
  void place_square();
  void place_houses(const Frontage& frontage);
  bool try_house(const Frontage& frontage, float along, size_t style);
  void furnish_house(const HouseStyle& style, vec2 front, float turn, float floor, float setback);
  void place_street_lamps();
  void place_roadside();
  void place_yard_walls();
  void place_yards();
  void place_country();
  void drop_blocked_lamp_spots();

  /// How many of something there are in this town at so many a hectare.
  int tries(float per_hectare) const { return static_cast<int>(std::lround(per_hectare * 4e-4f * half_m_ * half_m_)); }

  const Terrain& terrain_;
  float half_m_;
  TownPlan plan_;
  std::vector<Footprint> taken_;
  std::vector<Standing> houses_;
  Random random_{2014};
  size_t last_style_ = 0;
};

void Planner::place_church() {
  const vec2 at{0, square_middle.y - square_half.y - 9.3f};
  const float floor = std::max(terrain_.height(at), terrain_.height(at - vec2(0, 20))) + 0.3f;
  plan_.standing.push_back({Model::church, {at.x, floor, at.y}, 0, 1});
  taken_.push_back({at - vec2(0, 7.0f), {6.2f, 13.4f}, 0});
  for (float x : {-9.2f, 9.2f}) {
    for (int i = 0; i < 7; ++i) {
      const vec2 grave = at + vec2(x + random_.around(1.3f), -2.2f - 2.5f * static_cast<float>(i));
      try_put(Model::gravestone, grave, (x < 0 ? 0.5f : -0.5f) * half_turn + random_.around(0.1f), {0.45f, 0.6f});
    }
    for (float z : {1.0f, -10.5f, -18.5f}) try_put(Model::lime, at + vec2(x * 1.28f, z), x, {0.9f, 0.9f});
    for (int i = 0; i < 9; ++i) {
      const vec2 wall = at + vec2(x * 1.48f, 3.0f - fence_m * static_cast<float>(i));
      try_put(Model::stone_wall, wall, half_turn / 2, {fence_m / 2, 0.2f});
    }
    plan_.lamps.push_back({Model::wall_lamp, {at.x + (x < 0 ? -3.3f : 3.3f), floor + 2.6f, at.y + 0.12f}, 0, 1});
    plan_.lamps.push_back({Model::yard_lamp, vec3(at.x + x, terrain_.ground(at + vec2(x, -8)), at.y - 8), x, 1});
    taken_.push_back({at + vec2(x, -8), {0.6f, 0.8f}, 0});
    taken_.push_back({at + vec2(x * 0.72f, -9), {6, 13}, 0});
  }
}

void Planner::place_square() {
  const vec2 m = square_middle;
  const auto stand = [&](Model model, vec2 offset, float turn, vec2 half) {
    put(model, m + offset, turn);
    taken_.push_back({m + offset, half, turn});
  };
  stand(Model::fountain, {0, -0.5f}, 0, {4.2f, 4.2f});
  struct Stall {
    vec2 at;
    float turn;
  };
  constexpr Stall stalls[] = {{{-11.5f, -9.5f}, 0.35f}, {{-6.4f, -10.8f}, 0.1f}, {{-13.5f, 7.2f}, 1.45f},
                              {{-9.0f, 10.8f}, 2.9f},   {{8.6f, 10.4f}, 3.4f},   {{13.8f, 7.6f}, -1.4f},
                              {{7.0f, -10.6f}, -0.15f}, {{12.2f, -9.2f}, -0.4f}};
  for (size_t i = 0; i < std::size(stalls); ++i) {
    stand(i % 2 ? Model::stall_blue : Model::stall_red, stalls[i].at, stalls[i].turn, {1.9f, 1.6f});
    stand(i % 3 ? Model::crates : Model::barrels, stalls[i].at + turned({2.9f, 0.2f}, stalls[i].turn),
          1.3f * static_cast<float>(i), {0.8f, 0.9f});
  }
  for (vec2 at : {vec2(-16.6f, -14.6f), {16.6f, -14.6f}, {-16.6f, 14.4f}, {16.6f, 14.4f}})
    stand(Model::oak, at, at.x * 0.3f + at.y, {0.8f, 0.8f});
  for (int i = 0; i < 4; ++i) {
    const float turn = half_turn * (0.5f * static_cast<float>(i) + 0.25f);
    stand(Model::bench, vec2(0, -0.5f) + turned({0, 6.2f}, turn), turn, {1, 0.45f});
  }
  stand(Model::cart, {-15.2f, -3.4f}, 2.2f, {1.0f, 2.2f});
  const auto lamp = [&](vec2 offset, float turn) {
    plan_.lamps.push_back({Model::street_lamp, {m.x + offset.x, terrain_.ground(m + offset), m.y + offset.y}, turn, 1});
    taken_.push_back({m + offset, {0.5f, 0.5f}, turn});
  };
  for (float x : {-1.0f, 1.0f}) {
    for (float z : {-1.0f, 1.0f}) {
      lamp({x * 5.6f, z * 5.6f - 0.5f}, std::atan2(-x, -z));
      lamp({x * 9.6f, z * 13.4f}, std::atan2(-x, -z));
    }
    lamp({x * 16.8f, -4.6f}, std::atan2(-x, 0.4f));
    lamp({x * 16.8f, 5.0f}, std::atan2(-x, -0.4f));
  }
}

std::vector<Frontage> Planner::frontages() {
  std::vector<Frontage> result;
  const vec2 m = square_middle, h = square_half;
  result.push_back({m + vec2(-h.x, h.y), m - h, {1, 0}, 2.1f, 0.1f, 13});
  result.push_back({m + vec2(h.x, -h.y), m + h, {-1, 0}, 2.1f, 0.1f, 13});
  result.push_back({m + h, m + vec2(-h.x, h.y), {0, -1}, 2.1f, 0.1f, 13});
  result.push_back({m - h, m + vec2(h.x, -h.y), {0, 1}, 2.1f, 0.1f, 13});
  // Main streets first: they get the long unbroken rows.
  std::vector<Street> streets = terrain_.site().streets;
  std::stable_sort(streets.begin(), streets.end(),
                   [](const Street& a, const Street& b) { return a.half_width > b.half_width; });
  for (const Street& street : streets) {
    const vec2 along = glm::normalize(street.to - street.from), left{along.y, -along.x};
    for (float side : {1.0f, -1.0f}) {
      const vec2 facing = left * -side, kerb = left * side * street.half_width;
      const bool lane = street.half_width < 3.5f, garden = lane && random_.chance(0.5f);
      result.push_back({street.from + kerb, street.to + kerb, facing, garden ? 5.2f : 2.1f, lane ? 0.95f : 0.2f,
                        lane ? 19.0f : 13.0f});
    }
  }
  return result;
}

bool Planner::try_house(const Frontage& frontage, float along, size_t style_index) {
  const HouseStyle& style = house_styles()[style_index];
  const vec2 direction = glm::normalize(frontage.to - frontage.from);
  const vec2 front = frontage.from + direction * along - frontage.facing * frontage.setback;
  const float turn = std::atan2(frontage.facing.x, frontage.facing.y), depth = style.depth + style.wing_m;
  const Footprint f{front - frontage.facing * (depth / 2), {style.width / 2 + 0.02f, depth / 2}, turn};
  if (std::max(std::abs(f.middle.x), std::abs(f.middle.y)) > half_m_ - 2) return false;
  float floor = -1e9f;
  for (float u : {-1.0f, 0.0f, 1.0f}) {
    for (float v : {-1.0f, 0.0f, 1.0f}) {
      const vec2 p = f.middle + turned(vec2(u, v) * (f.half + 0.15f), turn);
      if (terrain_.street_distance(p) < pavement_m - 0.1f) return false;
      floor = std::max(floor, terrain_.height(p));
    }
  }
  const Footprint spaced{f.middle, f.half + vec2(0.28f, 0.1f), turn};
  if (!is_free(spaced)) return false;
  taken_.push_back(f);
  floor = std::min(floor + 0.12f, terrain_.height(front) + 0.5f);
  const auto model = static_cast<Model>(static_cast<uint32_t>(Model::first_house) + style_index);
  houses_.push_back({model, {front.x, floor, front.y}, turn, 1});
  plan_.standing.push_back(houses_.back());
  furnish_house(style, front, turn, floor, frontage.setback);
  return true;
}

void Planner::place_houses(const Frontage& frontage) {
  const float length = glm::distance(frontage.from, frontage.to);
  const size_t count = house_styles().size();
  for (float at = 0; at < length;) {
    // Not the same house twice in a row; the smaller ones get their chance where the larger do not fit.
    size_t style = random_.index(static_cast<uint32_t>(count));
    if (style / 2 == last_style_ / 2) style = (style + 3) % count;
    bool done = false;
    for (size_t tries = 0; tries < 3 && !done; ++tries, style = (style + 7) % count) {
      const float width = house_styles()[style].width;
      if (!try_house(frontage, at + width / 2, style)) continue;
      done = true;
      last_style_ = style;
      at += width + (random_.chance(frontage.gap_chance) ? random_.range(6.5f, frontage.widest_gap) : 0.3f);
    }
    if (!done) at += 1.1f;
  }
}

void Planner::furnish_house(const HouseStyle& style, vec2 front, float turn, float floor, float setback) {
  const float half = style.width / 2;
  const auto world = [&](vec2 local) { return front + turned(local, turn); };
  const bool low_lamp = style.jetty_m > 0 || style.shop;
  const auto wall_lamp = [&](vec2 local, float height, float facing) {
    const vec2 at = world(local);
    plan_.lamp_spots.push_back({Model::wall_lamp, {at.x, floor + height, at.y}, turn + facing, 1});
  };
  wall_lamp({half - 0.18f, 0}, low_lamp ? 1.95f : 2.35f, 0);
  if (!style.shop) wall_lamp({0.18f - half, 0}, low_lamp ? 1.95f : 2.35f, 0);
  wall_lamp({0.18f - half, -style.depth}, 2.2f, half_turn);
  if (style.wing_m == 0) wall_lamp({half - 0.18f, -style.depth}, 2.2f, half_turn);
  if (setback > 3) {
    // A front garden: fence along the pavement with a gap before the door, beds under the windows.
    const float line = setback - pavement_m - 0.25f;
    const int pieces = static_cast<int>(style.width / fence_m + 0.3f);
    for (int i = 0; i < pieces; ++i) {
      const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(pieces - 1)) * fence_m;
      if (std::abs(x) < 1.15f) continue;
      try_put(Model::picket_fence, world({x, line}), turn, {fence_m / 2 - 0.02f, 0.05f}, 1.2f);
    }
    for (float x : {-half + 1.6f, half - 1.6f}) {
      const float pick = random_.unit();
      if (pick < 0.5f)
        try_put(Model::flower_bed, world({x, 0.95f}), turn, {1.45f, 0.65f});
      else if (pick < 0.85f)
        try_put(Model::bush, world({x, 1.6f}), x, {0.8f, 0.8f});
    }
    return;
  }
  const float x = (random_.chance(0.5f) ? -1.0f : 1.0f) * (half - 1.05f);
  const float pick = random_.unit();
  if (style.shop) {
    try_put(pick < 0.5f ? Model::crates : Model::barrels, world({-half + 1.4f, 0.62f}), turn, {0.85f, 0.6f}, 0.1f);
  } else if (pick < 0.3f) {
    try_put(Model::bench, world({x, 0.5f}), turn, {1, 0.4f}, 0.1f);
  } else if (pick < 0.5f) {
    try_put(Model::barrels, world({x, 0.62f}), turn, {0.85f, 0.6f}, 0.1f);
  } else if (pick < 0.62f) {
    try_put(Model::bush, world({x, 0.75f}), x, {0.6f, 0.6f}, 0.1f, 0.75f);
  }
}

void Planner::place_street_lamps() {
  constexpr float spacing = 13.0f, apart = 7.5f;
  for (const Street& street : terrain_.site().streets) {
    const float length = glm::distance(street.from, street.to);
    const vec2 along = (street.to - street.from) / length, left{along.y, -along.x};
    const int count = std::max(1, static_cast<int>(std::lround(length / spacing)));
    for (int i = 0; i < count; ++i) {
      const float side = i % 2 ? 1.0f : -1.0f;
      const vec2 at = street.from + along * (length * (static_cast<float>(i) + 0.5f) / static_cast<float>(count)) +
                      left * side * (street.half_width + 0.35f);
      if (std::max(std::abs(at.x), std::abs(at.y)) > half_m_ || terrain_.street_distance(at) < 0.3f) continue;
      const vec3 foot{at.x, terrain_.ground(at), at.y};
      const bool crowded = std::any_of(plan_.lamps.begin(), plan_.lamps.end(), [&](const Standing& other) {
        return glm::distance(other.position, foot) < apart;
      });
      const Footprint f{at, {0.3f, 0.3f}, 0};
      if (crowded || !is_free(f)) continue;
      taken_.push_back(f);
      const vec2 facing = left * -side;
      plan_.lamps.push_back({Model::street_lamp, foot, std::atan2(facing.x, facing.y), 1});
    }
  }
}

void Planner::place_roadside() {
  struct Thing {
    Model model;
    vec2 half;
  };
  constexpr Thing things[] = {{Model::planter, {0.6f, 0.6f}}, {Model::crates, {0.9f, 0.9f}},
                              {Model::planter, {0.6f, 0.6f}}, {Model::cart, {1.0f, 2.3f}},
                              {Model::planter, {0.6f, 0.6f}}, {Model::barrels, {0.9f, 0.9f}}};
  for (const Street& street : terrain_.site().streets) {
    if (street.half_width < 3.5f) continue;
    const float length = glm::distance(street.from, street.to);
    const vec2 along = (street.to - street.from) / length, left{along.y, -along.x};
    for (float at = 4; at < length; at += random_.range(2.5f, 5)) {
      const float side = random_.chance(0.5f) ? 1.0f : -1.0f;
      const vec2 p = street.from + along * at + left * side * (street.half_width - 0.95f);
      const Thing& thing = things[random_.index(std::size(things))];
      if (std::max(std::abs(p.x), std::abs(p.y)) > half_m_ || terrain_.street_distance(p) < -1.2f) continue;
      try_put(thing.model, p, std::atan2(along.x, along.y) + random_.around(0.15f), thing.half + 0.3f, -2.6f);
    }
  }
}

void Planner::place_yard_walls() {
  // Between neighbours' yards, from the houses' back corners inwards.
  for (const Standing& house : houses_) {
    const HouseStyle& style =
        house_styles()[static_cast<uint32_t>(house.model) - static_cast<uint32_t>(Model::first_house)];
    const Model model = random_.chance(0.5f) ? Model::stone_wall : Model::picket_fence;
    for (int i = 0; i < 3; ++i) {
      const vec2 local{-style.width / 2, -style.depth - 0.3f - fence_m * (static_cast<float>(i) + 0.5f)};
      const vec2 at = vec2(house.position.x, house.position.z) + turned(local, house.turn);
      if (!try_put(model, at, house.turn + half_turn / 2, {fence_m / 2 - 0.05f, 0.15f}, 2.2f)) break;
    }
  }
}

void Planner::place_yards() {
  constexpr std::array trees{Model::oak, Model::lime, Model::maple, Model::lime, Model::poplar, Model::spruce};
  struct Furniture {
    Model model;
    vec2 half;
  };
  constexpr Furniture furniture[] = {
      {Model::laundry, {3.1f, 0.6f}},    {Model::firewood, {1.3f, 0.5f}}, {Model::well, {1.2f, 1.2f}},
      {Model::flower_bed, {1.5f, 0.7f}}, {Model::cart, {1.0f, 2.0f}},     {Model::bench, {1, 0.5f}},
      {Model::barrels, {0.9f, 0.9f}},    {Model::bush, {0.8f, 0.8f}},     {Model::laundry, {3.1f, 0.6f}}};
  for (int i = 0; i < tries(105); ++i) {
    const vec2 at{random_.around(half_m_ - 2), random_.around(half_m_ - 2)};
    if (terrain_.street_distance(at) < 5) continue;
    try_put(trees[random_.index(trees.size())], at, random_.around(half_turn), {1.75f, 1.75f}, 2.5f,
            random_.range(0.8f, 1.1f));
  }
  for (int i = 0; i < tries(225); ++i) {
    const vec2 at{random_.around(half_m_ - 2), random_.around(half_m_ - 2)};
    const Furniture& pick = furniture[static_cast<size_t>(i) % std::size(furniture)];
    try_put(pick.model, at, random_.around(half_turn), pick.half + 0.2f, 3);
  }
  for (int i = 0; i < tries(150); ++i) {
    const vec2 at{random_.around(half_m_ - 3), random_.around(half_m_ - 3)};
    const Footprint f{at, {0.7f, 0.8f}, random_.around(half_turn)};
    if (terrain_.street_distance(at) < 3 || !is_free(f)) continue;
    plan_.lamp_spots.push_back({Model::yard_lamp, {at.x, terrain_.ground(at), at.y}, f.turn, 1});
    taken_.push_back(f);
  }
}

void Planner::place_country() {
  for (int i = 0; i < terrain_.site().outlying_trees; ++i) {
    const float angle = random_.around(half_turn), out = half_m_ + random_.range(12, 50);
    const vec2 at{out * std::sin(angle), out * std::cos(angle)};
    const Model model = random_.chance(0.6f) ? Model::spruce : random_.chance(0.4f) ? Model::poplar : Model::lime;
    if (random_.chance(0.55f)) try_put(model, at, angle * 7, {1.5f, 1.5f}, 1.5f, random_.range(0.8f, 1.25f));
  }
}

void Planner::drop_blocked_lamp_spots() {
  std::erase_if(plan_.lamp_spots, [&](const Standing& lamp) {
    const vec3 light = lamp_light(lamp);
    const vec2 at{light.x, light.z};
    if (std::max(std::abs(at.x), std::abs(at.y)) > half_m_) return true;
    // Yard lamps have taken their own footprint; a wall lamp's light hangs this far from its own house.
    return lamp.model == Model::wall_lamp &&
           std::any_of(taken_.begin(), taken_.end(), [&](const Footprint& f) { return inside(f, at, 0.45f); });
  });
}

}  // namespace

TownPlan plan_town(const Terrain& terrain) { return Planner(terrain).run(); }

bool overlap(const Footprint& a, const Footprint& b) {
  for (float turn : {a.turn, b.turn}) {
    for (vec2 axis : {turned({1, 0}, turn), turned({0, 1}, turn)}) {
      float reach = 0;
      for (const Footprint* f : {&a, &b}) {
        reach += f->half.x * std::abs(glm::dot(axis, turned({1, 0}, f->turn))) +
                 f->half.y * std::abs(glm::dot(axis, turned({0, 1}, f->turn)));
      }
      if (std::abs(glm::dot(axis, b.middle - a.middle)) >= reach) return false;
    }
  }
  return true;
}

bool inside(const Footprint& f, vec2 point, float margin) {
  const vec2 local = turned(point - f.middle, -f.turn);
  return std::abs(local.x) < f.half.x + margin && std::abs(local.y) < f.half.y + margin;
}

}  // namespace app
