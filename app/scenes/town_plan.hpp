// Where everything stands: decided on footprints alone, without meshes.
#pragma once
#include <vector>

#include "scenes/house.hpp"
#include "scenes/standing.hpp"
#include "scenes/terrain.hpp"

namespace app {

struct TownPlan {
  std::vector<Standing> standing;
  std::vector<Standing> lamps;       ///< Of the streets and the square: all of them burn.
  std::vector<Standing> lamp_spots;  ///< On walls and in yards: as many burn as the town has lights left.
};

TownPlan plan_town(const Terrain& terrain);

/// Where the light of a lamp is.
glm::vec3 lamp_light(const Standing& lamp);

/// Every lamp of the plan, then the spots farthest from all lamps so far, until there are `count`.
std::vector<Standing> choose_lamps(const TownPlan& plan, size_t count);

/// An oriented rectangle on the ground.
struct Footprint {
  glm::vec2 middle{0}, half{0};
  float turn = 0;
};
bool overlap(const Footprint& a, const Footprint& b);
bool inside(const Footprint& footprint, glm::vec2 point, float margin);

}  // namespace app
