#include "reference/page_raster.hpp"

#include <algorithm>
#include <cmath>

namespace reference {
namespace {

struct Vertex {
  int64_t x, y;  // 1/256 texels
  double z;
};

using Polygon = std::vector<glm::vec4>;

/// The part of a polygon at which the distance is not negative; cuts run from inside to outside.
template <class Distance>
Polygon cut(const Polygon& polygon, Distance distance) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec4 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const float a = distance(from), b = distance(to);
    if (a >= 0) kept.push_back(from);
    if (a >= 0 && b < 0) kept.push_back(from + (to - from) * (a / (a - b)));
    if (a < 0 && b >= 0) kept.push_back(to + (from - to) * (b / (b - a)));
  }
  return kept;
}

Vertex place(const glm::vec4& position, uint32_t resolution) {
  const float half_side = float(resolution) * 0.5f, reciprocal = 1 / position.w;
  const float x = position.x * reciprocal * half_side + half_side, y = position.y * reciprocal * half_side + half_side;
  return {std::llrint(x * 256), std::llrint(y * 256), std::clamp(position.z * reciprocal, 0.0f, 1.0f)};
}

int64_t edge(const Vertex& a, const Vertex& b, int64_t x, int64_t y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// Inside, or on a top or a left side of a triangle that turns clockwise with y down.
bool is_inside(const Vertex& a, const Vertex& b, int64_t x, int64_t y) {
  const int64_t e = edge(a, b, x, y);
  const bool is_left = b.y < a.y, is_top = b.y == a.y && b.x > a.x;
  return e > 0 || (e == 0 && (is_left || is_top));
}

void fill(DepthWindow& window, std::array<Vertex, 3> v) {
  if (edge(v[0], v[1], v[2].x, v[2].y) < 0) std::swap(v[1], v[2]);
  const int64_t area = edge(v[0], v[1], v[2].x, v[2].y);
  if (area == 0) return;
  const auto [left, right] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [top, bottom] = std::minmax({v[0].y, v[1].y, v[2].y});
  const auto begin = [&](int64_t sub, uint32_t first) { return std::max<int64_t>((sub >> 8) - 1, first); };
  const auto end = [&](int64_t sub, uint32_t first) { return std::min<int64_t>((sub >> 8) + 2, first + window.side); };
  const double z_min = std::min({v[0].z, v[1].z, v[2].z}), z_max = std::max({v[0].z, v[1].z, v[2].z});
  for (int64_t row = begin(top, window.first.y); row < end(bottom, window.first.y); ++row) {
    for (int64_t column = begin(left, window.first.x); column < end(right, window.first.x); ++column) {
      const int64_t x = 256 * column + 128, y = 256 * row + 128;
      if (!is_inside(v[0], v[1], x, y) || !is_inside(v[1], v[2], x, y) || !is_inside(v[2], v[0], x, y)) continue;
      const double z = (double(edge(v[1], v[2], x, y)) * v[0].z + double(edge(v[2], v[0], x, y)) * v[1].z +
                        double(edge(v[0], v[1], x, y)) * v[2].z) /
                       double(area);
      const size_t at = size_t(row - window.first.y) * window.side + size_t(column - window.first.x);
      window.covered[at] = true;
      window.depth[at] = std::max(window.depth[at], std::clamp(z, z_min, z_max));
    }
  }
}

}  // namespace

void draw_triangle(DepthWindow& window, const std::array<glm::vec4, 3>& clip_positions) {
  for (const glm::vec4& p : clip_positions)
    if (!std::isfinite(p.x + p.y + p.z + p.w)) return;
  // Beyond 16000 texels from the middle nothing is drawn: it is the fixed-point numbers' range.
  const float guard = 32000.0f / float(window.resolution) - 1;
  Polygon polygon(clip_positions.begin(), clip_positions.end());
  polygon = cut(polygon, [](const glm::vec4& p) { return p.w - p.z; });
  polygon = cut(polygon, [](const glm::vec4& p) { return p.z; });
  polygon = cut(polygon, [&](const glm::vec4& p) { return guard * p.w - p.x; });
  polygon = cut(polygon, [&](const glm::vec4& p) { return guard * p.w + p.x; });
  polygon = cut(polygon, [&](const glm::vec4& p) { return guard * p.w - p.y; });
  polygon = cut(polygon, [&](const glm::vec4& p) { return guard * p.w + p.y; });
  for (size_t i = 2; i < polygon.size(); ++i)
    fill(window, {place(polygon[0], window.resolution), place(polygon[i - 1], window.resolution),
                  place(polygon[i], window.resolution)});
}

}  // namespace reference
