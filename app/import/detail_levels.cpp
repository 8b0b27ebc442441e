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

struct Simplifier {
  std::span<const glm::vec3> positions;
  std::vector<uint32_t> welded;   ///< Vertices that differ only in what shadows do not see are one.
  std::vector<uint32_t> simpler;  ///< Room for a result.

  Simplifier(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices)
      : positions(vertices), welded(indices.size()), simpler(indices.size()) {
    meshopt_generateShadowIndexBuffer(welded.data(), indices.data(), indices.size(), positions.data(), positions.size(),
                                      sizeof(glm::vec3), sizeof(glm::vec3));
  }
  float extent() const { return meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(glm::vec3)); }
  /// About so many indices, or more.
  std::span<const uint32_t> simplify(size_t indices) {
    const size_t made = meshopt_simplify(simpler.data(), welded.data(), welded.size(), &positions[0].x,
                                         positions.size(), sizeof(glm::vec3), indices, LargestError, 0, nullptr);
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
  const SurfaceTree surface(positions, simplifier.welded);
  const float least = LeastError * simplifier.extent();
  for (size_t before = indices.size(); before > LeastIndices;) {
    const std::span<const uint32_t> level = simplifier.simplify(before / 6 * 3);
    if (level.empty() || level.size() > before / 4 * 3) break;
    before = level.size();
    const float error = std::max(sampled_distance(positions, simplifier.welded, surface, level), least);
    while (levels.errors_m.size() > 1 && error <= levels.errors_m.back()) {  // Coarser, and no farther off.
      levels.first_index.pop_back();
      levels.errors_m.pop_back();
      levels.indices.resize(levels.first_index.back());
    }
    if (levels.errors_m.size() == umbrage::MaxMeshLevels) break;
    levels.indices.insert(levels.indices.end(), level.begin(), level.end());
    levels.first_index.push_back(static_cast<uint32_t>(levels.indices.size()));
    levels.errors_m.push_back(error);
  }
  return levels;
}

}  // namespace app
