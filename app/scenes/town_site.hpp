// The site of HOUSES: five by five crossings on a gentle slope within a ring of hills.
#pragma once
#include "scenes/terrain.hpp"

namespace app {

constexpr float town_world_half_m = 168;  ///< Fields and hills beyond the town.
TownSite houses_site();
void add_town_ground(MeshBuilder& builder, const Terrain& terrain, Detail detail);

}  // namespace app
