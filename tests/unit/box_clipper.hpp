// What a part of a cube face sees of a box, the slow and obvious way: the box's six sides as polygons, clipped in
// double precision. Shares nothing with the code under test, face orientation included.
#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "umbrage/types.hpp"

namespace umbrage::test {

struct Point {
  double x = 0, y = 0, z = 0;
};

/// Rows of the cube map table of the Vulkan specification ("Cube Map Face Selection"): sc, tc and the axis.
inline Point face_point(uint32_t face, const Point& p) {
  switch (face) {
    case 0:
      return {-p.z, -p.y, +p.x};
    case 1:
      return {+p.z, -p.y, -p.x};
    case 2:
      return {+p.x, +p.z, +p.y};
    case 3:
      return {+p.x, -p.z, -p.y};
    case 4:
      return {+p.x, -p.y, +p.z};
    default:
      return {-p.x, -p.y, -p.z};
  }
}

/// A rectangle in s and t.
struct Window {
  double s_min = -1, t_min = -1, s_max = 1, t_max = 1;
  Window grown(double by) const { return {s_min - by, t_min - by, s_max + by, t_max + by}; }
};

/// Part of `polygon` on the side where `distance` is not negative (Sutherland and Hodgman 1974).
template <class Distance>
std::vector<Point> clip(const std::vector<Point>& polygon, Distance distance) {
  std::vector<Point> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const double at_a = distance(a), at_b = distance(b);
    if (at_a >= 0) kept.push_back(a);
    if ((at_a < 0) != (at_b < 0)) {
      const double u = at_a / (at_a - at_b);
      kept.push_back({a.x + u * (b.x - a.x), a.y + u * (b.y - a.y), a.z + u * (b.z - a.z)});
    }
  }
  return kept;
}

/// What a face sees of a box within a window.
struct Seen {
  Window bounds;
  double depth_min = 0, depth_max = 0;
};

inline std::array<std::vector<Point>, 6> sides_of(uint32_t face, const Aabb& box) {
  const std::array<std::array<double, 3>, 2> corner{
      {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}}};
  std::array<std::vector<Point>, 6> sides;
  for (size_t side = 0; side < 6; ++side) {
    const size_t axis = side / 2;
    for (const auto& [u, v] : std::array<std::array<size_t, 2>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}) {
      std::array<double, 3> p;
      p[axis] = corner[side % 2][axis];
      p[(axis + 1) % 3] = corner[u][(axis + 1) % 3];
      p[(axis + 2) % 3] = corner[v][(axis + 2) % 3];
      sides[side].push_back(face_point(face, {p[0], p[1], p[2]}));
    }
  }
  return sides;
}

/// The window must lie around or inside of the face's square. Points nearer than `apex` in depth are left out: where
/// the light is on or in the box, every other point of the ray through such a point says the same. Coordinates within
/// 1e9 of each other, or double precision is not enough.
inline std::optional<Seen> see(uint32_t face, const Aabb& box, const Window& window, double apex = 0) {
  std::optional<Seen> seen;
  for (std::vector<Point> polygon : sides_of(face, box)) {
    polygon = clip(polygon, [](const Point& p) { return p.z; });
    polygon = clip(polygon, [&](const Point& p) { return p.x - window.s_min * p.z; });
    polygon = clip(polygon, [&](const Point& p) { return window.s_max * p.z - p.x; });
    polygon = clip(polygon, [&](const Point& p) { return p.y - window.t_min * p.z; });
    polygon = clip(polygon, [&](const Point& p) { return window.t_max * p.z - p.y; });
    for (const Point& p : polygon) {
      if (p.z <= apex) continue;
      const double s = p.x / p.z, t = p.y / p.z;
      if (!seen) seen = Seen{{s, t, s, t}, p.z, p.z};
      seen->bounds = {std::min(seen->bounds.s_min, s), std::min(seen->bounds.t_min, t), std::max(seen->bounds.s_max, s),
                      std::max(seen->bounds.t_max, t)};
      seen->depth_min = std::min(seen->depth_min, p.z);
      seen->depth_max = std::max(seen->depth_max, p.z);
    }
  }
  const bool holds_light =
      std::max({box.min.x, box.min.y, box.min.z}) <= 0 && std::min({box.max.x, box.max.y, box.max.z}) >= 0;
  if (seen && holds_light) seen->depth_min = 0;
  return seen;
}

}  // namespace umbrage::test
