// Kinds are cut off a triangle one after the other; what is left goes on to the next.
#include "scenes/ground_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace app {
namespace {

using glm::vec2;
using glm::vec3;

struct Corner {
  vec2 p;
  GroundFields fields;  ///< Never near 0, so that cut triangles have area.
};
using Triangle = std::array<Corner, 3>;

Corner mixed(const Corner& a, const Corner& b, float t) {
  Corner corner{glm::mix(a.p, b.p, t), {}};
  for (size_t i = 0; i < max_ground_fields; ++i) corner.fields[i] = std::lerp(a.fields[i], b.fields[i], t);
  return corner;
}

/// The part of a triangle on one side of a field's contour, as a fan of at most four corners.
struct Cut {
  std::array<Corner, 4> corners;
  size_t count = 0;
};

Corner crossing(const Corner& a, const Corner& b, size_t field) {
  return mixed(a, b, -a.fields[field] / (b.fields[field] - a.fields[field]));
}

Cut cut_triangle(const Triangle& t, size_t field, bool above) {
  Cut cut;
  for (size_t i = 0; i < 3; ++i) {
    const Corner &a = t[i], &b = t[(i + 1) % 3];
    const bool a_in = (a.fields[field] > 0) == above, b_in = (b.fields[field] > 0) == above;
    if (a_in) cut.corners[cut.count++] = a;
    if (a_in != b_in) cut.corners[cut.count++] = crossing(a, b, field);
  }
  return cut;
}

class GroundMesh {
 public:
  GroundMesh(MeshBuilder& builder, const GroundDesc& desc) : builder_(builder), desc_(desc) {}

  Corner corner(vec2 p) const {
    Corner corner{p, desc_.fields(p)};
    for (float& d : corner.fields)
      if (std::abs(d) < 0.03f) d = d < 0 ? -0.03f : 0.03f;
    return corner;
  }

  void add(const Triangle& t, size_t kind = 0) {
    if (kind == desc_.kinds.size()) return add_fan(desc_.rest, {{t[0], t[1], t[2]}, 3});
    add_fan(desc_.kinds[kind], cut_triangle(t, kind, false));
    const Cut rest = cut_triangle(t, kind, true);
    if (rest.count == 0) return;
    add_step(t, kind);
    for (size_t i = 1; i + 1 < rest.count; ++i) add({rest.corners[0], rest.corners[i], rest.corners[i + 1]}, kind + 1);
  }

 private:
  vec3 normal(vec2 p) const {
    constexpr float e = 0.5f;
    const auto& h = desc_.height;
    return glm::normalize(vec3(h(p - vec2(e, 0)) - h(p + vec2(e, 0)), 2 * e, h(p - vec2(0, e)) - h(p + vec2(0, e))));
  }

  void add_fan(const GroundKind& kind, const Cut& cut) {
    for (size_t i = 1; i + 1 < cut.count; ++i) {
      const std::array<vec2, 3> p{cut.corners[0].p, cut.corners[i].p, cut.corners[i + 1].p};
      const vec2 ab = p[1] - p[0], ac = p[2] - p[0];
      if (std::abs(ab.x * ac.y - ab.y * ac.x) < 1e-5f) continue;
      std::array<vec3, 3> positions, normals;
      for (size_t k = 0; k < 3; ++k) {
        positions[k] = {p[k].x, desc_.height(p[k]) - kind.below_m, p[k].y};
        normals[k] = normal(p[k]);
      }
      builder_.surface(kind.mat, positions, normals, {}, std::array{0u, 1u, 2u});
    }
  }

  float below_after(size_t kind, const GroundFields& fields) const {
    for (size_t k = kind + 1; k < desc_.kinds.size(); ++k)
      if (fields[k] < 0) return desc_.kinds[k].below_m;
    return desc_.rest.below_m;
  }

  /// The face between a kind that lies lower and what surrounds it: kerb stones, a road's bank.
  void add_step(const Triangle& t, size_t kind) {
    const GroundKind& low = desc_.kinds[kind];
    std::array<Corner, 2> ends;
    size_t count = 0;
    for (size_t i = 0; i < 3; ++i) {
      const Corner &a = t[i], &b = t[(i + 1) % 3];
      if ((a.fields[kind] > 0) == (b.fields[kind] > 0)) continue;
      // The first end is where the higher side lies to the left of the way to the second.
      ends[a.fields[kind] > 0 ? 0 : 1] = crossing(a, b, kind);
      ++count;
    }
    if (count != 2) return;
    const float high = below_after(kind, mixed(ends[0], ends[1], 0.5f).fields);
    if (high >= low.below_m) return;
    const auto point = [&](const Corner& end, float below) {
      return vec3(end.p.x, desc_.height(end.p) - below, end.p.y);
    };
    builder_.quad(low.edge, point(ends[0], low.below_m), point(ends[1], low.below_m), point(ends[1], high),
                  point(ends[0], high));
  }

  MeshBuilder& builder_;
  const GroundDesc& desc_;
};

}  // namespace

void add_ground(MeshBuilder& builder, const GroundDesc& desc, std::span<const float> lines) {
  GroundMesh mesh(builder, desc);
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

std::vector<float> grid_lines(const GridDesc& desc) {
  std::vector<float> half{0};
  float wide = std::max(desc.step, desc.coarse);
  for (float x = desc.step; half.back() < desc.half;) {
    half.push_back(std::min(x, desc.half));
    x += x < desc.fine_half ? desc.step : wide;
    if (x > desc.fine_half) wide *= desc.growth;
  }
  std::vector<float> lines;
  for (size_t i = half.size() - 1; i > 0; --i) lines.push_back(-half[i]);
  lines.insert(lines.end(), half.begin(), half.end());
  return lines;
}

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

}  // namespace app
