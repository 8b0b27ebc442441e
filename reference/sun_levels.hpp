// Reference of the levels of a directional light, in double precision: the plane of its texels, which level a cluster asks for, and
// which texels of it a window must hold. Texels are counted from the world's origin and never move.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/box.hpp"

namespace reference {

constexpr uint32_t sun_places = 25;       ///< Levels, finest first.
constexpr uint32_t sun_window_step = 64;  ///< Texels of which windows begin at a multiple.

/// A plane across the light's direction. Axes are unit: right is horizontal, down completes them.
struct SunPlane {
  glm::dvec3 right{1, 0, 0}, down{0, 1, 0}, forward{0, 0, 1};
  double reach_m = 1;  ///< A power of two: no coordinate of a caster is larger.
  /// Width of a level's texels.
  double texel_m(uint32_t place) const;
  /// What a plane that is as wide as 32 reaches asks for where pixels have this size.
  double request(double pixel_m) const { return 32 * reach_m / pixel_m; }
};
SunPlane sun_plane(glm::dvec3 direction, const Box& casters);

/// A rectangle on the plane, in metres.
struct PlaneRect {
  glm::dvec2 low{0}, high{-1};
  bool empty() const { return low.x > high.x || low.y > high.y; }
};
PlaneRect rect_on_plane(const SunPlane&, const Box&);
PlaneRect intersection(const PlaneRect&, const PlaneRect&);
PlaneRect union_of(const PlaneRect&, const PlaneRect&);

/// The coarsest level whose texels are no larger than what is asked for.
uint32_t sun_place_of_request(double request);

/// Of so many levels in use, those that keep a map: all, every second, … , counted from the coarsest.
std::vector<uint32_t> kept_sun_places(std::span<const uint32_t> finest_first, uint32_t most);

/// Texels of a level, counted from the world's origin.
struct PlaneWindow {
  glm::dvec2 first{0};
  double side = 0;
};
/// Whether the taps of all receivers in the rectangle lie in the window; `slack` texels more are asked for, or with a negative one
/// less.
bool holds(const PlaneWindow&, const SunPlane&, uint32_t place, const PlaneRect&, double slack);

}  // namespace reference
