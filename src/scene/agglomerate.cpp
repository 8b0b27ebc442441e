// Agglomerative clustering along a constraint tree. The tree halves the triangles' Morton order; each node takes what its
// halves could not finish, merges the closest pairs until few clusters remain, and hands those to its parent.
#include "scene/agglomerate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace umbrage::scene {
namespace {

constexpr float Infinity = std::numeric_limits<float>::infinity();
/// A node hands at most this many clusters to its parent; its two halves make twice as many.
constexpr uint32_t MaxHandedOn = 32;
constexpr uint32_t MaxPool = 2 * MaxHandedOn;
constexpr uint32_t MortonBits = 21;
static_assert(ExactTriangles <= MaxPool);

/// Clusters that a node of so many triangles hands on: 2 √n, which keeps more freedom of choice the fewer there are.
uint32_t handed_on(uint32_t triangle_count) {
  if (triangle_count >= MaxHandedOn * MaxHandedOn / 4) return MaxHandedOn;
  return std::max(1u, static_cast<uint32_t>(2 * std::sqrt(static_cast<float>(triangle_count))));
}

/// Moves bit i to bit 3 i.
uint64_t spread_bits(uint64_t value) {
  value = (value | value << 32) & 0x001f00000000ffffu;
  value = (value | value << 16) & 0x001f0000ff0000ffu;
  value = (value | value << 8) & 0x100f00f00f00f00fu;
  value = (value | value << 4) & 0x10c30c30c30c30c3u;
  return (value | value << 2) & 0x1249249249249249u;
}

/// A power of two that brings the largest coordinate below 1 and, where floats allow, to at least 1/2.
float unit_scale(std::span<const Vec3> positions) {
  float largest = 0;
  for (const Vec3& p : positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (largest == 0) return 1;
  return std::ldexp(1.0f, std::min(126, -(std::ilogb(largest) + 1)));
}

}  // namespace

/// The distances between all clusters of a node, and each one's nearest.
class Agglomerator::Pairs {
 public:
  explicit Pairs(std::span<Cluster> clusters)
      : clusters_(clusters.data()), count_(static_cast<uint32_t>(clusters.size())) {
    assert(count_ <= MaxPool);
    for (uint32_t i = 0; i < count_; ++i) {
      distance_[i][i] = Infinity;
      for (uint32_t j = 0; j < i; ++j) set_distance(i, j);
    }
    for (uint32_t i = 0; i < count_; ++i) find_nearest(i);
  }

  uint32_t count() const { return count_; }

  /// The closest two, smaller index first. Precondition: count() > 1.
  std::pair<uint32_t, uint32_t> closest() const {
    const auto* best = std::min_element(nearest_distance_.data(), nearest_distance_.data() + count_);
    const auto i = static_cast<uint32_t>(best - nearest_distance_.data());
    return std::minmax(i, nearest_[i]);
  }

  /// clusters[a] has taken over clusters[b]; the last cluster moves to b. Precondition: a < b.
  void merged(uint32_t a, uint32_t b) {
    nearest_[a] = Stale;
    for (uint32_t i = 0; i < count_; ++i) {
      if (i == a || i == b) continue;
      set_distance(a, i);
      if (nearest_[i] != a && nearest_[i] != b) continue;
      // The merged box is no smaller than its parts, so an equal distance is still the least.
      nearest_[i] = distance_[a][i] <= nearest_distance_[i] ? a : Stale;
    }
    erase(b);
    refresh();
  }

  /// Takes both out; the last clusters move to their places. Precondition: a < b.
  void removed(uint32_t a, uint32_t b) {
    erase(b);
    erase(a);
    refresh();
  }

 private:
  static constexpr uint32_t Stale = ~0u;

  void set_distance(uint32_t i, uint32_t j) {
    distance_[i][j] = distance_[j][i] = diagonal_squared(clusters_[i].box, clusters_[j].box);
  }

  void find_nearest(uint32_t i) {
    const auto* row = distance_[i].data();
    const auto* least = std::min_element(row, row + count_);
    nearest_[i] = static_cast<uint32_t>(least - row);
    nearest_distance_[i] = *least;
  }

  void erase(uint32_t gone) {
    const uint32_t last = --count_;
    for (uint32_t i = 0; i <= last; ++i) {
      if (nearest_[i] == gone) nearest_[i] = Stale;
      if (nearest_[i] == last) nearest_[i] = gone;
    }
    if (gone == last) return;
    clusters_[gone] = clusters_[last];
    nearest_[gone] = nearest_[last];
    nearest_distance_[gone] = nearest_distance_[last];
    for (uint32_t i = 0; i < count_; ++i) distance_[gone][i] = distance_[i][gone] = distance_[last][i];
    distance_[gone][gone] = Infinity;
  }

  void refresh() {
    for (uint32_t i = 0; i < count_; ++i) {
      if (nearest_[i] == Stale) find_nearest(i);
    }
  }

  Cluster* clusters_;
  uint32_t count_;
  std::array<std::array<float, MaxPool>, MaxPool> distance_;
  std::array<uint32_t, MaxPool> nearest_;
  std::array<float, MaxPool> nearest_distance_;
};

Agglomerator::Agglomerator(std::span<const Vec3> positions)
    : positions_(positions), scale_(unit_scale(positions)), marks_(positions.size()) {}

Groups Agglomerator::group(std::span<const uint32_t> indices, const GroupLimits& limits) {
  assert(indices.size() % 3 == 0 && limits.triangles >= 1 && limits.vertices >= 3);
  indices_ = indices;
  limits_ = limits;
  pool_.clear();
  finished_.clear();
  if (indices.empty()) return {};
  sort_triangles();
  next_.assign(order_.size(), 0);
  cluster(0, static_cast<uint32_t>(order_.size()));
  reduce(0, 1);
  finished_.insert(finished_.end(), pool_.begin(), pool_.end());
  return collect();
}

Agglomerator::Box Agglomerator::triangle_box(uint32_t triangle) const {
  Box box{{Infinity, Infinity, Infinity}, {-Infinity, -Infinity, -Infinity}};
  for (uint32_t corner = 0; corner < 3; ++corner) {
    const Vec3& p = positions_[indices_[3 * size_t{triangle} + corner]];
    const float scaled[3] = {p.x * scale_, p.y * scale_, p.z * scale_};
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::min(box.lo[axis], scaled[axis]);
      box.hi[axis] = std::max(box.hi[axis], scaled[axis]);
    }
  }
  return box;
}

/// Fills codes_ and order_: box centres along the Morton curve of their common cube, equal ones in the input's order.
void Agglomerator::sort_triangles() {
  struct Place {
    float centre[3];
    uint32_t triangle;
    uint64_t code;
  };
  std::vector<Place> places(indices_.size() / 3);
  const auto count = static_cast<uint32_t>(places.size());
  float lo[3] = {Infinity, Infinity, Infinity};
  float hi[3] = {-Infinity, -Infinity, -Infinity};
  for (uint32_t t = 0; t < count; ++t) {
    const Box box = triangle_box(t);
    places[t].triangle = t;
    for (int axis = 0; axis < 3; ++axis) {
      const float centre = 0.5f * (box.lo[axis] + box.hi[axis]);
      places[t].centre[axis] = centre;
      lo[axis] = std::min(lo[axis], centre);
      hi[axis] = std::max(hi[axis], centre);
    }
  }
  const float size = std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]});
  constexpr auto LastCell = static_cast<float>((1u << MortonBits) - 1);
  for (Place& place : places) {
    for (int axis = 0; axis < 3 && size > 0; ++axis) {
      const float cell = (place.centre[axis] - lo[axis]) / size * LastCell;
      place.code |= spread_bits(static_cast<uint64_t>(cell)) << axis;
    }
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.code != b.code ? a.code < b.code : a.triangle < b.triangle;
  });
  codes_.resize(count);
  order_.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    codes_[i] = places[i].code;
    order_[i] = places[i].triangle;
  }
}

/// Where the highest bit that differs in [begin, end) changes; the middle where none does.
uint32_t Agglomerator::split(uint32_t begin, uint32_t end) const {
  const uint64_t last = codes_[end - 1];
  const uint64_t differing = codes_[begin] ^ last;
  if (differing == 0) return begin + (end - begin) / 2;
  const int bit = 63 - std::countl_zero(differing);
  const uint64_t first_of_upper = last >> bit << bit;
  return static_cast<uint32_t>(std::lower_bound(codes_.begin() + begin, codes_.begin() + end, first_of_upper) -
                               codes_.begin());
}

/// Leaves at most handed_on() clusters of the places [begin, end) at the end of pool_. The depth of the recursion is at
/// most the bits of a code and of a count.
void Agglomerator::cluster(uint32_t begin, uint32_t end) {
  const size_t base = pool_.size();
  if (end - begin <= ExactTriangles) {
    for (uint32_t place = begin; place < end; ++place) {
      pool_.push_back({triangle_box(order_[place]), 1, place, place});
    }
  } else {
    const uint32_t middle = split(begin, end);
    cluster(begin, middle);
    cluster(middle, end);
  }
  reduce(base, handed_on(end - begin));
}

/// Merges the closest two of pool_[base…) until at most `target` remain. Two that do not fit into one group are the
/// roots of finished subtrees, and both leave.
void Agglomerator::reduce(size_t base, uint32_t target) {
  if (pool_.size() - base <= target) return;
  Cluster* clusters = pool_.data() + base;
  Pairs pairs({clusters, pool_.size() - base});
  while (pairs.count() > target) {
    const auto [a, b] = pairs.closest();
    if (fits(clusters[a], clusters[b])) {
      clusters[a] = merge(clusters[a], clusters[b]);
      pairs.merged(a, b);
    } else {
      finished_.push_back(clusters[a]);
      finished_.push_back(clusters[b]);
      pairs.removed(a, b);
    }
  }
  pool_.resize(base + pairs.count());
}

bool Agglomerator::fits(const Cluster& a, const Cluster& b) {
  const uint32_t triangle_count = a.triangle_count + b.triangle_count;
  if (triangle_count > limits_.triangles) return false;
  if (triangle_count <= limits_.vertices / 3) return true;
  const uint32_t mark = ++mark_;
  return count_vertices(a, mark) + count_vertices(b, mark) <= limits_.vertices;
}

/// Vertices that do not bear the mark yet; they do afterwards.
uint32_t Agglomerator::count_vertices(const Cluster& cluster, uint32_t mark) {
  uint32_t count = 0;
  for (uint32_t place = cluster.first;; place = next_[place]) {
    for (uint32_t corner = 0; corner < 3; ++corner) {
      uint32_t& seen = marks_[indices_[3 * size_t{order_[place]} + corner]];
      count += seen != mark ? 1 : 0;
      seen = mark;
    }
    if (place == cluster.last) return count;
  }
}

Agglomerator::Cluster Agglomerator::merge(const Cluster& a, const Cluster& b) {
  const Cluster& front = a.first < b.first ? a : b;
  const Cluster& back = a.first < b.first ? b : a;
  next_[front.last] = back.first;
  Cluster both{front.box, a.triangle_count + b.triangle_count, front.first, back.last};
  for (int axis = 0; axis < 3; ++axis) {
    both.box.lo[axis] = std::min(both.box.lo[axis], back.box.lo[axis]);
    both.box.hi[axis] = std::max(both.box.hi[axis], back.box.hi[axis]);
  }
  return both;
}

/// Of the box around both. Squares keep the order, so no root is taken.
float Agglomerator::diagonal_squared(const Box& a, const Box& b) {
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = std::max(a.hi[axis], b.hi[axis]) - std::min(a.lo[axis], b.lo[axis]);
    sum += extent * extent;
  }
  return sum;
}

/// Groups along the Morton curve, the triangles of each in the order of their merges.
Groups Agglomerator::collect() const {
  std::vector<const Cluster*> sorted;
  sorted.reserve(finished_.size());
  for (const Cluster& cluster : finished_) sorted.push_back(&cluster);
  std::sort(sorted.begin(), sorted.end(), [](const Cluster* a, const Cluster* b) { return a->first < b->first; });
  Groups groups;
  groups.triangles.reserve(order_.size());
  groups.ends.reserve(sorted.size());
  for (const Cluster* cluster : sorted) {
    for (uint32_t place = cluster->first;; place = next_[place]) {
      groups.triangles.push_back(order_[place]);
      if (place == cluster->last) break;
    }
    groups.ends.push_back(static_cast<uint32_t>(groups.triangles.size()));
  }
  return groups;
}

}  // namespace umbrage::scene
