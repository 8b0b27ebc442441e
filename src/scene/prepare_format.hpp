// The bytes of a prepared mesh: a header, then batches, vertices and local indices without gaps. Little-endian.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "umbrage/prepare.hpp"

namespace umbrage::scene {

static_assert(std::endian::native == std::endian::little, "prepared bytes are read in place");

inline constexpr uint32_t PreparedMagic = 0x50424d55;  ///< "UMBP".
/// To be raised with every change of the bytes or of the clustering; keys hold it, so old cache entries are left behind.
inline constexpr uint32_t PreparedVersion = 1;
/// Batches with more vertices need 16-bit local indices.
inline constexpr uint32_t NarrowVertices = 256;

inline constexpr uint32_t MinBatchTriangles = 32, MaxBatchTriangles = 1024;
inline constexpr uint32_t MinBatchVertices = 96, MaxBatchVertices = 3072;

struct PreparedHeader {
  uint32_t magic = PreparedMagic;
  uint32_t version = PreparedVersion;
  uint64_t key = 0;       ///< prepare_key of the input.
  uint64_t checksum = 0;  ///< checksum() of all bytes.
  PrepareSettings settings;
  uint32_t mesh_vertex_count = 0;
  uint32_t submesh_count = 0;
  uint32_t batch_count = 0;
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
  uint32_t zero = 0;
};
static_assert(sizeof(PreparedHeader) == 56 && sizeof(PrepareSettings) == 8);
static_assert(sizeof(PreparedBatch) == 44 && alignof(PreparedBatch) == 4);

/// Byte offsets of the sections. 64 bits hold them for any header.
struct PreparedLayout {
  explicit PreparedLayout(const PreparedHeader& header)
      : wide(header.settings.batch_vertices > NarrowVertices),
        vertices(sizeof(PreparedHeader) + uint64_t{header.batch_count} * sizeof(PreparedBatch)),
        local_indices(vertices + uint64_t{header.vertex_count} * sizeof(uint32_t)),
        end(local_indices + uint64_t{header.triangle_count} * 3 * (wide ? sizeof(uint16_t) : sizeof(uint8_t))) {}

  bool wide;
  uint64_t batches = sizeof(PreparedHeader);
  uint64_t vertices, local_indices, end;
};

/// Continues a 64-bit hash over the bytes and their number. Not made against adversaries.
uint64_t hash_bytes(uint64_t hash, std::span<const std::byte> bytes);

/// A hash of prepared bytes, PreparedHeader::checksum taken as 0. Precondition: they hold a header.
uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace umbrage::scene
