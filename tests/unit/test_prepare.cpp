// prepare_mesh: what holds for every mesh, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "prepare_meshes.hpp"
#include "umbrage/prepare.hpp"

namespace test {
namespace {

using umbrage::PreparedBatch;
using umbrage::PreparedMesh;
using umbrage::PrepareSettings;
using umbrage::Submesh;
using umbrage::Vec3;

using Corners = std::array<uint32_t, 4>;  // Submesh and three vertices.

umbrage::Result<std::vector<std::byte>> prepare(const TriangleMesh& mesh, const PrepareSettings& settings = {}) {
  return umbrage::prepare_mesh(mesh.positions, mesh.indices, mesh.submeshes, settings);
}

uint64_t key(const TriangleMesh& mesh, const PrepareSettings& settings = {}) {
  return umbrage::prepare_key(mesh.positions, mesh.indices, mesh.submeshes, settings);
}

std::vector<Corners> triangles_of(const TriangleMesh& mesh) {
  std::vector<Submesh> submeshes = mesh.submeshes;
  if (submeshes.empty()) submeshes = {{.index_count = static_cast<uint32_t>(mesh.indices.size())}};
  std::vector<Corners> result;
  for (uint32_t s = 0; s < submeshes.size(); ++s) {
    for (uint32_t i = 0; i < submeshes[s].index_count; i += 3) {
      const uint32_t* corner = &mesh.indices[submeshes[s].first_index + i];
      result.push_back({s, corner[0], corner[1], corner[2]});
    }
  }
  return result;
}

std::vector<Corners> triangles_of(const PreparedMesh& mesh) {
  std::vector<Corners> result;
  for (const PreparedBatch& batch : mesh.batches) {
    for (uint32_t t = 0; t < batch.triangle_count; ++t) {
      Corners corners{batch.submesh};
      for (uint32_t i = 0; i < 3; ++i) {
        const size_t at = 3 * (size_t{batch.first_triangle} + t) + i;
        const uint32_t local = mesh.wide_indices.empty() ? mesh.local_indices[at] : mesh.wide_indices[at];
        corners[i + 1] = mesh.vertices[batch.first_vertex + local];
      }
      result.push_back(corners);
    }
  }
  return result;
}

void expect_tight(const TriangleMesh& mesh, const PreparedBatch& batch, std::span<const uint32_t> vertices) {
  constexpr float Infinity = std::numeric_limits<float>::infinity();
  Vec3 lo{Infinity, Infinity, Infinity}, hi{-Infinity, -Infinity, -Infinity};
  for (const uint32_t vertex : vertices) {
    const Vec3& p = mesh.positions[vertex];
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  EXPECT_TRUE(lo.x == batch.bounds.min.x && lo.y == batch.bounds.min.y && lo.z == batch.bounds.min.z) << mesh.name;
  EXPECT_TRUE(hi.x == batch.bounds.max.x && hi.y == batch.bounds.max.y && hi.z == batch.bounds.max.z) << mesh.name;
}

/// Every triangle once, in its submesh, with its winding; limits held; vertices of a batch distinct and all used; boxes exact.
void expect_right(const TriangleMesh& mesh, const PrepareSettings& settings) {
  const auto bytes = prepare(mesh, settings);
  ASSERT_TRUE(bytes.ok()) << mesh.name << ": " << bytes.error().message;
  const auto prepared = umbrage::open_prepared(*bytes);
  ASSERT_TRUE(prepared.ok()) << mesh.name << ": " << prepared.error().message;

  std::vector<Corners> expected = triangles_of(mesh), found = triangles_of(*prepared);
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(expected, found) << mesh.name;

  const uint32_t most_vertices =
      settings.batch_vertices ? settings.batch_vertices : std::max(256u, 2 * settings.batch_triangles);
  for (const PreparedBatch& batch : prepared->batches) {
    EXPECT_TRUE(batch.triangle_count >= 1 && batch.triangle_count <= settings.batch_triangles) << mesh.name;
    EXPECT_LE(batch.vertex_count, most_vertices) << mesh.name;
    const auto vertices = prepared->vertices.subspan(batch.first_vertex, batch.vertex_count);
    EXPECT_EQ(std::set(vertices.begin(), vertices.end()).size(), vertices.size()) << mesh.name;
    expect_tight(mesh, batch, vertices);
  }
  std::set<std::pair<size_t, uint32_t>> used;
  const std::vector<Corners> in_order = triangles_of(*prepared);
  for (size_t b = 0, t = 0; b < prepared->batches.size(); ++b) {
    for (uint32_t i = 0; i < prepared->batches[b].triangle_count; ++i, ++t) {
      for (uint32_t corner = 1; corner < 4; ++corner) used.emplace(b, in_order[t][corner]);
    }
  }
  EXPECT_EQ(used.size(), prepared->vertices.size()) << mesh.name;

  EXPECT_EQ(prepared->key, key(mesh, settings));
  EXPECT_EQ(prepared->settings.batch_triangles, settings.batch_triangles);
  EXPECT_EQ(prepared->settings.batch_vertices, most_vertices);
  EXPECT_EQ(prepared->mesh_vertex_count, mesh.positions.size());
  EXPECT_EQ(prepared->submesh_count, std::max<size_t>(1, mesh.submeshes.size()));
  EXPECT_TRUE(prepared->local_indices.empty() || prepared->wide_indices.empty());
  EXPECT_EQ(*bytes, *prepare(mesh, settings)) << mesh.name << " differs from run to run";
}

std::vector<PrepareSettings> settings_to_try() {
  return {{}, {32, 96}, {32, 3072}, {1024, 96}, {1024, 256}, {1024, 257}, {1024}, {1024, 3072}};
}

TEST(PrepareMesh, KeepsEveryTriangleWithinTheLimits) {
  for (const PrepareSettings& settings : settings_to_try()) {
    expect_right(wavy_grid(60, 45), settings);
    for (uint32_t seed = 0; seed < 4; ++seed) expect_right(soup(500 + 700 * seed, seed), settings);
  }
}

TEST(PrepareMesh, NeverMixesSubmeshes) {
  for (const PrepareSettings& settings : settings_to_try()) {
    for (uint32_t seed = 0; seed < 6; ++seed) expect_right(soup_of_submeshes(900, 2 + seed, seed), settings);
  }
}

TEST(PrepareMesh, HandlesAdversarialMeshes) {
  for (const PrepareSettings& settings : settings_to_try()) {
    for (const TriangleMesh& mesh : adversarial_meshes(1500)) expect_right(mesh, settings);
  }
}

TEST(PrepareMesh, NeedsNoTrianglesAndNoVertices) {
  const auto bytes = prepare({});
  ASSERT_TRUE(bytes.ok());
  const auto prepared = umbrage::open_prepared(*bytes);
  ASSERT_TRUE(prepared.ok()) << prepared.error().message;
  EXPECT_TRUE(prepared->batches.empty() && prepared->vertices.empty() && prepared->local_indices.empty());
}

TEST(PrepareMesh, UsesWideIndicesForManyVerticesOnly) {
  const auto narrow = prepare(wavy_grid(40, 40), {1024, 256}), wide = prepare(wavy_grid(40, 40), {1024, 3072});
  EXPECT_TRUE(umbrage::open_prepared(*narrow)->wide_indices.empty());
  EXPECT_TRUE(umbrage::open_prepared(*wide)->local_indices.empty());
  EXPECT_EQ(umbrage::open_prepared(*wide)->wide_indices.size(), size_t{40} * 40 * 6);
}

// Vertices must not be what ends a batch: with as many as the setting gives by itself, large batches fill as far as with the
// most there can be, and the default stays narrow.
TEST(PrepareMesh, GivesLargeBatchesTheVerticesToFill) {
  const TriangleMesh mesh = wavy_grid(90, 90);
  for (const uint32_t triangles : {256u, 512u, 1024u}) {
    const auto own = prepare(mesh, {triangles}), most = prepare(mesh, {triangles, 3072}),
               few = prepare(mesh, {triangles, 96});
    const size_t batches = umbrage::open_prepared(*own)->batches.size();
    EXPECT_EQ(batches, umbrage::open_prepared(*most)->batches.size()) << triangles;
    EXPECT_LT(batches, umbrage::open_prepared(*few)->batches.size()) << triangles;
    EXPECT_TRUE(umbrage::open_prepared(*own)->local_indices.empty()) << triangles;
  }
  EXPECT_EQ(umbrage::open_prepared(*prepare(mesh))->settings.batch_vertices, 256u);
  EXPECT_TRUE(umbrage::open_prepared(*prepare(mesh))->wide_indices.empty());
  EXPECT_EQ(key(mesh), key(mesh, {128, 256}));
  EXPECT_EQ(key(mesh, {512}), key(mesh, {512, 1024}));
}

// Diagonals of coordinates near the largest float must not overflow into ties: four corners stay apart.
TEST(PrepareMesh, TellsHugeDistancesApart) {
  TriangleMesh mesh;
  for (uint32_t t = 0; t < 120; ++t) {
    const float corner = t % 2 == 0 ? -3e38f : 3e38f;
    for (const float step : {0.0f, 1e33f, 2e33f}) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back({corner + step * static_cast<float>(t), corner, -corner});
    }
  }
  const auto bytes = prepare(mesh, {64, 256});
  const auto prepared = umbrage::open_prepared(*bytes);
  EXPECT_EQ(prepared->batches.size(), 2u);
  for (const PreparedBatch& batch : prepared->batches) EXPECT_EQ(batch.bounds.min.y, batch.bounds.max.y);
}

TEST(PrepareKey, FollowsWhatBatchesDependOn) {
  const TriangleMesh mesh = soup_of_submeshes(50, 3, 1);
  std::set<uint64_t> keys{key(mesh), key(mesh, {64, 256}), key(mesh, {128, 255})};
  TriangleMesh changed = mesh;
  changed.positions.back().z += 1e-3f;
  keys.insert(key(changed));
  changed = mesh;
  std::swap(changed.indices[0], changed.indices[1]);
  keys.insert(key(changed));
  changed = mesh;
  changed.submeshes.pop_back();
  keys.insert(key(changed));
  EXPECT_EQ(keys.size(), 6u);

  changed = mesh;
  changed.submeshes[0].mask = {7};
  changed.submeshes[0].alpha_cutoff = 0.25f;
  EXPECT_EQ(key(changed), key(mesh));
  const TriangleMesh grid = wavy_grid(3, 3);
  EXPECT_EQ(key(grid), umbrage::prepare_key(grid.positions, grid.indices, std::vector<Submesh>{{0, 54}}, {}));
}

void expect_refused(const TriangleMesh& mesh, const PrepareSettings& settings, const std::string& part) {
  const auto result = prepare(mesh, settings);
  ASSERT_FALSE(result.ok()) << part;
  EXPECT_EQ(result.error().code, umbrage::ErrorCode::invalid_argument);
  EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
}

TEST(PrepareMesh, RefusesWhatIsNotATriangleList) {
  TriangleMesh mesh = wavy_grid(2, 2);
  mesh.indices.pop_back();
  expect_refused(mesh, {}, "23 indices");
  mesh = wavy_grid(2, 2);
  mesh.indices[17] = 9;
  expect_refused(mesh, {}, "index 17 is 9, but there are 9 positions");
  mesh = wavy_grid(2, 2);
  for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    mesh.positions[4].y = bad;
    expect_refused(mesh, {}, "position 4 is not finite");
  }
}

TEST(PrepareMesh, RefusesSettingsOutOfRange) {
  const TriangleMesh mesh = wavy_grid(2, 2);
  for (const uint32_t triangles : {0u, 31u, 1025u, ~0u}) expect_refused(mesh, {triangles, 256}, "batch_triangles");
  for (const uint32_t vertices : {1u, 95u, 3073u, ~0u}) expect_refused(mesh, {128, vertices}, "batch_vertices");
}

TEST(PrepareMesh, RefusesSubmeshesThatAreNotAPartition) {
  TriangleMesh mesh = wavy_grid(2, 2);  // 24 indices.
  const auto refused = [&](std::vector<Submesh> submeshes, const std::string& part) {
    mesh.submeshes = std::move(submeshes);
    expect_refused(mesh, {}, part);
  };
  refused({{0, 12}, {9, 15}}, "submesh 1 overlaps");
  refused({{9, 15}, {0, 12}}, "submesh 0 overlaps");
  refused({{0, 24}, {0, 24}}, "overlaps");
  refused({{0, 12}, {15, 9}}, "no submesh covers index 12");
  refused({{3, 21}}, "no submesh covers index 0");
  refused({{0, 0}}, "no submesh covers index 0");
  refused({{0, 27}}, "submesh 0 ends after");
  refused({{0, 24}, {0xfffffffc, 6}}, "submesh 1 ends after");
  refused({{0, 23}}, "multiples of 3");
  refused({{1, 3}}, "multiples of 3");
}

}  // namespace
}  // namespace test
