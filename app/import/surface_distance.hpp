// How far two triangle meshes lie apart, from samples of one to the nearest triangle of the other.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace app {

/// A tree of boxes over the triangles of a mesh, for nearest points. The spans outlive it.
class SurfaceTree {
 public:
  /// indices: a triangle list with at least one triangle.
  SurfaceTree(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

  /// The squared distance from a point to the surface; or any that is not above `enough`, once one is found.
  float squared_distance(const glm::vec3& point, float enough) const;

 private:
  struct Node {
    glm::vec3 lo, hi;
    uint32_t first, count;  ///< Leaf: of order_. Else count = 0: children at first and first + 1.
  };
  void split(uint32_t node, uint32_t first, uint32_t count);

  std::span<const glm::vec3> positions_;
  std::span<const uint32_t> indices_;
  std::vector<uint32_t> order_;  ///< Triangles.
  std::vector<Node> nodes_;
};

/// The largest distance between a surface and a simpler one over some of the same vertices, from samples: the corners of the
/// former to the latter, points of the latter about as dense to the former. In between it may be a little more.
float sampled_distance(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                       const SurfaceTree& surface, std::span<const uint32_t> simpler);

}  // namespace app
