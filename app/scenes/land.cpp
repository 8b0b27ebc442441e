// Distance fields of the land, and the ground that they cut.
#include "scenes/land.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/random.hpp"

namespace app {
namespace {

using glm::vec2;
using glm::vec3;

float lattice(int x, int z) {
  return unit_float(mix_bits(static_cast<uint32_t>(x) * 7919u + static_cast<uint32_t>(z), 173u));
}

/// Value noise with cells of one unit, -1 … 1.
float noise(vec2 p) {
  const vec2 cell = glm::floor(p), f = p - cell, t = f * f * (3.0f - 2.0f * f);
  const int x = static_cast<int>(cell.x), z = static_cast<int>(cell.y);
  return 2 * std::lerp(std::lerp(lattice(x, z), lattice(x + 1, z), t.x),
                       std::lerp(lattice(x, z + 1), lattice(x + 1, z + 1), t.x), t.y) -
         1;
}

float bump(vec2 p, vec2 middle, vec2 radius) {
  const vec2 q = (p - middle) / radius;
  return std::exp(-glm::dot(q, q));
}

/// An upright ellipse; the distance is right along its shorter axis.
struct Oval {
  vec2 middle, radius;
  float distance(vec2 p) const { return (glm::length((p - middle) / radius) - 1) * std::min(radius.x, radius.y); }
};

constexpr Oval woods[] = {{{-60, -340}, {290, 120}},  {{235, -245}, {110, 70}}, {{-350, 190}, {130, 110}},
                          {{300, 120}, {70, 75}},     {{-165, 205}, {75, 42}},  {{360, -60}, {75, 110}},
                          {{-420, -150}, {120, 240}}, {{-40, 330}, {260, 60}},  {{-70, -175}, {46, 40}}};

constexpr Field all_fields[] = {
    {{-50, 95}, {32, 22}, Mat::stubble},  {{-62, 170}, {34, 20}, Mat::wheat},  {{130, 88}, {34, 30}, Mat::plough},
    {{140, -70}, {36, 32}, Mat::stubble}, {{118, 16}, {26, 16}, Mat::wheat},   {{205, 40}, {34, 36}, Mat::wheat},
    {{95, -135}, {44, 28}, Mat::wheat},   {{30, -128}, {14, 30}, Mat::plough}, {{205, -150}, {44, 30}, Mat::plough},
    {{220, 190}, {46, 40}, Mat::stubble}, {{30, 148}, {34, 16}, Mat::plough},  {{280, -10}, {32, 34}, Mat::plough}};

float crop_distance(vec2 p, Mat crop) {
  const vec2 bent = p + vec2(5 * std::sin(0.023f * p.y + 0.7f), 5 * std::sin(0.021f * p.x - 0.4f));
  float nearest = 1e9f;
  for (const Field& field : all_fields)
    if (field.crop == crop) nearest = std::min(nearest, box_distance(bent, field.middle, field.half - 3.0f) - 3);
  return nearest;
}

/// Rounds a line's corners (Chaikin).
Road rounded(const Road& line) {
  Road result{line.front()};
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    result.push_back(glm::mix(line[i], line[i + 1], 0.25f));
    result.push_back(glm::mix(line[i], line[i + 1], 0.75f));
  }
  result.push_back(line.back());
  return result;
}

}  // namespace

float shore_distance(vec2 p) {
  const Oval lake{{-190, -75}, {108, 150}};
  const float bays = 11 * std::sin(0.033f * p.x + 0.021f * p.y + 0.5f) + 7 * std::sin(0.058f * p.y - 0.024f * p.x);
  return lake.distance(p) + bays * smooth_ramp(0, 60, glm::distance(p, vec2(-88, 8)));
}

float land_height(vec2 p) {
  const float out = glm::length(p), wild = smooth_ramp(75, 190, out);
  float land = 2.4f + 0.034f * std::clamp(p.x + 70, 0.0f, 190.0f) - 0.012f * std::clamp(p.y, -70.0f, 90.0f);
  land += 0.3f * std::sin(0.043f * p.x + 0.6f) * std::cos(0.037f * p.y);
  land += 40 * bump(p, {95, 262}, {120, 92});                                                 // South.
  land += 27 * bump(p, {222, -92}, {82, 62});                                                 // Under the mill.
  land += 46 * smooth_ramp(125, 330, -p.y + 0.12f * p.x) * (0.8f + 0.2f * noise(p / 90.0f));  // North.
  land += 34 * smooth_ramp(290, 430, -p.x) * (0.8f + 0.2f * noise(p / 70.0f));                // Beyond the lake.
  land += smooth_ramp(350, 640, out) * (36 + 17 * noise(p / 170.0f) + 7 * noise(p / 63.0f));
  land += wild * (3.2f * noise(p / 61.0f) + 1.2f * noise(p / 23.0f));
  const float shore = shore_distance(p), beach = 0.085f * shore;
  return shore < 0 ? std::max(beach, -5.0f) : std::lerp(beach, std::max(land, 1.6f), smooth_ramp(0, 46, shore));
}

float wood_distance(vec2 p) {
  float nearest = 1e9f;
  for (const Oval& wood : woods) nearest = std::min(nearest, wood.distance(p));
  return nearest + 9 * noise(p / 27.0f) + 4 * noise(p / 11.0f);
}

float field_distance(vec2 p) {
  float nearest = 1e9f;
  for (Mat crop : {Mat::wheat, Mat::stubble, Mat::plough}) nearest = std::min(nearest, crop_distance(p, crop));
  return nearest;
}

std::span<const Field> fields() { return all_fields; }

const std::vector<Road>& country_roads() {
  static const std::vector<Road> roads = [] {
    const Road south{{-3, 66},  {-8, 92},  {-22, 112}, {-14, 172}, {40, 178}, {84, 176},
                     {96, 212}, {70, 248}, {20, 262},  {-20, 330}, {-10, 420}};
    const Road east{{68, -4}, {96, -8}, {128, -28}, {170, -18}, {196, -2}, {246, 0}, {300, 62}, {380, 60}, {480, 110}};
    const Road north{{-41, -48}, {-46, -84},  {-20, -118}, {4, -150},  {52, -170},
                     {70, -215}, {150, -240}, {170, -330}, {150, -460}};
    std::vector<Road> result;
    for (const Road& line : {south, east, north}) result.push_back(rounded(rounded(line)));
    return result;
  }();
  return roads;
}

float road_distance(vec2 p) {
  float nearest = 1e9f;
  for (const Road& road : country_roads())
    for (size_t i = 0; i + 1 < road.size(); ++i) nearest = std::min(nearest, segment_distance(p, road[i], road[i + 1]));
  return nearest - road_half_m;
}

TownSite land_site() {
  TownSite site{.half_m = land_town_half_m, .streets = {}, .height = land_height};
  const auto add = [&](vec2 a, vec2 b, float half_width) { site.streets.push_back({a, b, half_width}); };
  constexpr vec2 north_west{-42, -49}, north{1, -50}, north_east{43, -47}, west{-41, 4},
      middle = square_middle, east{45, 0}, south_west{-44, 42}, south{3, 44}, south_east{43, 46}, quay{-80, 9};
  add(middle, west, main_street_half_m);
  add(west, quay, main_street_half_m);
  add(middle, east, main_street_half_m);
  add(east, {70, -4}, main_street_half_m);
  add(middle, south, main_street_half_m);
  add(south, {-3, 68}, main_street_half_m);
  for (const auto& [a, b] : {std::pair{north_west, north},
                             {north, north_east},
                             {north_west, west},
                             {west, south_west},
                             {north_east, east},
                             {east, south_east},
                             {south_west, south},
                             {south, south_east}})
    add(a, b, lane_half_m);
  return site;
}

void add_land(MeshBuilder& builder, const Terrain& town, Detail detail) {
  constexpr std::array kinds{GroundKind{.mat = Mat::cobble, .below_m = kerb_m},
                             GroundKind{.mat = Mat::gravel, .below_m = kerb_m, .edge = Mat::earth},
                             GroundKind{.mat = Mat::flagstone},
                             GroundKind{.mat = Mat::sand},
                             GroundKind{.mat = Mat::wheat},
                             GroundKind{.mat = Mat::stubble},
                             GroundKind{.mat = Mat::plough},
                             GroundKind{.mat = Mat::forest_floor}};
  const GroundDesc desc{.kinds = kinds, .rest = {.mat = Mat::grass}, .height = land_height, .fields = [&](vec2 p) {
                          const float street = town.street_distance(p);
                          return GroundFields{street,
                                              road_distance(p),
                                              street - pavement_m,
                                              4 * (land_height(p) - 0.35f),
                                              crop_distance(p, Mat::wheat),
                                              crop_distance(p, Mat::stubble),
                                              crop_distance(p, Mat::plough),
                                              wood_distance(p)};
                        }};
  const bool low = detail == Detail::low;
  add_ground(builder, desc,
             grid_lines({.half = land_half_m,
                         .fine_half = low ? 200.0f : 250.0f,
                         .step = low ? 5.0f : 3.0f,
                         .coarse = low ? 9.0f : 5.0f,
                         .growth = 1.07f}));
}

void add_lake(MeshBuilder& builder, Detail detail) {
  const int steps = detail == Detail::low ? 6 : 20;
  const vec2 step = (lake_high - lake_low) / static_cast<float>(steps);
  for (int z = 0; z < steps; ++z) {
    for (int x = 0; x < steps; ++x) {
      const vec2 a = lake_low + step * vec2(x, z), b = a + step;
      builder.quad(Mat::lake, {a.x, 0, b.y}, {b.x, 0, b.y}, {b.x, 0, a.y}, {a.x, 0, a.y});
    }
  }
}

}  // namespace app
