// Groups triangles that lie close together: approximate agglomerative clustering (Gu et al. 2013, "Efficient BVH
// Construction via Approximate Agglomerative Clustering"), cut where a subtree would outgrow a batch.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "umbrage/types.hpp"

namespace umbrage::scene {

/// What a group may hold at most.
struct GroupLimits {
  uint32_t triangles = 128;  ///< At least 1.
  uint32_t vertices = 256;   ///< Distinct ones; at least 3.
};

/// Up to this many triangles the clustering is exact: every merge is of the two clusters whose merged box has the
/// smallest diagonal of all pairs.
inline constexpr uint32_t ExactTriangles = 20;

/// Groups as runs of a permutation of the triangles.
struct Groups {
  std::vector<uint32_t> triangles;  ///< Every triangle of the input once.
  std::vector<uint32_t> ends;       ///< Group g is triangles[ends[g - 1] … ends[g]), the first starts at 0.
};

/// Works on any number of triangle lists over one set of positions. Time is linear in the triangles, sorting aside,
/// whatever their places: the work at a node of the constraint tree is bounded by constants.
class Agglomerator {
 public:
  /// Positions are finite and outlive the object.
  explicit Agglomerator(std::span<const Vec3> positions);

  /// indices: a triangle list, each < positions.size(). Deterministic. Throws std::bad_alloc only.
  Groups group(std::span<const uint32_t> indices, const GroupLimits& limits);

 private:
  struct Box {
    float lo[3], hi[3];
  };
  struct Cluster {
    Box box;
    uint32_t triangle_count;
    uint32_t first, last;  ///< Ends of a list linked through next_; first is the smallest member.
  };
  class Pairs;

  void sort_triangles();
  Box triangle_box(uint32_t triangle) const;
  uint32_t split(uint32_t begin, uint32_t end) const;
  void cluster(uint32_t begin, uint32_t end);
  void reduce(size_t base, uint32_t target);
  bool fits(const Cluster& a, const Cluster& b);
  uint32_t count_vertices(const Cluster&, uint32_t mark);
  Cluster merge(const Cluster& a, const Cluster& b);
  static float diagonal_squared(const Box& a, const Box& b);
  Groups collect() const;

  std::span<const Vec3> positions_;
  float scale_ = 1;              ///< A power of two that brings the positions into -1…1, so that no square overflows.
  std::vector<uint32_t> marks_;  ///< Per position: the newest count that saw it.
  uint32_t mark_ = 0;

  // Of the list being grouped. A "place" is a triangle's index along the Morton curve.
  std::span<const uint32_t> indices_;
  GroupLimits limits_;
  std::vector<uint64_t> codes_;  ///< Per place.
  std::vector<uint32_t> order_;  ///< Place → triangle.
  std::vector<uint32_t> next_;   ///< Place → next place of the same cluster.
  std::vector<Cluster> pool_;    ///< Clusters that may still grow, those of the node at work last.
  std::vector<Cluster> finished_;
};

}  // namespace umbrage::scene
