// The lie of the land and the plan of the streets. x east, z south, y up, metres; the town is the square
// |x|, |z| ≤ town_half_m.
#pragma once
#include <vector>

#include "scenes/mesh_builder.hpp"

namespace app {

constexpr float town_half_m = 100;
constexpr float world_half_m = 168;  ///< Fields and hills beyond the town.
constexpr float pavement_m = 1.9f;   ///< Between a street's kerb and the yards.
constexpr float kerb_m = 0.11f;      ///< Height of pavements and yards over the streets.

struct Street {
  glm::vec2 from, to;  ///< x and z of the middle line's ends.
  float half_width;
};

class Terrain {
 public:
  Terrain();
  const std::vector<Street>& streets() const { return streets_; }
  /// Height of pavements and yards; streets lie kerb_m below it.
  static float height(glm::vec2 p);
  /// Signed distance to the nearest kerb: negative on streets and on the market square.
  float street_distance(glm::vec2 p) const;
  /// Height of what one stands on.
  float ground(glm::vec2 p) const;
  void build(MeshBuilder& builder, Detail detail) const;

 private:
  std::vector<Street> streets_;
};

/// The market square, before the church.
constexpr glm::vec2 square_middle{0, 2}, square_half{19, 17};

/// A dome of dusk around everything; it shines a little and is beyond the reach of every lamp.
void add_sky(MeshBuilder& builder, Detail detail);

}  // namespace app
