// Triangles → batches as bytes: checks the mesh, groups each submesh's triangles, gives every batch its own vertices.
#include "umbrage/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <string>

#include "scene/agglomerate.hpp"
#include "scene/prepare_format.hpp"

namespace umbrage {
namespace {

using scene::PreparedHeader;
using scene::PreparedLayout;

struct Mesh {
  std::span<const Vec3> positions;
  std::span<const uint32_t> indices;
  std::span<const Submesh> submeshes;
};

Error refused(std::string what) { return {ErrorCode::invalid_argument, "prepare_mesh: " + std::move(what)}; }

/// With the vertices that 0 stands for: two a triangle hold all but soups of triangles that share none.
PrepareSettings resolved(PrepareSettings settings) {
  if (settings.batch_vertices == 0)
    settings.batch_vertices = std::max(scene::NarrowVertices, 2 * settings.batch_triangles);
  return settings;
}

Result<void> check_settings(const PrepareSettings& settings) {
  const auto check = [](const char* name, uint32_t value, uint32_t least, uint32_t most) -> Result<void> {
    if (value >= least && value <= most) return {};
    return refused(std::string(name) + " is " + std::to_string(value) + "; it must be " + std::to_string(least) + "…" +
                   std::to_string(most));
  };
  if (auto result =
          check("batch_triangles", settings.batch_triangles, scene::MinBatchTriangles, scene::MaxBatchTriangles);
      !result) {
    return result;
  }
  return check("batch_vertices", settings.batch_vertices, scene::MinBatchVertices, scene::MaxBatchVertices);
}

Result<void> check_arrays(const Mesh& mesh) {
  constexpr size_t MaxCount = std::numeric_limits<uint32_t>::max();
  if (mesh.positions.size() > MaxCount || mesh.indices.size() > MaxCount || mesh.submeshes.size() > MaxCount) {
    return refused("more than 2^32 - 1 positions, indices or submeshes; split the mesh");
  }
  if (mesh.indices.size() % 3 != 0) {
    return refused(std::to_string(mesh.indices.size()) + " indices; a triangle list has a multiple of 3");
  }
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& p = mesh.positions[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    return refused("position " + std::to_string(i) + " is not finite");
  }
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    if (mesh.indices[i] < mesh.positions.size()) continue;
    return refused("index " + std::to_string(i) + " is " + std::to_string(mesh.indices[i]) + ", but there are " +
                   std::to_string(mesh.positions.size()) + " positions");
  }
  return {};
}

/// Each a range of whole triangles; together all indices, none twice.
Result<void> check_submeshes(const Mesh& mesh) {
  std::vector<uint32_t> by_first;
  by_first.reserve(mesh.submeshes.size());
  for (uint32_t i = 0; i < mesh.submeshes.size(); ++i) {
    const Submesh& submesh = mesh.submeshes[i];
    if (submesh.first_index % 3 != 0 || submesh.index_count % 3 != 0) {
      return refused("submesh " + std::to_string(i) + ": first_index and index_count must be multiples of 3");
    }
    if (uint64_t{submesh.first_index} + submesh.index_count > mesh.indices.size()) {
      return refused("submesh " + std::to_string(i) + " ends after the last of " + std::to_string(mesh.indices.size()) +
                     " indices");
    }
    if (submesh.index_count > 0) by_first.push_back(i);
  }
  std::sort(by_first.begin(), by_first.end(),
            [&](uint32_t a, uint32_t b) { return mesh.submeshes[a].first_index < mesh.submeshes[b].first_index; });
  uint32_t covered = 0;
  for (const uint32_t i : by_first) {
    const uint32_t first = mesh.submeshes[i].first_index;
    if (first < covered) return refused("submesh " + std::to_string(i) + " overlaps another");
    if (first > covered) break;
    covered += mesh.submeshes[i].index_count;
  }
  if (covered < mesh.indices.size()) return refused("no submesh covers index " + std::to_string(covered));
  return {};
}

Result<void> check(const Mesh& mesh, const PrepareSettings& settings) {
  if (auto result = check_settings(settings); !result) return result;
  if (auto result = check_arrays(mesh); !result) return result;
  return check_submeshes(mesh);
}

/// Collects batches and turns them into bytes.
class Writer {
 public:
  Writer(const Mesh& mesh, const PrepareSettings& settings) : mesh_(mesh), local_of_(mesh.positions.size(), NoLocal) {
    header_.settings = settings;
    header_.mesh_vertex_count = static_cast<uint32_t>(mesh.positions.size());
    header_.submesh_count = static_cast<uint32_t>(mesh.submeshes.size());
    local_indices_.reserve(mesh.indices.size());
  }

  /// triangles: of the submesh's indices.
  void add_batch(uint32_t submesh, std::span<const uint32_t> indices, std::span<const uint32_t> triangles) {
    PreparedBatch batch;
    batch.submesh = submesh;
    batch.first_triangle = static_cast<uint32_t>(local_indices_.size() / 3);
    batch.triangle_count = static_cast<uint32_t>(triangles.size());
    batch.first_vertex = static_cast<uint32_t>(vertices_.size());
    for (const uint32_t triangle : triangles) {
      for (const uint32_t vertex : indices.subspan(3 * size_t{triangle}, 3)) add_corner(vertex, batch.first_vertex);
    }
    const auto own = std::span(vertices_).subspan(batch.first_vertex);
    batch.vertex_count = static_cast<uint32_t>(own.size());
    batch.bounds = bounds(own);
    for (const uint32_t vertex : own) local_of_[vertex] = NoLocal;
    batches_.push_back(batch);
  }

  std::vector<std::byte> bytes(uint64_t key) {
    header_.key = key;
    header_.batch_count = static_cast<uint32_t>(batches_.size());
    header_.vertex_count = static_cast<uint32_t>(vertices_.size());
    header_.triangle_count = static_cast<uint32_t>(local_indices_.size() / 3);
    const PreparedLayout layout(header_);
    std::vector<std::byte> bytes(layout.end);
    const auto put = [&](uint64_t offset, std::span<const std::byte> from) {
      if (!from.empty()) std::memcpy(bytes.data() + offset, from.data(), from.size());
    };
    put(layout.batches, std::as_bytes(std::span(batches_)));
    put(layout.vertices, std::as_bytes(std::span(vertices_)));
    if (layout.wide) {
      put(layout.local_indices, std::as_bytes(std::span(local_indices_)));
    } else {
      std::transform(local_indices_.begin(), local_indices_.end(),
                     bytes.begin() + static_cast<ptrdiff_t>(layout.local_indices),
                     [](uint16_t local) { return static_cast<std::byte>(local); });
    }
    put(0, std::as_bytes(std::span(&header_, 1)));
    header_.checksum = scene::checksum(bytes);
    put(0, std::as_bytes(std::span(&header_, 1)));
    return bytes;
  }

 private:
  static constexpr uint16_t NoLocal = 0xffff;

  void add_corner(uint32_t vertex, uint32_t first_vertex) {
    uint16_t& local = local_of_[vertex];
    if (local == NoLocal) {
      local = static_cast<uint16_t>(vertices_.size() - first_vertex);
      vertices_.push_back(vertex);
    }
    local_indices_.push_back(local);
  }

  Aabb bounds(std::span<const uint32_t> vertices) const {
    Aabb box{mesh_.positions[vertices[0]], mesh_.positions[vertices[0]]};
    for (const uint32_t vertex : vertices) {
      const Vec3& p = mesh_.positions[vertex];
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
    }
    return box;
  }

  Mesh mesh_;
  PreparedHeader header_;
  std::vector<uint16_t> local_of_;  ///< Mesh vertex → its place in the batch at work.
  std::vector<PreparedBatch> batches_;
  std::vector<uint32_t> vertices_;
  std::vector<uint16_t> local_indices_;
};

std::vector<std::byte> prepare(const Mesh& mesh, const PrepareSettings& settings, uint64_t key) {
  scene::Agglomerator agglomerator(mesh.positions);
  Writer writer(mesh, settings);
  for (uint32_t s = 0; s < mesh.submeshes.size(); ++s) {
    const auto indices = mesh.indices.subspan(mesh.submeshes[s].first_index, mesh.submeshes[s].index_count);
    const scene::Groups groups = agglomerator.group(indices, {settings.batch_triangles, settings.batch_vertices});
    uint32_t begin = 0;
    for (const uint32_t end : groups.ends) {
      writer.add_batch(s, indices, std::span(groups.triangles).subspan(begin, end - begin));
      begin = end;
    }
  }
  return writer.bytes(key);
}

/// Without submeshes a mesh is one.
Submesh whole(std::span<const uint32_t> indices) { return {.index_count = static_cast<uint32_t>(indices.size())}; }

}  // namespace

Result<std::vector<std::byte>> prepare_mesh(std::span<const Vec3> positions, std::span<const uint32_t> indices,
                                            std::span<const Submesh> submeshes, const PrepareSettings& wanted) {
  try {
    const PrepareSettings settings = resolved(wanted);
    const Submesh all = whole(indices);
    const Mesh mesh{positions, indices, submeshes.empty() ? std::span(&all, 1) : submeshes};
    if (auto result = check(mesh, settings); !result) return result.error();
    return prepare(mesh, settings, prepare_key(positions, indices, submeshes, settings));
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory, "prepare_mesh"};  // So short that the message needs no memory either.
  }
}

uint64_t prepare_key(std::span<const Vec3> positions, std::span<const uint32_t> indices,
                     std::span<const Submesh> submeshes, const PrepareSettings& wanted) {
  const PrepareSettings settings = resolved(wanted);
  uint64_t hash = scene::hash_bytes(scene::PreparedVersion, std::as_bytes(std::span(&settings, 1)));
  hash = scene::hash_bytes(hash, std::as_bytes(positions));
  hash = scene::hash_bytes(hash, std::as_bytes(indices));
  // Only what bounds the batches: masks and cutoffs may change without preparing anew.
  const Submesh all = whole(indices);
  for (const Submesh& submesh : submeshes.empty() ? std::span(&all, 1) : submeshes) {
    const uint32_t range[2] = {submesh.first_index, submesh.index_count};
    hash = scene::hash_bytes(hash, std::as_bytes(std::span(range)));
  }
  return hash;
}

}  // namespace umbrage
