#include "import/surface_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace app {
namespace {

constexpr uint32_t LeafTriangles = 4;
constexpr float MostSteps = 16;  ///< Between samples along a triangle's edge.

float squared_distance_to_box(const glm::vec3& point, const glm::vec3& lo, const glm::vec3& hi) {
  const glm::vec3 outside = glm::max(glm::max(lo - point, point - hi), glm::vec3(0));
  return glm::dot(outside, outside);
}

float squared_distance_to_segment(const glm::vec3& point, const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 along = b - a;
  const float length2 = glm::dot(along, along);
  const float t = length2 > 0 ? glm::clamp(glm::dot(point - a, along) / length2, 0.0f, 1.0f) : 0.0f;
  const glm::vec3 apart = point - (a + along * t);
  return glm::dot(apart, apart);
}

float squared_distance_to_triangle(const glm::vec3& point, const std::array<glm::vec3, 3>& corners) {
  const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  float least = std::numeric_limits<float>::max();
  bool above = glm::dot(normal, normal) > 0;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 &a = corners[i], &b = corners[(i + 1) % 3];
    least = std::min(least, squared_distance_to_segment(point, a, b));
    above = above && glm::dot(glm::cross(b - a, point - a), normal) >= 0;
  }
  if (!above) return least;
  const float height = glm::dot(point - corners[0], normal);
  return std::min(least, height * height / glm::dot(normal, normal));
}

std::array<glm::vec3, 3> triangle(std::span<const glm::vec3> positions, std::span<const uint32_t> indices, size_t i) {
  return {positions[indices[3 * i]], positions[indices[3 * i + 1]], positions[indices[3 * i + 2]]};
}

float mean_edge(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
  double sum = 0;
  for (size_t i = 0; i < indices.size() / 3; ++i) {
    const auto corners = triangle(positions, indices, i);
    for (int corner = 0; corner < 3; ++corner) sum += glm::distance(corners[corner], corners[(corner + 1) % 3]);
  }
  return std::max(static_cast<float>(sum / static_cast<double>(indices.size())), std::numeric_limits<float>::min());
}

}  // namespace

SurfaceTree::SurfaceTree(std::span<const glm::vec3> positions, std::span<const uint32_t> indices)
    : positions_(positions), indices_(indices), order_(indices.size() / 3) {
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(order_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<uint32_t>(order_.size()));
}

void SurfaceTree::split(uint32_t node, uint32_t first, uint32_t count) {
  glm::vec3 lo(std::numeric_limits<float>::max()), hi(-std::numeric_limits<float>::max());
  for (uint32_t i = first; i < first + count; ++i) {
    for (const glm::vec3& corner : triangle(positions_, indices_, order_[i])) {
      lo = glm::min(lo, corner);
      hi = glm::max(hi, corner);
    }
  }
  nodes_[node] = {lo, hi, first, count};
  if (count <= LeafTriangles) return;
  const glm::vec3 size = hi - lo;
  const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
  const auto place = [&](uint32_t i) {
    const auto corners = triangle(positions_, indices_, i);
    return corners[0][axis] + corners[1][axis] + corners[2][axis];
  };
  const uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
  const auto children = static_cast<uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node] = {lo, hi, children, 0};
  split(children, first, half);
  split(children + 1, first + half, count - half);
}

float SurfaceTree::squared_distance(const glm::vec3& point, float enough) const {
  struct Entry {
    uint32_t node;
    float distance;
  };
  std::array<Entry, 64> stack;  // Halves of 2^32 triangles at most.
  uint32_t height = 0;
  const auto distance_to = [&](uint32_t node) {
    return squared_distance_to_box(point, nodes_[node].lo, nodes_[node].hi);
  };
  stack[height++] = {0, distance_to(0)};
  float nearest = std::numeric_limits<float>::max();
  while (height > 0 && nearest > enough) {
    const Entry entry = stack[--height];
    if (entry.distance >= nearest) continue;
    const Node& node = nodes_[entry.node];
    for (uint32_t i = node.first; i < node.first + node.count; ++i)
      nearest = std::min(nearest, squared_distance_to_triangle(point, triangle(positions_, indices_, order_[i])));
    if (node.count > 0) continue;
    Entry near{node.first, distance_to(node.first)}, far{node.first + 1, distance_to(node.first + 1)};
    if (far.distance < near.distance) std::swap(near, far);
    stack[height++] = far;
    stack[height++] = near;
  }
  return nearest;
}

float sampled_distance(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                       const SurfaceTree& surface, std::span<const uint32_t> simpler) {
  float most = 0;
  const auto take = [&](const SurfaceTree& to, const glm::vec3& point) {
    most = std::max(most, to.squared_distance(point, most));
  };
  std::vector<bool> taken(positions.size());
  for (const uint32_t vertex : simpler) taken[vertex] = true;
  const SurfaceTree simple(positions, simpler);
  for (const uint32_t vertex : indices) {
    if (!taken[vertex]) take(simple, positions[vertex]);
    taken[vertex] = true;
  }
  const float spacing = mean_edge(positions, indices);
  for (size_t i = 0; i < simpler.size() / 3; ++i) {
    const auto corners = triangle(positions, simpler, i);
    const float longest = std::max({glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]),
                                    glm::distance(corners[2], corners[0])});
    const int steps = static_cast<int>(std::clamp(longest / spacing + 0.5f, 2.0f, MostSteps));
    take(surface, (corners[0] + corners[1] + corners[2]) / 3.0f);
    for (int b = 0; b <= steps; ++b) {
      for (int c = 0; c <= steps - b; ++c) {
        const glm::vec3 shares = glm::vec3(steps - b - c, b, c) / static_cast<float>(steps);
        if (std::max({shares.x, shares.y, shares.z}) < 1)  // Corners are the surface's own.
          take(surface, corners[0] * shares.x + corners[1] * shares.y + corners[2] * shares.z);
      }
    }
  }
  return std::sqrt(most);
}

}  // namespace app
