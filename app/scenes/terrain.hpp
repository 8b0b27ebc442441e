// The land that a town stands on: its streets, and how high everything lies. x east, z south, y up, metres; the market
// square is at the origin.
#pragma once
#include <utility>
#include <vector>

#include "scenes/ground_mesh.hpp"

namespace app {

constexpr float pavement_m = 1.9f;  ///< Between a street's kerb and the yards.
constexpr float kerb_m = 0.11f;     ///< Height of pavements and yards over the streets.

struct Street {
  glm::vec2 from, to;  ///< x and z of the middle line's ends.
  float half_width;
};
constexpr float lane_half_m = 2.9f, main_street_half_m = 4.1f;

/// What a town's plan asks of the land.
struct TownSite {
  float half_m = 100;  ///< Houses stand within |x|, |z| ≤ half_m.
  std::vector<Street> streets;
  float (*height)(glm::vec2 p) = nullptr;  ///< Of pavements and yards.
  int outlying_trees = 0;                  ///< How often a tree is tried around the town.
};

class Terrain {
 public:
  explicit Terrain(TownSite site) : site_(std::move(site)) {}
  const TownSite& site() const { return site_; }
  float height(glm::vec2 p) const { return site_.height(p); }
  /// Signed distance to the nearest kerb: negative on streets and on the market square.
  float street_distance(glm::vec2 p) const;
  /// Height of what one stands on: streets lie kerb_m lower.
  float ground(glm::vec2 p) const { return height(p) - (street_distance(p) < 0 ? kerb_m : 0); }

 private:
  TownSite site_;
};

/// The market square, before the church.
constexpr glm::vec2 square_middle{0, 2}, square_half{19, 17};

}  // namespace app
