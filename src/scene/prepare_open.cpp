// Reads prepared bytes in place. They may come from a disk, so nothing in them is believed before it is checked.
#include <cmath>
#include <cstring>
#include <new>
#include <string>

#include "scene/prepare_format.hpp"
#include "umbrage/prepare.hpp"

namespace umbrage {
namespace {

using scene::PreparedHeader;
using scene::PreparedLayout;

Error refused(const std::string& what) {
  return {ErrorCode::invalid_argument, "prepared bytes: " + what + "; prepare the mesh again"};
}

bool within(uint32_t value, uint32_t least, uint32_t most) { return value >= least && value <= most; }

Result<void> check_header(const PreparedHeader& header, std::span<const std::byte> bytes) {
  if (header.magic != scene::PreparedMagic) return refused("not from prepare_mesh");
  if (header.version != scene::PreparedVersion) {
    return refused("version " + std::to_string(header.version) + ", this is " + std::to_string(scene::PreparedVersion));
  }
  if (header.zero != 0 ||
      !within(header.settings.batch_triangles, scene::MinBatchTriangles, scene::MaxBatchTriangles) ||
      !within(header.settings.batch_vertices, scene::MinBatchVertices, scene::MaxBatchVertices)) {
    return refused("a setting is out of range");
  }
  const uint64_t expected = PreparedLayout(header).end;
  if (bytes.size() != expected) {
    return refused(std::to_string(bytes.size()) + " bytes where the header says " + std::to_string(expected));
  }
  if (header.checksum != scene::checksum(bytes)) return refused("the checksum differs");
  return {};
}

bool is_box(const Aabb& box) {
  const auto ordered = [](float lo, float hi) { return std::isfinite(lo) && std::isfinite(hi) && lo <= hi; };
  return ordered(box.min.x, box.max.x) && ordered(box.min.y, box.max.y) && ordered(box.min.z, box.max.z);
}

/// Batches follow each other through the triangles and vertices, and use all of both.
Result<void> check_batches(const PreparedHeader& header, const PreparedMesh& mesh) {
  uint64_t triangles = 0, vertices = 0;
  for (size_t i = 0; i < mesh.batches.size(); ++i) {
    const PreparedBatch& batch = mesh.batches[i];
    const bool right = batch.first_triangle == triangles && batch.first_vertex == vertices &&
                       within(batch.triangle_count, 1, header.settings.batch_triangles) &&
                       within(batch.vertex_count, 1, header.settings.batch_vertices) &&
                       batch.submesh < header.submesh_count && is_box(batch.bounds);
    if (!right) return refused("batch " + std::to_string(i) + " is out of range");
    triangles += batch.triangle_count;
    vertices += batch.vertex_count;
  }
  if (triangles != header.triangle_count || vertices != header.vertex_count) {
    return refused("batches do not cover the triangles and vertices");
  }
  for (const uint32_t vertex : mesh.vertices) {
    if (vertex >= header.mesh_vertex_count) return refused("a vertex is out of range");
  }
  return {};
}

/// Precondition: check_batches.
template <class Index>
Result<void> check_local_indices(std::span<const PreparedBatch> batches, std::span<const Index> local_indices) {
  for (const PreparedBatch& batch : batches) {
    for (const Index local :
         local_indices.subspan(3 * size_t{batch.first_triangle}, 3 * size_t{batch.triangle_count})) {
      if (local >= batch.vertex_count) return refused("a local index is out of range");
    }
  }
  return {};
}

template <class T>
std::span<const T> section(std::span<const std::byte> bytes, uint64_t begin, uint64_t end) {
  return {reinterpret_cast<const T*>(bytes.data() + begin), (end - begin) / sizeof(T)};
}

Result<PreparedMesh> open(std::span<const std::byte> bytes) {
  if (reinterpret_cast<uintptr_t>(bytes.data()) % alignof(PreparedBatch) != 0) {
    return Error{ErrorCode::invalid_argument, "prepared bytes: they must lie at a multiple of 4 in memory"};
  }
  PreparedHeader header;
  if (bytes.size() < sizeof(header)) return refused("shorter than their header");
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (auto result = check_header(header, bytes); !result) return result.error();

  const PreparedLayout layout(header);
  PreparedMesh mesh;
  mesh.batches = section<PreparedBatch>(bytes, layout.batches, layout.vertices);
  mesh.vertices = section<uint32_t>(bytes, layout.vertices, layout.local_indices);
  if (layout.wide) {
    mesh.wide_indices = section<uint16_t>(bytes, layout.local_indices, layout.end);
  } else {
    mesh.local_indices = section<uint8_t>(bytes, layout.local_indices, layout.end);
  }
  mesh.key = header.key;
  mesh.settings = header.settings;
  mesh.mesh_vertex_count = header.mesh_vertex_count;
  mesh.submesh_count = header.submesh_count;

  if (auto result = check_batches(header, mesh); !result) return result.error();
  auto result = layout.wide ? check_local_indices(mesh.batches, mesh.wide_indices)
                            : check_local_indices(mesh.batches, mesh.local_indices);
  if (!result) return result.error();
  return mesh;
}

}  // namespace

Result<PreparedMesh> open_prepared(std::span<const std::byte> bytes) {
  try {
    return open(bytes);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory, "open_prepared"};  // So short that the message needs no memory either.
  }
}

}  // namespace umbrage
