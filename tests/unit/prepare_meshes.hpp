// Meshes for the tests of batches: a surface, a soup, and shapes that trip clustering up.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "umbrage/scene.hpp"

namespace test {

struct TriangleMesh {
  std::string name;
  std::vector<umbrage::Vec3> positions;
  std::vector<uint32_t> indices;
  std::vector<umbrage::Submesh> submeshes;  ///< Empty: one.
};

/// 2 · columns · rows triangles that share their vertices, in rows.
TriangleMesh wavy_grid(uint32_t columns, uint32_t rows);
/// The same with every vertex moved at random, so that no two distances are equal.
TriangleMesh rough_grid(uint32_t columns, uint32_t rows, uint32_t seed);
/// Separate triangles of very different sizes at random places of the unit cube.
TriangleMesh soup(uint32_t triangle_count, uint32_t seed);
/// A soup, sorted into that many submeshes given in a shuffled order, one of them empty.
TriangleMesh soup_of_submeshes(uint32_t triangle_count, uint32_t submesh_count, uint32_t seed);
/// No, one, coincident, degenerate, repeated, huge, tiny, chained… triangles; about triangle_count each.
std::vector<TriangleMesh> adversarial_meshes(uint32_t triangle_count);

}  // namespace test
