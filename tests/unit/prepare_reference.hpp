// Ways to make groups of triangles that are plain enough to be believed, for comparison with scene/agglomerate.hpp.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "prepare_meshes.hpp"
#include "scene/agglomerate.hpp"

namespace test {

using TriangleGroups = std::vector<std::vector<uint32_t>>;

/// The rule itself: again and again the two clusters with the smallest merged diagonal; they merge if they fit into one
/// group, else both are finished. O(n³).
TriangleGroups exact_groups(const TriangleMesh&, const umbrage::scene::GroupLimits&);
/// The whole tree of Olsson et al. 2014, 5.2.1, cut into the largest subtrees within the limits. O(n³).
TriangleGroups exact_tree_cut(const TriangleMesh&, const umbrage::scene::GroupLimits&);
/// Runs of the input's order.
TriangleGroups index_chunks(const TriangleMesh&, const umbrage::scene::GroupLimits&);
/// Runs along the Morton curve of the triangles' box centres.
TriangleGroups morton_chunks(const TriangleMesh&, const umbrage::scene::GroupLimits&);
/// What is under test.
TriangleGroups agglomerated(const TriangleMesh&, const umbrage::scene::GroupLimits&);

struct GroupQuality {
  double mean_diagonal = 0;  ///< Of the box that a triangle's group has, over the triangles.
  double mean_fill = 0;      ///< Triangles of a group over the limit.
};
GroupQuality quality(const TriangleMesh&, const TriangleGroups&, const umbrage::scene::GroupLimits&);

}  // namespace test
