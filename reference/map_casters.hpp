// Reference of caster culling per shadow map: into which views of a map a batch must be drawn, given what is known of the
// receivers that look at the map. Olsson et al. 2014, 4.1 and 5.2; every tile is tested on its own.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "reference/box.hpp"

namespace reference {

constexpr uint32_t projection_side = 32;  ///< Tiles along a projection map's side.

/// Coordinates of a world position p in a view: dot(row, (p, 1)). The view sees |x|, |y| ≤ depth > 0 if it is a perspective
/// one, else |x|, |y| ≤ 1. Depths grow away from the light.
struct CasterView {
  glm::dvec4 x, y, depth;
  bool perspective = true;
};

/// Receivers in one view: tiles that have some, bit x of word y, and the farthest depth in each cell of a grid, row by row.
struct CasterReceivers {
  std::array<uint32_t, projection_side> tiles{};
  uint32_t grid = 1;  ///< Divides projection_side.
  std::vector<float> farthest;
};

struct CasterMap {
  std::vector<CasterView> views;
  std::vector<CasterReceivers> receivers;  ///< As many.
  bool whole = false;                      ///< Nothing is known of the receivers: they may be anywhere.
  uint32_t resolution = 1;                 ///< Texels along a view's side.
  double near_m = 0;                       ///< Perspective.
};

/// Each asks for more than the one before.
enum class CasterTest : uint8_t { light_volume, view_mask, projection_map, projection_map_depth, receiver_grid };

/// Bit v: view v. The box has met the light's volume. tolerance: the box grows by so much of its farthest distance along each
/// axis of the view, and receivers lie so much farther away.
uint32_t views_to_draw(const CasterMap&, const Box&, CasterTest, double tolerance = 0);

/// How far casters may lie off in a map, in metres: so many texels where a box of them is nearest to the light.
double caster_error_m(const CasterMap&, const Box&, double texels);

/// The coarsest of some levels of detail that is off by no more than error_m. errors_m: of each level; 0, then rising.
uint32_t detail_level(const std::vector<double>& errors_m, double error_m);

}  // namespace reference
