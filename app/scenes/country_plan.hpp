// Where everything beyond the town stands: woods, hedges, farms, road lamps, the mill, the shore.
#pragma once
#include <vector>

#include "scenes/standing.hpp"
#include "scenes/terrain.hpp"

namespace app {

struct CountryPlan {
  std::vector<Standing> standing;
  std::vector<Standing> road_lamps;  ///< Shaded: they shine downwards.
  std::vector<Standing> yard_lamps;  ///< Of farms, the mill and the jetty.
};

CountryPlan plan_country(const Terrain& town);

}  // namespace app
