#include "reference/sun_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference {
namespace {

constexpr int kFinestLevel = 26;          // 2^26 texels along the plane
constexpr double kTapReachTexels = 1.05;  // taps lie one texel around the receiver's

}  // namespace

double SunPlane::texel_m(uint32_t place) const { return 32 * reach_m / std::exp2(kFinestLevel - int(place)); }

SunPlane sun_plane(glm::dvec3 direction, const Box& casters) {
  SunPlane plane;
  plane.forward = glm::normalize(direction);
  const glm::dvec3 horizontal(plane.forward.z, 0, -plane.forward.x);
  plane.right =
      std::abs(plane.forward.x) + std::abs(plane.forward.z) > 1e-5 ? glm::normalize(horizontal) : glm::dvec3(1, 0, 0);
  plane.down = glm::normalize(glm::cross(plane.right, plane.forward));
  plane.right = glm::cross(plane.forward, plane.down);
  const glm::dvec3 largest = glm::max(glm::abs(glm::dvec3(casters.min)), glm::abs(glm::dvec3(casters.max)));
  plane.reach_m = std::exp2(std::ceil(std::log2(std::max({largest.x, largest.y, largest.z, 1e-6}))));
  return plane;
}

PlaneRect rect_on_plane(const SunPlane& plane, const Box& box) {
  PlaneRect rect{glm::dvec2(std::numeric_limits<double>::infinity()),
                 glm::dvec2(-std::numeric_limits<double>::infinity())};
  for (uint32_t i = 0; i < 8; ++i) {
    const glm::dvec3 corner(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                            i & 4 ? box.max.z : box.min.z);
    const glm::dvec2 at(glm::dot(plane.right, corner), glm::dot(plane.down, corner));
    rect = {glm::min(rect.low, at), glm::max(rect.high, at)};
  }
  return rect;
}

PlaneRect intersection(const PlaneRect& a, const PlaneRect& b) {
  return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

PlaneRect union_of(const PlaneRect& a, const PlaneRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

uint32_t sun_place_of_request(double request) {
  const double level = std::ceil(std::log2(std::max(request, 1.0)));
  return uint32_t(kFinestLevel - std::clamp(int(level), kFinestLevel + 1 - int(sun_places), kFinestLevel));
}

std::vector<uint32_t> kept_sun_places(std::span<const uint32_t> finest_first, uint32_t most) {
  const size_t every = (finest_first.size() + most - 1) / most;
  std::vector<uint32_t> kept;
  for (size_t i = 0; i < finest_first.size(); ++i)
    if ((finest_first.size() - 1 - i) % every == 0) kept.push_back(finest_first[i]);
  return kept;
}

bool holds(const PlaneWindow& window, const SunPlane& plane, uint32_t place, const PlaneRect& rect, double slack) {
  if (rect.empty()) return true;
  const double texel = plane.texel_m(place), reach = kTapReachTexels + slack;
  const glm::dvec2 low = rect.low / texel - reach, high = rect.high / texel + reach;
  return low.x >= window.first.x && low.y >= window.first.y && high.x <= window.first.x + window.side &&
         high.y <= window.first.y + window.side;
}

}  // namespace reference
