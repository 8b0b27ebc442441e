// Distance to streets.
#include "scenes/terrain.hpp"

#include <algorithm>

namespace app {

float Terrain::street_distance(glm::vec2 p) const {
  float nearest = box_distance(p, square_middle, square_half - 2.0f) - 2.0f;
  for (const Street& street : site_.streets)
    nearest = std::min(nearest, segment_distance(p, street.from, street.to) - street.half_width);
  return nearest;
}

}  // namespace app
