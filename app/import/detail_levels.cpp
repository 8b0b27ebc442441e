// Simplified by meshoptimizer, measured by samples: the simplifier's own estimate is a mean, and surfaces are off by twice as much
// somewhere.
#include "import/detail_levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "import/meshoptimizer_library.hpp"
#include "import/surface_distance.hpp"
#include "umbrage/prepare.hpp"

namespace app {
namespace {

constexpr float LargestError = 0.1f;  ///< Of the mesh's extent, as the simplifier estimates it.
constexpr float LeastError = 1e-6f;   ///< Likewise: what roundings may make of none.

/// Vertices that differ only in what shadows do not see are one: the simplifier keeps those where many meet, even when all but one
/// of them are unused.
struct Simplifier {
  const MeshoptimizerLibrary& library;
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  std::vector<uint32_t> vertices;  ///< Of the mesh, by position.

  Simplifier(const MeshoptimizerLibrary& loaded, std::span<const glm::vec3> all, std::span<const uint32_t> triangles)
      : library(loaded), indices(triangles.size()) {
    std::vector<glm::vec3> plain(all.begin(), all.end());
    for (glm::vec3& position : plain) position += glm::vec3(0);  // -0 becomes 0: bits are compared.
    std::vector<uint32_t> welded(plain.size());
    positions.resize(library.generate_vertex_remap(welded.data(), triangles.data(), triangles.size(), plain.data(),
                                                   plain.size(), sizeof(glm::vec3)));
    vertices.resize(positions.size());
    for (size_t i = 0; i < triangles.size(); ++i) {
      indices[i] = welded[triangles[i]];
      positions[indices[i]] = plain[triangles[i]];
      vertices[indices[i]] = triangles[i];
    }
  }
  float extent() const { return library.simplify_scale(&positions[0].x, positions.size(), sizeof(glm::vec3)); }
  /// About so many indices, or more.
  std::vector<uint32_t> simplify(size_t count, unsigned options) const {
    std::vector<uint32_t> simpler(indices.size());
    simpler.resize(library.simplify(simpler.data(), indices.data(), indices.size(), &positions[0].x, positions.size(),
                                    sizeof(glm::vec3), count, LargestError, options, nullptr));
    return simpler;
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
  if (indices.size() <= MostUnsimplifiedIndices) return levels;
  const MeshoptimizerLibrary* library = meshoptimizer_library();
  if (!library) return levels;
  Simplifier simplifier(*library, positions, indices);
  const SurfaceTree surface(simplifier.positions, simplifier.indices);
  const float least = LeastError * simplifier.extent();
  for (size_t before = indices.size(); before > MostUnsimplifiedIndices;) {
    // Borders that stay keep surfaces in shape and meshes together, and end up as all that is left.
    std::vector<uint32_t> level = simplifier.simplify(before / 6 * 3, meshopt_SimplifyLockBorder);
    if (level.size() > before / 4 * 3) level = simplifier.simplify(before / 6 * 3, 0);
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

namespace {

/// A file: this header, the errors, where levels begin and end, the indices of all levels but the finest.
struct Header {
  uint32_t version = 2 + (MESHOPTIMIZER_VERSION << 8);  ///< Raised when levels are made otherwise.
  uint32_t levels = 0;
  uint64_t key = 0;
  uint64_t hash = 0;  ///< Of what follows.
};

uint64_t hash_of(std::span<const uint32_t> words) { return umbrage::prepare_key({}, words, {}, {}); }

bool are_levels(const DetailLevels& levels, size_t position_count, size_t finest) {
  const auto& first = levels.first_index;
  if (first[0] != 0 || first[1] != finest || levels.errors_m[0] != 0) return false;
  for (size_t level = 1; level < levels.errors_m.size(); ++level) {
    if (!(levels.errors_m[level] > levels.errors_m[level - 1]) || !std::isfinite(levels.errors_m[level])) return false;
    if (first[level + 1] < first[level] || (first[level + 1] - first[level]) % 3 != 0) return false;
  }
  return levels.indices.size() == first.back() &&
         std::all_of(levels.indices.begin(), levels.indices.end(), [&](uint32_t i) { return i < position_count; });
}

}  // namespace

uint64_t detail_levels_key(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(uint32_t));
  std::vector<uint32_t> words(3 * positions.size() + 2);
  std::memcpy(words.data(), positions.data(), positions.size_bytes());
  const uint64_t triangles = hash_of(indices);
  std::memcpy(words.data() + 3 * positions.size(), &triangles, sizeof triangles);
  return hash_of(words);
}

std::vector<std::byte> bytes_of(const DetailLevels& levels, uint64_t key) {
  std::vector<uint32_t> words;
  for (const float error : levels.errors_m) words.push_back(std::bit_cast<uint32_t>(error));
  words.insert(words.end(), levels.first_index.begin(), levels.first_index.end());
  words.insert(words.end(), levels.indices.begin() + levels.first_index[1], levels.indices.end());
  const Header header{.levels = static_cast<uint32_t>(levels.errors_m.size()), .key = key, .hash = hash_of(words)};
  std::vector<std::byte> bytes(sizeof header + words.size() * sizeof(uint32_t));
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, words.data(), words.size() * sizeof(uint32_t));
  return bytes;
}

std::optional<DetailLevels> detail_levels_of(std::span<const std::byte> bytes, uint64_t key, size_t position_count,
                                             std::span<const uint32_t> indices) {
  Header header;
  if (bytes.size() < sizeof header || bytes.size() % sizeof(uint32_t) != 0) return {};
  std::memcpy(&header, bytes.data(), sizeof header);
  std::vector<uint32_t> words((bytes.size() - sizeof header) / sizeof(uint32_t));
  if (!words.empty()) std::memcpy(words.data(), bytes.data() + sizeof header, bytes.size() - sizeof header);
  if (header.version != Header{}.version || header.key != key || header.hash != hash_of(words)) return {};
  if (header.levels < 1 || header.levels > umbrage::MaxMeshLevels || words.size() < 2 * header.levels + 1) return {};
  DetailLevels levels;
  auto word = words.begin();
  for (uint32_t level = 0; level < header.levels; ++level) levels.errors_m.push_back(std::bit_cast<float>(*word++));
  levels.first_index.assign(word, word + header.levels + 1);
  levels.indices.assign(indices.begin(), indices.end());
  levels.indices.insert(levels.indices.end(), word + header.levels + 1, words.end());
  if (!are_levels(levels, position_count, indices.size())) return {};
  return levels;
}

}  // namespace app
