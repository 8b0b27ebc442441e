// Simplified by meshoptimizer, measured by samples: the simplifier's own estimate is a mean, and half of the levels of hall are off
// by 1.5 times as much somewhere.
#include "import/detail_levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>

#include "import/surface_distance.hpp"

namespace app {
namespace {

constexpr size_t LeastIndices = 3 * 64;  ///< Of fewer nothing is gained: they do not fill a batch.
constexpr float LargestError = 0.1f;     ///< Of the mesh's extent, as the simplifier estimates it.
constexpr float LeastError = 1e-6f;      ///< Likewise: what roundings may make of none.

/// Vertices that differ only in what shadows do not see are one: the simplifier keeps those where many meet, even when all but one
/// of them are unused.
struct Simplifier {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  std::vector<uint32_t> vertices;  ///< Of the mesh, by position.
  std::vector<uint32_t> simpler;   ///< Room for a result.

  Simplifier(std::span<const glm::vec3> all, std::span<const uint32_t> triangles)
      : indices(triangles.size()), simpler(triangles.size()) {
    std::vector<glm::vec3> plain(all.begin(), all.end());
    for (glm::vec3& position : plain) position += glm::vec3(0);  // -0 becomes 0: bits are compared.
    std::vector<uint32_t> welded(plain.size());
    positions.resize(meshopt_generateVertexRemap(welded.data(), triangles.data(), triangles.size(), plain.data(),
                                                 plain.size(), sizeof(glm::vec3)));
    vertices.resize(positions.size());
    meshopt_remapVertexBuffer(positions.data(), plain.data(), plain.size(), sizeof(glm::vec3), welded.data());
    meshopt_remapIndexBuffer(indices.data(), triangles.data(), triangles.size(), welded.data());
    for (size_t i = 0; i < triangles.size(); ++i) vertices[indices[i]] = triangles[i];
  }
  float extent() const { return meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(glm::vec3)); }
  /// About so many indices, or more.
  std::span<const uint32_t> simplify(size_t count) {
    const size_t made = meshopt_simplify(simpler.data(), indices.data(), indices.size(), &positions[0].x,
                                         positions.size(), sizeof(glm::vec3), count, LargestError, 0, nullptr);
    return {simpler.data(), made};
  }
};

}  // namespace

DetailLevels one_detail_level(std::span<const uint32_t> indices) {
  return {.indices = {indices.begin(), indices.end()},
          .first_index = {0, static_cast<uint32_t>(indices.size())},
          .errors_m = {0.0f}};
}

DetailLevels make_detail_levels(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
  DetailLevels levels = one_detail_level(indices);
  if (indices.size() <= LeastIndices) return levels;
  Simplifier simplifier(positions, indices);
  const SurfaceTree surface(simplifier.positions, simplifier.indices);
  const float least = LeastError * simplifier.extent();
  for (size_t before = indices.size(); before > LeastIndices;) {
    const std::span<const uint32_t> level = simplifier.simplify(before / 6 * 3);
    if (level.empty() || level.size() > before / 4 * 3) break;
    before = level.size();
    const float error = std::max(sampled_distance(simplifier.positions, simplifier.indices, surface, level), least);
    while (levels.errors_m.size() > 1 && error <= levels.errors_m.back()) {  // Coarser, and no farther off.
      levels.first_index.pop_back();
      levels.errors_m.pop_back();
      levels.indices.resize(levels.first_index.back());
    }
    if (levels.errors_m.size() == umbrage::MaxMeshLevels) break;
    for (const uint32_t index : level) levels.indices.push_back(simplifier.vertices[index]);
    levels.first_index.push_back(static_cast<uint32_t>(levels.indices.size()));
    levels.errors_m.push_back(error);
  }
  return levels;
}

}  // namespace app
