// Shapes into triangles. Texture coordinates are the local position seen along its normal's main axis, so that
// neighbours in one plane match and every part carries its grain along its own y.
#include "scenes/mesh_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <unordered_map>

#include "scenes/random.hpp"

namespace app {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float tau = 6.2831853f;
constexpr float smallest_area_m2 = 2e-7f;

vec2 metres_uv(vec3 position, vec3 normal) {
  const vec3 size = glm::abs(normal);
  if (size.y >= size.x && size.y >= size.z) return {position.x, normal.y > 0 ? position.z : -position.z};
  if (size.x > size.z) return {normal.x > 0 ? -position.z : position.z, -position.y};
  return {normal.z > 0 ? position.x : -position.x, -position.y};
}

/// Makes vertices with the same bits one; triangles keep their order.
void weld(Primitive& primitive) {
  struct Key {
    std::array<float, 8> bits;
    bool operator==(const Key&) const = default;
  };
  const auto hash = [](const Key& key) {
    uint32_t h = 0;
    for (float value : key.bits) h = mix_bits(std::bit_cast<uint32_t>(value), h);
    return size_t{h};
  };
  std::unordered_map<Key, uint32_t, decltype(hash)> seen(primitive.positions.size(), hash);
  std::vector<uint32_t> moved(primitive.positions.size());
  uint32_t kept = 0;
  for (uint32_t i = 0; i < moved.size(); ++i) {
    const vec3 p = primitive.positions[i], n = primitive.normals[i];
    const vec2 uv = primitive.uv[0][i];
    const auto [entry, is_new] = seen.try_emplace({p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}, kept);
    moved[i] = entry->second;
    if (!is_new) continue;
    primitive.positions[kept] = p;
    primitive.normals[kept] = n;
    primitive.uv[0][kept] = uv;
    ++kept;
  }
  primitive.positions.resize(kept);
  primitive.normals.resize(kept);
  primitive.uv[0].resize(kept);
  for (uint32_t& index : primitive.indices) index = moved[index];
}

vec3 on_circle(float radius, float height, int step, int sides) {
  const float angle = tau * static_cast<float>(step % sides) / static_cast<float>(sides);
  return {radius * std::sin(angle), height, radius * std::cos(angle)};
}

}  // namespace

glm::mat4 place(vec3 position, float turn_y) {
  return glm::rotate(glm::translate(glm::mat4(1), position), turn_y, vec3(0, 1, 0));
}

MeshBuilder::Frame::Frame(MeshBuilder& builder, const glm::mat4& local)
    : builder_(builder), outer_(builder.world_from_local_) {
  builder.world_from_local_ = outer_ * local;
}
MeshBuilder::Frame::~Frame() { builder_.world_from_local_ = outer_; }
MeshBuilder::Frame MeshBuilder::at(vec3 position, float turn_y) { return Frame(*this, place(position, turn_y)); }

uint32_t MeshBuilder::add_vertex(Primitive& primitive, const Vertex& vertex) const {
  primitive.positions.push_back(vec3(world_from_local_ * glm::vec4(vertex.position, 1)));
  primitive.normals.push_back(glm::normalize(glm::mat3(world_from_local_) * vertex.normal));
  primitive.uv[0].push_back(vertex.uv);
  return static_cast<uint32_t>(primitive.positions.size() - 1);
}

void MeshBuilder::add_triangle(Mat mat, const Vertex& a, const Vertex& b, const Vertex& c) {
  if (glm::length(glm::cross(b.position - a.position, c.position - a.position)) < 2 * smallest_area_m2) return;
  Primitive& primitive = primitives_[static_cast<size_t>(mat)];
  for (const Vertex* vertex : {&a, &b, &c}) primitive.indices.push_back(add_vertex(primitive, *vertex));
}

void MeshBuilder::triangle(Mat mat, vec3 a, vec3 b, vec3 c) {
  const vec3 n = glm::cross(b - a, c - a);
  add_triangle(mat, {a, n, metres_uv(a, n)}, {b, n, metres_uv(b, n)}, {c, n, metres_uv(c, n)});
}

void MeshBuilder::quad(Mat mat, vec3 a, vec3 b, vec3 c, vec3 d) {
  const vec3 n = glm::cross(c - a, d - b);
  const bool folded = glm::length(glm::cross(b - a, c - a)) < 2 * smallest_area_m2 ||
                      glm::length(glm::cross(c - a, d - a)) < 2 * smallest_area_m2;
  if (folded) {
    triangle(mat, a, b, c);
    triangle(mat, a, c, d);
    return;
  }
  Primitive& primitive = primitives_[static_cast<size_t>(mat)];
  const uint32_t first = add_vertex(primitive, {a, n, metres_uv(a, n)});
  for (vec3 p : {b, c, d}) add_vertex(primitive, {p, n, metres_uv(p, n)});
  for (uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) primitive.indices.push_back(first + corner);
}

void MeshBuilder::picture(Mat mat, vec3 a, vec3 b, vec3 c, vec3 d) {
  const vec3 n = glm::cross(c - a, d - b);
  Primitive& primitive = primitives_[static_cast<size_t>(mat)];
  const uint32_t first = add_vertex(primitive, {a, n, {0, 1}});
  add_vertex(primitive, {b, n, {1, 1}});
  add_vertex(primitive, {c, n, {1, 0}});
  add_vertex(primitive, {d, n, {0, 0}});
  for (uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) primitive.indices.push_back(first + corner);
}

void MeshBuilder::block(Mat mat, const std::array<vec3, 8>& p) {
  quad(mat, p[3], p[2], p[1], p[0]);
  quad(mat, p[4], p[5], p[6], p[7]);
  for (size_t i = 0; i < 4; ++i) {
    const size_t j = (i + 1) % 4;
    quad(mat, p[i], p[j], p[j + 4], p[i + 4]);
  }
}

void MeshBuilder::box(Mat mat, vec3 low, vec3 high, Ends ends) {
  bar(mat, low, high, ends);
  quad(mat, {high.x, low.y, low.z}, low, {low.x, high.y, low.z}, {high.x, high.y, low.z});
}

void MeshBuilder::bar(Mat mat, vec3 low, vec3 high, Ends ends) {
  const vec3 a = low, b = high;
  quad(mat, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
  if (ends != Ends::not_x) {
    quad(mat, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z});
    quad(mat, {b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z});
  }
  if (ends != Ends::not_y) {
    quad(mat, {a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z});
    quad(mat, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z});
  }
}

void MeshBuilder::stained_quad(Mat mat, vec3 a, vec3 b, vec3 c, vec3 d, vec2 uv_shift) {
  std::vector<vec2>& uv = primitives_[static_cast<size_t>(mat)].uv[0];
  const size_t first = uv.size();
  quad(mat, a, b, c, d);
  for (size_t i = first; i < uv.size(); ++i) uv[i] += uv_shift;
}

void MeshBuilder::stand(Mat mat, vec3 foot, vec3 size) {
  const vec3 half{size.x / 2, 0, size.z / 2};
  box(mat, foot - half, foot + half + vec3(0, size.y, 0));
}

void MeshBuilder::beam(Mat mat, vec3 from, vec3 to, float width, float depth, vec3 side) {
  const float length = glm::distance(from, to);
  const vec3 y = (to - from) / length;
  vec3 x = side - y * glm::dot(side, y);
  if (glm::length(x) < 1e-3f) x = vec3(0, 0, 1) - y * y.z;
  x = glm::normalize(x);
  const vec3 z = glm::cross(x, y);
  const Frame scope(*this, glm::mat4(glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(z, 0), glm::vec4(from, 1)));
  box(mat, {-width / 2, 0, -depth / 2}, {width / 2, length, depth / 2});
}

void MeshBuilder::tube(Mat mat, std::span<const vec3> points, std::span<const float> radii, int sides) {
  std::vector<Vertex> rings;
  rings.reserve(points.size() * static_cast<size_t>(sides + 1));
  vec3 x{1, 0, 0};
  float along = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, points.size() - 1);
    const vec3 y = glm::normalize(points[after] - points[before]);
    // The frame is carried along, so that the tube does not twist.
    x -= y * glm::dot(x, y);
    if (glm::length(x) < 0.1f) x = vec3(0, 0, 1) - y * y.z;
    x = glm::normalize(x);
    const vec3 z = glm::cross(x, y);
    if (i > 0) along += glm::distance(points[i], points[i - 1]);
    for (int s = 0; s <= sides; ++s) {
      const vec3 c = on_circle(1, 0, s, sides);
      const vec3 out = x * c.x + z * c.z;
      rings.push_back({points[i] + out * radii[i],
                       out,
                       {tau * radii[0] * static_cast<float>(s) / static_cast<float>(sides), -along}});
    }
  }
  const size_t stride = static_cast<size_t>(sides) + 1;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    for (size_t s = 0; s + 1 < stride; ++s) {
      const Vertex &a = rings[i * stride + s], &b = rings[i * stride + s + 1];
      const Vertex &c = rings[(i + 1) * stride + s + 1], &d = rings[(i + 1) * stride + s];
      add_triangle(mat, a, b, c);
      add_triangle(mat, a, c, d);
    }
  }
  const size_t top = (points.size() - 1) * stride;
  for (size_t s = 1; s + 2 < stride; ++s) {
    triangle(mat, rings[0].position, rings[s + 1].position, rings[s].position);
    triangle(mat, rings[top].position, rings[top + s].position, rings[top + s + 1].position);
  }
}

void MeshBuilder::rod(Mat mat, vec3 from, vec3 to, float radius, int sides) {
  tube(mat, std::array{from, to}, std::array{radius, radius}, sides);
}

void MeshBuilder::lathe(Mat mat, std::span<const RadiusHeight> outline, int sides) {
  for (size_t i = 0; i + 1 < outline.size(); ++i) {
    const RadiusHeight low = outline[i], high = outline[i + 1];
    const float widest = std::max(low.radius, high.radius);
    const vec2 slope = glm::normalize(vec2(high.height - low.height, low.radius - high.radius));  // Outward, up.
    const auto vertex = [&](const RadiusHeight& point, int step) {
      const vec3 out = on_circle(1, 0, step, sides);
      const float u = tau * widest * static_cast<float>(step) / static_cast<float>(sides);
      // Nearly flat rings (table tops, basins) are seen from above, the others from the side.
      const vec3 position = on_circle(point.radius, point.height, step, sides);
      const vec2 uv = std::abs(slope.y) > 0.8f ? vec2(position.x, position.z) : vec2(u, -point.height);
      return Vertex{position, vec3(out.x * slope.x, slope.y, out.z * slope.x), uv};
    };
    for (int s = 0; s < sides; ++s) {
      add_triangle(mat, vertex(low, s), vertex(low, s + 1), vertex(high, s + 1));
      add_triangle(mat, vertex(low, s), vertex(high, s + 1), vertex(high, s));
    }
  }
}

void MeshBuilder::ball(Mat mat, vec3 centre, float radius, int sides) {
  const int rings = std::max(2, sides / 2);
  const auto vertex = [&](int ring, int step) {
    const float angle = tau / 2 * static_cast<float>(ring) / static_cast<float>(rings);
    vec3 out = on_circle(std::sin(angle), -std::cos(angle), step, sides);
    if (ring == 0 || ring == rings) out = {0, ring == 0 ? -1.0f : 1.0f, 0};
    return Vertex{centre + radius * out, out,
                  radius * vec2(tau * static_cast<float>(step) / static_cast<float>(sides), angle)};
  };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sides; ++s) {
      add_triangle(mat, vertex(r, s), vertex(r, s + 1), vertex(r + 1, s + 1));
      add_triangle(mat, vertex(r, s), vertex(r + 1, s + 1), vertex(r + 1, s));
    }
  }
}

void MeshBuilder::leaf(Mat mat, vec3 stem, vec3 along, vec3 across, vec3 normal) {
  const vec3 middle = stem + 0.45f * along - 0.12f * glm::length(across) * normal, tip = stem + along;
  const auto vertex = [&](vec3 position, vec2 uv) { return Vertex{position, normal, uv}; };
  vec3 left = middle - across, right = middle + across;
  if (glm::dot(glm::cross(right - stem, tip - stem), normal) < 0) std::swap(left, right);
  Primitive& primitive = primitives_[static_cast<size_t>(mat)];
  const uint32_t first = add_vertex(primitive, vertex(stem, {0.5f, 1}));
  add_vertex(primitive, vertex(right, {1, 0.5f}));
  add_vertex(primitive, vertex(tip, {0.5f, 0}));
  add_vertex(primitive, vertex(left, {0, 0.5f}));
  for (uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) primitive.indices.push_back(first + corner);
}

void MeshBuilder::surface(Mat mat, std::span<const vec3> positions, std::span<const vec3> normals,
                          std::span<const vec2> uvs, std::span<const uint32_t> indices) {
  Primitive& primitive = primitives_[static_cast<size_t>(mat)];
  const uint32_t first = static_cast<uint32_t>(primitive.positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    add_vertex(primitive, {positions[i], normals[i], uvs.empty() ? metres_uv(positions[i], normals[i]) : uvs[i]});
  }
  for (uint32_t index : indices) primitive.indices.push_back(first + index);
}

size_t MeshBuilder::triangle_count() const {
  size_t count = 0;
  for (const Primitive& primitive : primitives_) count += primitive.indices.size() / 3;
  return count;
}

Mesh MeshBuilder::take(std::string name) {
  Mesh mesh{.name = std::move(name)};
  for (size_t i = 0; i < primitives_.size(); ++i) {
    if (primitives_[i].indices.empty()) continue;
    weld(primitives_[i]);
    primitives_[i].material = static_cast<uint32_t>(i);
    mesh.primitives.push_back(std::move(primitives_[i]));
    primitives_[i] = {};
  }
  return mesh;
}

}  // namespace app
