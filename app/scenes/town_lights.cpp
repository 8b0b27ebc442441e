// Lamps spread evenly: the streets' own first, the others by farthest-point sampling.
#include <algorithm>

#include "scenes/props.hpp"
#include "scenes/town_plan.hpp"

namespace app {

glm::vec3 lamp_light(const Standing& lamp) {
  const glm::vec3 local = lamp.model == Model::street_lamp ? street_lamp_light
                          : lamp.model == Model::wall_lamp ? wall_lamp_light
                                                           : yard_lamp_light;
  return glm::vec3(place(lamp.position, lamp.turn) * glm::vec4(local, 1));
}

std::vector<Standing> choose_lamps(const TownPlan& plan, size_t count) {
  std::vector<Standing> chosen = plan.lamps;
  chosen.resize(std::min(chosen.size(), count));
  std::vector<float> distance(plan.lamp_spots.size(), 1e9f);
  const auto take_into_account = [&](const Standing& lamp) {
    const glm::vec3 light = lamp_light(lamp);
    for (size_t i = 0; i < distance.size(); ++i)
      distance[i] = std::min(distance[i], glm::distance(light, lamp_light(plan.lamp_spots[i])));
  };
  for (const Standing& lamp : chosen) take_into_account(lamp);
  while (chosen.size() < count && !distance.empty()) {
    const size_t best = static_cast<size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
    chosen.push_back(plan.lamp_spots[best]);
    take_into_account(plan.lamp_spots[best]);
  }
  return chosen;
}

}  // namespace app
