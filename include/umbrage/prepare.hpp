// Triangles → batches (O4): the offline step, free of Vulkan and of any ShadowSystem; thread-safe.
// Olsson et al. 2014, 5.2.1: bottom-up agglomerative clustering whose dissimilarity is the diagonal of the merged box.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "umbrage/result.hpp"
#include "umbrage/scene.hpp"

namespace umbrage {

struct PrepareSettings {
  uint32_t batch_triangles = 128;  ///< At most this many triangles a batch, 32…1024.
  uint32_t batch_vertices = 0;     ///< And this many distinct vertices, 96…3072; 0 = max(256, 2 batch_triangles), so that
                                   ///< batches fill. Above 256 local indices have 16 bits.
};

/// Positions (mesh space, finite), triangle-list indices (< positions.size()) and submeshes as in MeshDesc. A batch never
/// spans two submeshes. Triangles with a repeated index or without area stay (they cost nothing and keep counts true).
/// Deterministic: the same input gives the same bytes. The bytes are versioned and carry a hash of the input.
/// Errors: invalid_argument (index out of range, not finite, counts not multiples of 3, submeshes that overlap or leave out
/// indices, settings out of range), out_of_memory.
Result<std::vector<std::byte>> prepare_mesh(std::span<const Vec3> positions, std::span<const uint32_t> indices,
                                            std::span<const Submesh> submeshes, const PrepareSettings& settings);

/// A content hash of prepare_mesh's input: the name for a cache entry.
uint64_t prepare_key(std::span<const Vec3> positions, std::span<const uint32_t> indices,
                     std::span<const Submesh> submeshes, const PrepareSettings& settings);

/// One batch as seen in prepared bytes.
struct PreparedBatch {
  Aabb bounds;                 ///< Mesh space, of its vertices.
  uint32_t submesh = 0;        ///< Index into the submeshes.
  uint32_t first_triangle = 0; ///< Into PreparedMesh::local_indices, in triangles.
  uint32_t triangle_count = 0;
  uint32_t first_vertex = 0;   ///< Into PreparedMesh::vertices.
  uint32_t vertex_count = 0;
};

/// A view of prepared bytes; valid while they live.
struct PreparedMesh {
  std::span<const PreparedBatch> batches;
  std::span<const uint32_t> vertices;       ///< Mesh vertex index of each batch-local vertex.
  std::span<const uint8_t> local_indices;   ///< Three a triangle, or empty when wide.
  std::span<const uint16_t> wide_indices;   ///< Likewise for batches of more than 256 vertices.
  uint64_t key = 0;                         ///< prepare_key of what it was made from.
  PrepareSettings settings;                 ///< Likewise, never with 0; wide when batch_vertices > 256.
  uint32_t mesh_vertex_count = 0;           ///< Of that mesh; every element of vertices is below it.
  uint32_t submesh_count = 0;               ///< Of that mesh, 1 when it had none; every batch's submesh is below it.
};

/// Checks the bytes wholly (sizes, ranges, version, checksum) before handing out a view; never reads beyond them. They lie
/// at a multiple of 4 in memory. Errors: invalid_argument.
Result<PreparedMesh> open_prepared(std::span<const std::byte> bytes);

}  // namespace umbrage
