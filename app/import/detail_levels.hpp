// Levels of detail of a mesh for shadow maps: fewer triangles over the same vertices, each level with its error.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "umbrage/scene.hpp"

namespace app {

/// Meshes of no more indices have one level: they do not fill a batch.
inline constexpr size_t MostUnsimplifiedIndices = 3 * 64;

struct DetailLevels {
  std::vector<uint32_t> indices;      ///< Of all levels, the finest first: those that were given.
  std::vector<uint32_t> first_index;  ///< Of each level, and where the last one ends.
  std::vector<float> errors_m;        ///< Mesh space: how far a level's surface lies from the finest; 0, then rising.
};

/// A mesh without coarser levels.
DetailLevels one_detail_level(std::span<const uint32_t> indices);

/// positions: mesh space; indices: a triangle list. Each level has about half of the triangles of the one before, three quarters at
/// most; its error is measured at samples (surface_distance.hpp). Small meshes, and all where meshoptimizer is not installed, have one level. Deterministic.
DetailLevels make_detail_levels(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

/// A name for the levels of a mesh: a hash of what make_detail_levels is given.
uint64_t detail_levels_key(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);
/// For a file: versioned, with a checksum.
std::vector<std::byte> bytes_of(const DetailLevels&, uint64_t key);
/// What bytes_of was given; nothing unless the bytes are whole, of this key, and levels of such a mesh.
std::optional<DetailLevels> detail_levels_of(std::span<const std::byte> bytes, uint64_t key, size_t position_count,
                                             std::span<const uint32_t> indices);

}  // namespace app
