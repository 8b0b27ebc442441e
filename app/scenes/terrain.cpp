// The ground is a grid whose triangles are cut along the distance field's contours, so kerbs are smooth and watertight.
#include "scenes/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace app {
namespace {

using glm::vec2;
using glm::vec3;

float segment_distance(vec2 p, vec2 a, vec2 b) {
  const vec2 ab = b - a;
  const float t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
  return glm::distance(p, a + t * ab);
}

float box_distance(vec2 p, vec2 middle, vec2 half) {
  const vec2 d = glm::abs(p - middle) - half;
  return glm::length(glm::max(d, vec2(0))) + std::min(std::max(d.x, d.y), 0.0f);
}

float smooth_ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// Crossings of the street plan, moved a little off their lattice; row and column 2 hold the main streets.
constexpr std::array<float, 5> columns{-84, -43, 0, 44, 85}, rows{-86, -50, 2, 45, 86};
constexpr std::array<std::array<vec2, 5>, 5> offsets{{{{{2, 3}, {-3, -1}, {0, 2}, {3, -2}, {-2, 2}}},
                                                      {{{-3, -2}, {2, 2}, {0, 1}, {-2, -2}, {3, 1}}},
                                                      {{{1, -3}, {-1, 2}, {0, 0}, {2, -2}, {-3, 3}}},
                                                      {{{-2, 3}, {3, -3}, {2, 1}, {-3, 2}, {1, -3}}},
                                                      {{{3, -2}, {-2, 1}, {-4, 2}, {1, 3}, {-2, -2}}}}};

vec2 crossing(size_t column, size_t row) { return vec2(columns[column], rows[row]) + offsets[row][column]; }

struct Corner {
  vec2 p;
  float distance;  ///< To the kerb, never near 0, so that cut triangles have area.
};

/// The part of a triangle on one side of the contour, as a fan of at most four corners.
struct Cut {
  std::array<vec2, 4> corners;
  size_t count = 0;
};

Cut cut_triangle(const std::array<Corner, 3>& t, float level, bool above) {
  Cut cut;
  for (size_t i = 0; i < 3; ++i) {
    const Corner &a = t[i], &b = t[(i + 1) % 3];
    const bool a_in = (a.distance > level) == above, b_in = (b.distance > level) == above;
    if (a_in) cut.corners[cut.count++] = a.p;
    if (a_in != b_in) cut.corners[cut.count++] = glm::mix(a.p, b.p, (level - a.distance) / (b.distance - a.distance));
  }
  return cut;
}

class GroundMesh {
 public:
  GroundMesh(MeshBuilder& builder, const Terrain& terrain) : builder_(builder), terrain_(terrain) {}

  Corner corner(vec2 p) const {
    float d = terrain_.street_distance(p);
    for (float level : {0.0f, pavement_m}) {
      if (std::abs(d - level) < 0.03f) d = level + (d < level ? -0.03f : 0.03f);
    }
    return {p, d};
  }

  void add(const std::array<Corner, 3>& t) {
    add_fan(Mat::cobble, cut_triangle(t, 0, false), -kerb_m);
    const Cut raised = cut_triangle(t, 0, true);
    if (raised.count == 0) return;
    add_kerb(t);
    // The raised part in turn splits into pavement and yard; its corners need their distances again.
    for (size_t i = 1; i + 1 < raised.count; ++i) {
      std::array<Corner, 3> part;
      for (size_t k = 0; k < 3; ++k) {
        const vec2 p = raised.corners[k == 0 ? 0 : i + k - 1];
        part[k] = {p, interpolate(t, p)};
      }
      add_fan(Mat::flagstone, cut_triangle(part, pavement_m, false), 0);
      add_fan(Mat::grass, cut_triangle(part, pavement_m, true), 0);
    }
  }

 private:
  static float interpolate(const std::array<Corner, 3>& t, vec2 p) {
    const auto cross = [](vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; };
    const float area = cross(t[1].p - t[0].p, t[2].p - t[0].p);
    const float v = cross(p - t[0].p, t[2].p - t[0].p) / area, w = cross(t[1].p - t[0].p, p - t[0].p) / area;
    return t[0].distance + v * (t[1].distance - t[0].distance) + w * (t[2].distance - t[0].distance);
  }

  static vec3 normal(vec2 p) {
    constexpr float e = 0.5f;
    return glm::normalize(vec3(Terrain::height(p - vec2(e, 0)) - Terrain::height(p + vec2(e, 0)), 2 * e,
                               Terrain::height(p - vec2(0, e)) - Terrain::height(p + vec2(0, e))));
  }

  void add_fan(Mat mat, const Cut& cut, float offset) {
    for (size_t i = 1; i + 1 < cut.count; ++i) {
      const std::array<vec2, 3> p{cut.corners[0], cut.corners[i], cut.corners[i + 1]};
      const vec2 ab = p[1] - p[0], ac = p[2] - p[0];
      if (std::abs(ab.x * ac.y - ab.y * ac.x) < 1e-5f) continue;
      std::array<vec3, 3> positions, normals;
      for (size_t k = 0; k < 3; ++k) {
        positions[k] = {p[k].x, Terrain::height(p[k]) + offset, p[k].y};
        normals[k] = normal(p[k]);
      }
      builder_.surface(mat, positions, normals, {}, std::array{0u, 1u, 2u});
    }
  }

  /// A row of kerb stones' faces along the contour, street side.
  void add_kerb(const std::array<Corner, 3>& t) {
    std::array<vec2, 2> ends;
    size_t count = 0;
    for (size_t i = 0; i < 3; ++i) {
      const Corner &a = t[i], &b = t[(i + 1) % 3];
      if ((a.distance > 0) == (b.distance > 0)) continue;
      // The first end is where the raised side lies to the left of the way to the second.
      const size_t slot = a.distance > 0 ? 0 : 1;
      ends[slot] = glm::mix(a.p, b.p, -a.distance / (b.distance - a.distance));
      ++count;
    }
    if (count != 2) return;
    const vec3 a{ends[0].x, Terrain::height(ends[0]), ends[0].y}, b{ends[1].x, Terrain::height(ends[1]), ends[1].y},
        down{0, -kerb_m, 0};
    builder_.quad(Mat::trim, a + down, b + down, b, a);
  }

  MeshBuilder& builder_;
  const Terrain& terrain_;
};

/// Grid lines: evenly over the town, then ever wider out to the hills.
std::vector<float> grid_lines(float step) {
  std::vector<float> half{0};
  for (float x = step; half.back() < world_half_m;) {
    half.push_back(std::min(x, world_half_m));
    x += x < town_half_m + 4 ? step : std::max(step, 6.0f);
  }
  std::vector<float> lines;
  for (size_t i = half.size() - 1; i > 0; --i) lines.push_back(-half[i]);
  lines.insert(lines.end(), half.begin(), half.end());
  return lines;
}

}  // namespace

Terrain::Terrain() {
  constexpr float lane = 2.9f, main_street = 4.1f;
  const auto add = [&](vec2 a, vec2 b, float half_width) { streets_.push_back({a, b, half_width}); };
  for (size_t row = 0; row < 5; ++row) {
    for (size_t column = 0; column < 5; ++column) {
      const vec2 here = crossing(column, row);
      if (column < 4) add(here, crossing(column + 1, row), row == 2 ? main_street : lane);
      // The church stands between the square and the street behind it.
      const bool church = column == 2 && row == 1;
      if (row < 4 && !church) add(here, crossing(column, row + 1), column == 2 ? main_street : lane);
    }
  }
  add(crossing(2, 4), {-9, world_half_m}, main_street);
  add(crossing(0, 2), {-world_half_m, -8}, lane);
  add(crossing(4, 2), {world_half_m, 14}, lane);
}

float Terrain::height(vec2 p) {
  const float climb = -0.022f * std::clamp(p.y, -100.0f, 110.0f);
  const float rolls =
      0.55f * std::sin(0.043f * p.x + 0.6f) * std::cos(0.037f * p.y) + 0.35f * std::sin(0.061f * p.y - 0.031f * p.x);
  const float out = std::max(glm::length(p), std::max(std::abs(p.x), std::abs(p.y)) * 1.1f);
  const float hills = smooth_ramp(112, 178, out) * (6.5f + 3.5f * std::sin(0.05f * p.x + 1) * std::cos(0.045f * p.y));
  return climb + rolls + hills;
}

float Terrain::street_distance(vec2 p) const {
  float nearest = box_distance(p, square_middle, square_half - 2.0f) - 2.0f;
  for (const Street& street : streets_)
    nearest = std::min(nearest, segment_distance(p, street.from, street.to) - street.half_width);
  return nearest;
}

float Terrain::ground(vec2 p) const { return height(p) - (street_distance(p) < 0 ? kerb_m : 0); }

void Terrain::build(MeshBuilder& builder, Detail detail) const {
  GroundMesh mesh(builder, *this);
  const std::vector<float> lines = grid_lines(detail == Detail::low ? 5.0f : 2.1f);
  const size_t n = lines.size();
  std::vector<Corner> corners(n * n);
  for (size_t z = 0; z < n; ++z) {
    for (size_t x = 0; x < n; ++x) corners[z * n + x] = mesh.corner({lines[x], lines[z]});
  }
  for (size_t z = 0; z + 1 < n; ++z) {
    for (size_t x = 0; x + 1 < n; ++x) {
      const Corner &a = corners[z * n + x], &b = corners[z * n + x + 1], &c = corners[(z + 1) * n + x + 1],
                   &d = corners[(z + 1) * n + x];
      mesh.add({a, d, c});
      mesh.add({a, c, b});
    }
  }
}

void add_sky(MeshBuilder& builder, Detail detail) {
  const int around = detail == Detail::low ? 24 : 48, rings = detail == Detail::low ? 6 : 12;
  const auto point = [&](int step, int ring) {
    const float angle = 6.2831853f * static_cast<float>(step % around) / static_cast<float>(around);
    const float rise = 1.5707963f * static_cast<float>(ring) / static_cast<float>(rings);
    const float radius = (world_half_m - 0.5f) * std::cos(rise);
    return vec3{radius * std::sin(angle), -6 + 96 * std::sin(rise), radius * std::cos(angle)};
  };
  std::vector<vec3> positions, normals;
  std::vector<vec2> uvs;
  std::vector<uint32_t> indices;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int step = 0; step <= around; ++step) {
      const vec3 p = point(step, ring);
      positions.push_back(p);
      normals.push_back(glm::normalize(-vec3(p.x, 0.7f * p.y, p.z)));
      uvs.push_back({static_cast<float>(step) / static_cast<float>(around),
                     1 - static_cast<float>(ring) / static_cast<float>(rings)});
    }
  }
  const auto at = [&](int step, int ring) { return static_cast<uint32_t>(ring * (around + 1) + step); };
  for (int ring = 0; ring < rings; ++ring) {
    for (int step = 0; step < around; ++step) {
      const std::array faces{at(step + 1, ring), at(step, ring),     at(step, ring + 1),
                             at(step + 1, ring), at(step, ring + 1), at(step + 1, ring + 1)};
      indices.insert(indices.end(), faces.begin(), ring + 1 == rings ? faces.begin() + 3 : faces.end());
    }
  }
  builder.surface(Mat::sky, positions, normals, uvs, indices);
}

}  // namespace app
