#include "reference/map_casters.hpp"

#include <algorithm>
#include <cmath>

namespace reference {
namespace {

struct Interval {
  double low, high;
  bool empty() const { return low > high; }
};

Interval along(glm::dvec4 row, const Box& box) {
  Interval result{row.w, row.w};
  for (int axis = 0; axis < 3; ++axis) {
    const double a = row[axis] * double(box.min[axis]), b = row[axis] * double(box.max[axis]);
    result.low += std::min(a, b);
    result.high += std::max(a, b);
  }
  return result;
}

/// The box around a box in a view's coordinates.
struct BoxInView {
  Interval x, y, depth;
};

BoxInView in_view(const CasterView& view, const Box& box, double tolerance) {
  BoxInView seen{along(view.x, box), along(view.y, box), along(view.depth, box)};
  const auto farthest = [](Interval i) { return std::max(std::abs(i.low), std::abs(i.high)); };
  const double grow =
      tolerance * std::max({farthest(seen.x), farthest(seen.y), farthest(seen.depth), view.perspective ? 0.0 : 1.0});
  for (Interval* interval : {&seen.x, &seen.y, &seen.depth}) interval->low -= grow, interval->high += grow;
  return seen;
}

/// Depths of points of the box with low ≤ c / depth ≤ high for one of their other coordinates c: linear in the depth.
Interval depths_within(Interval c, Interval quotient) {
  Interval depths{0, std::numeric_limits<double>::infinity()};
  // quotient.low * depth ≤ c.high
  if (quotient.low > 0)
    depths.high = std::min(depths.high, c.high / quotient.low);
  else if (quotient.low < 0)
    depths.low = std::max(depths.low, c.high / quotient.low);
  else if (c.high < 0)
    return {1, 0};
  // quotient.high * depth ≥ c.low
  if (quotient.high > 0)
    depths.low = std::max(depths.low, c.low / quotient.high);
  else if (quotient.high < 0)
    depths.high = std::min(depths.high, c.low / quotient.high);
  else if (c.low > 0)
    return {1, 0};
  return depths;
}

/// Depths at which the box is seen within a window of the view.
Interval depths_in_window(const CasterView& view, const BoxInView& box, Interval s, Interval t) {
  if (!view.perspective) {
    const bool meets = box.x.low <= s.high && box.x.high >= s.low && box.y.low <= t.high && box.y.high >= t.low;
    return meets ? box.depth : Interval{1, 0};
  }
  const Interval by_x = depths_within(box.x, s), by_y = depths_within(box.y, t);
  const Interval depths{std::max({box.depth.low, by_x.low, by_y.low}),
                        std::min({box.depth.high, by_x.high, by_y.high})};
  return depths.high > 0 ? depths : Interval{1, 0};
}

Interval tile(uint32_t i) { return {2.0 * i / projection_side - 1, 2.0 * (i + 1) / projection_side - 1}; }

bool draws(const CasterView& view, const CasterReceivers& receivers, bool whole, const Box& box, CasterTest test,
           double tolerance) {
  const BoxInView seen = in_view(view, box, tolerance);
  const Interval depths = depths_in_window(view, seen, {-1, 1}, {-1, 1});
  if (depths.empty()) return false;
  if (whole) return true;
  const auto in_front_of = [&](float receiver) { return depths.low <= double(receiver) * (1 + tolerance) + tolerance; };
  if (test == CasterTest::projection_map_depth &&
      !in_front_of(*std::max_element(receivers.farthest.begin(), receivers.farthest.end())))
    return false;
  const uint32_t tiles_per_cell = projection_side / receivers.grid;
  for (uint32_t y = 0; y < projection_side; ++y) {
    for (uint32_t x = 0; x < projection_side; ++x) {
      if (!(receivers.tiles[y] >> x & 1)) continue;
      if (test == CasterTest::view_mask) return true;
      if (depths_in_window(view, seen, tile(x), tile(y)).empty()) continue;
      if (test != CasterTest::receiver_grid) return true;
      if (in_front_of(receivers.farthest[y / tiles_per_cell * receivers.grid + x / tiles_per_cell])) return true;
    }
  }
  return false;
}

}  // namespace

uint32_t views_to_draw(const CasterMap& map, const Box& box, CasterTest test, double tolerance) {
  if (box.empty()) return 0;
  if (test == CasterTest::light_volume) return (1u << map.views.size()) - 1;
  uint32_t views = 0;
  for (uint32_t v = 0; v < map.views.size(); ++v)
    if (draws(map.views[v], map.receivers[v], map.whole, box, test, tolerance)) views |= 1u << v;
  return views;
}

double caster_error_m(const CasterMap& map, const Box& box, double texels) {
  const CasterView& view = map.views.front();
  const double texel_m = 2 / glm::length(glm::dvec3(view.x)) / map.resolution;
  if (!view.perspective) return texels * texel_m;
  double depth = map.near_m;  // Of a cube, that of the face in whose direction the box lies.
  for (const CasterView& one : map.views) depth = std::max(depth, along(one.depth, box).low);
  return texels * texel_m * depth;
}

uint32_t detail_level(const std::vector<double>& errors_m, double error_m) {
  uint32_t level = 0;
  while (level + 1 < errors_m.size() && errors_m[level + 1] <= error_m) ++level;
  return level;
}

}  // namespace reference
