// The lie of the landscape: a valley with a lake, hills, roads, fields and woods around the town at the origin.
#pragma once
#include <span>
#include <vector>

#include "scenes/terrain.hpp"

namespace app {

constexpr float land_half_m = 620;  ///< Of the square of land.
constexpr float land_town_half_m = 70;
constexpr float road_half_m = 2.4f;
constexpr glm::vec2 lake_low{-320, -250}, lake_high{-62, 100};  ///< Of the water's surface, at height 0.

TownSite land_site();
/// Height of the land, under water below 0.
float land_height(glm::vec2 p);
/// Distances along the ground, negative inside. Shore and woods are only nearly in metres.
float shore_distance(glm::vec2 p);
float wood_distance(glm::vec2 p);
float field_distance(glm::vec2 p);

/// A field; its borders follow the land.
struct Field {
  glm::vec2 middle, half;
  Mat crop;
};
std::span<const Field> fields();

/// A road out of the town, as a smooth line of points.
using Road = std::vector<glm::vec2>;
const std::vector<Road>& country_roads();
float road_distance(glm::vec2 p);  ///< To the nearest edge.

void add_land(MeshBuilder& builder, const Terrain& town, Detail detail);
void add_lake(MeshBuilder& builder, Detail detail);

}  // namespace app
