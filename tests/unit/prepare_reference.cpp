// Slow and obvious grouping of triangles.
#include "prepare_reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

namespace test {
namespace {

using umbrage::Aabb;
using umbrage::Vec3;
using umbrage::scene::GroupLimits;

constexpr float Infinity = std::numeric_limits<float>::infinity();

Aabb united(const Aabb& a, const Aabb& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

Aabb box_of(const TriangleMesh& mesh, uint32_t triangle) {
  Aabb box{{Infinity, Infinity, Infinity}, {-Infinity, -Infinity, -Infinity}};
  for (uint32_t i = 0; i < 3; ++i) {
    const Vec3& p = mesh.positions[mesh.indices[3 * size_t{triangle} + i]];
    box = united(box, {p, p});
  }
  return box;
}

float squared_diagonal(const Aabb& box) {
  const float x = box.max.x - box.min.x, y = box.max.y - box.min.y, z = box.max.z - box.min.z;
  return x * x + y * y + z * z;
}

bool fits(const TriangleMesh& mesh, const std::vector<uint32_t>& triangles, const GroupLimits& limits) {
  std::set<uint32_t> vertices;
  for (const uint32_t t : triangles) vertices.insert(&mesh.indices[3 * size_t{t}], &mesh.indices[3 * size_t{t}] + 3);
  return triangles.size() <= limits.triangles && vertices.size() <= limits.vertices;
}

struct Cluster {
  Aabb box;
  std::vector<uint32_t> triangles;
  TriangleGroups groups;  ///< The largest subtrees within the limits; one as long as the cluster itself is.
};

std::vector<Cluster> leaves(const TriangleMesh& mesh) {
  std::vector<Cluster> clusters;
  for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) clusters.push_back({box_of(mesh, t), {t}, {{t}}});
  return clusters;
}

/// The closest two of at least two; the second is the later one.
std::pair<size_t, size_t> closest(const std::vector<Cluster>& clusters) {
  std::pair<size_t, size_t> best{0, 1};
  float least = Infinity;
  for (size_t a = 0; a < clusters.size(); ++a) {
    for (size_t b = a + 1; b < clusters.size(); ++b) {
      const float distance = squared_diagonal(united(clusters[a].box, clusters[b].box));
      if (distance < least) {
        least = distance;
        best = {a, b};
      }
    }
  }
  return best;
}

std::vector<uint32_t> joined(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  std::vector<uint32_t> all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

TriangleGroups chunks(const TriangleMesh& mesh, const std::vector<uint32_t>& order, const GroupLimits& limits) {
  TriangleGroups groups;
  for (const uint32_t t : order) {
    if (groups.empty() || !fits(mesh, joined(groups.back(), {t}), limits)) groups.emplace_back();
    groups.back().push_back(t);
  }
  return groups;
}

}  // namespace

TriangleGroups exact_groups(const TriangleMesh& mesh, const GroupLimits& limits) {
  std::vector<Cluster> clusters = leaves(mesh);
  TriangleGroups finished;
  while (clusters.size() > 1) {
    const auto [a, b] = closest(clusters);
    std::vector<uint32_t> both = joined(clusters[a].triangles, clusters[b].triangles);
    if (fits(mesh, both, limits)) {
      clusters[a] = {united(clusters[a].box, clusters[b].box), both, {}};
      clusters.erase(clusters.begin() + static_cast<ptrdiff_t>(b));
    } else {
      finished.push_back(clusters[a].triangles);
      finished.push_back(clusters[b].triangles);
      clusters.erase(clusters.begin() + static_cast<ptrdiff_t>(b));
      clusters.erase(clusters.begin() + static_cast<ptrdiff_t>(a));
    }
  }
  for (const Cluster& cluster : clusters) finished.push_back(cluster.triangles);
  return finished;
}

TriangleGroups exact_tree_cut(const TriangleMesh& mesh, const GroupLimits& limits) {
  std::vector<Cluster> clusters = leaves(mesh);
  while (clusters.size() > 1) {
    const auto [a, b] = closest(clusters);
    Cluster both{united(clusters[a].box, clusters[b].box), joined(clusters[a].triangles, clusters[b].triangles), {}};
    if (fits(mesh, both.triangles, limits)) {
      both.groups = {both.triangles};
    } else {
      both.groups = clusters[a].groups;
      both.groups.insert(both.groups.end(), clusters[b].groups.begin(), clusters[b].groups.end());
    }
    clusters[a] = both;
    clusters.erase(clusters.begin() + static_cast<ptrdiff_t>(b));
  }
  return clusters.empty() ? TriangleGroups{} : clusters[0].groups;
}

TriangleGroups index_chunks(const TriangleMesh& mesh, const GroupLimits& limits) {
  std::vector<uint32_t> order(mesh.indices.size() / 3);
  std::iota(order.begin(), order.end(), 0u);
  return chunks(mesh, order, limits);
}

TriangleGroups morton_chunks(const TriangleMesh& mesh, const GroupLimits& limits) {
  std::vector<std::pair<uint64_t, uint32_t>> codes;
  Aabb all{{Infinity, Infinity, Infinity}, {-Infinity, -Infinity, -Infinity}};
  for (const Vec3& p : mesh.positions) all = united(all, {p, p});
  const float size = std::max({all.max.x - all.min.x, all.max.y - all.min.y, all.max.z - all.min.z});
  for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
    const Aabb box = box_of(mesh, t);
    const float centre[3] = {0.5f * (box.min.x + box.max.x) - all.min.x, 0.5f * (box.min.y + box.max.y) - all.min.y,
                             0.5f * (box.min.z + box.max.z) - all.min.z};
    uint64_t code = 0;
    for (uint32_t bit = 0; bit < 20; ++bit) {
      for (uint32_t axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<uint64_t>(centre[axis] / size * 1048575);
        code |= (cell >> bit & 1) << (3 * bit + axis);
      }
    }
    codes.emplace_back(code, t);
  }
  std::sort(codes.begin(), codes.end());
  std::vector<uint32_t> order;
  order.reserve(codes.size());
  for (const auto& [code, triangle] : codes) order.push_back(triangle);
  return chunks(mesh, order, limits);
}

TriangleGroups agglomerated(const TriangleMesh& mesh, const GroupLimits& limits) {
  const auto groups = umbrage::scene::Agglomerator(mesh.positions).group(mesh.indices, limits);
  TriangleGroups result;
  uint32_t begin = 0;
  for (const uint32_t end : groups.ends) {
    result.emplace_back(groups.triangles.begin() + begin, groups.triangles.begin() + end);
    begin = end;
  }
  return result;
}

GroupQuality quality(const TriangleMesh& mesh, const TriangleGroups& groups, const GroupLimits& limits) {
  GroupQuality result;
  size_t triangles = 0;
  for (const auto& group : groups) {
    Aabb box = box_of(mesh, group[0]);
    for (const uint32_t t : group) box = united(box, box_of(mesh, t));
    const double diagonal = std::sqrt(double{squared_diagonal(box)});
    result.mean_diagonal += diagonal * static_cast<double>(group.size());
    triangles += group.size();
  }
  result.mean_diagonal /= static_cast<double>(triangles);
  result.mean_fill = static_cast<double>(triangles) / static_cast<double>(groups.size()) / limits.triangles;
  return result;
}

}  // namespace test
