// open_prepared: damaged bytes are refused, or are in range when the damage was sealed with a right checksum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "prepare_meshes.hpp"
#include "scene/prepare_format.hpp"
#include "umbrage/prepare.hpp"

namespace test {
namespace {

using umbrage::PreparedBatch;
using umbrage::PreparedMesh;
using umbrage::scene::PreparedHeader;
using umbrage::scene::PreparedLayout;
using Bytes = std::vector<std::byte>;

/// One of each kind: narrow, wide, and without triangles.
std::vector<Bytes> samples() {
  std::vector<Bytes> result;
  const TriangleMesh mesh = soup_of_submeshes(200, 4, 2);
  for (const umbrage::PrepareSettings& settings :
       {umbrage::PrepareSettings{32, 96}, umbrage::PrepareSettings{128, 300}}) {
    result.push_back(*umbrage::prepare_mesh(mesh.positions, mesh.indices, mesh.submeshes, settings));
  }
  result.push_back(*umbrage::prepare_mesh({}, {}, {}, {}));
  return result;
}

PreparedHeader header_of(const Bytes& bytes) {
  PreparedHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  return header;
}

void put(Bytes& bytes, uint64_t offset, const auto& value) {
  std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

void seal(Bytes& bytes) {
  if (bytes.size() < sizeof(PreparedHeader)) return;
  put(bytes, offsetof(PreparedHeader, checksum), umbrage::scene::checksum(bytes));
}

bool opens(const Bytes& bytes) { return umbrage::open_prepared(bytes).ok(); }

/// Follows every range and every index as a reader would.
void expect_in_range(const PreparedMesh& mesh) {
  for (const PreparedBatch& batch : mesh.batches) {
    ASSERT_LT(batch.submesh, mesh.submesh_count);
    ASSERT_TRUE(batch.bounds.min.x <= batch.bounds.max.x && std::isfinite(batch.bounds.max.x - batch.bounds.max.x));
    ASSERT_LE(uint64_t{batch.first_vertex} + batch.vertex_count, mesh.vertices.size());
    for (const uint32_t vertex : mesh.vertices.subspan(batch.first_vertex, batch.vertex_count)) {
      ASSERT_LT(vertex, mesh.mesh_vertex_count);
    }
    const size_t first = 3 * size_t{batch.first_triangle}, end = first + 3 * size_t{batch.triangle_count};
    ASSERT_LE(end, std::max(mesh.local_indices.size(), mesh.wide_indices.size()));
    for (size_t i = first; i < end; ++i) {
      ASSERT_LT(mesh.wide_indices.empty() ? mesh.local_indices[i] : mesh.wide_indices[i], batch.vertex_count);
    }
  }
}

void expect_refused_or_in_range(const Bytes& bytes) {
  const auto mesh = umbrage::open_prepared(bytes);
  if (mesh.ok()) expect_in_range(*mesh);
}

TEST(OpenPrepared, RefusesEverySingleFlippedBit) {
  for (const Bytes& whole : samples()) {
    ASSERT_TRUE(opens(whole));
    for (size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      Bytes bytes = whole;
      bytes[bit / 8] ^= std::byte{1} << (bit % 8);
      ASSERT_FALSE(opens(bytes)) << "bit " << bit;
    }
  }
}

TEST(OpenPrepared, StaysInRangeWhenFlippedBitsAreSealed) {
  for (const Bytes& whole : samples()) {
    for (size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      Bytes bytes = whole;
      bytes[bit / 8] ^= std::byte{1} << (bit % 8);
      seal(bytes);
      expect_refused_or_in_range(bytes);
    }
  }
}

TEST(OpenPrepared, RefusesEveryOtherLength) {
  for (const Bytes& whole : samples()) {
    for (size_t size = 0; size <= whole.size() + 9; ++size) {
      if (size == whole.size()) continue;
      Bytes bytes = whole;
      bytes.resize(size);
      bytes.shrink_to_fit();  // So that the address sanitizer sees a read behind the end.
      ASSERT_FALSE(opens(bytes)) << size;
      seal(bytes);
      ASSERT_FALSE(opens(bytes)) << size << ", sealed";
    }
  }
}

TEST(OpenPrepared, SurvivesRandomWords) {
  std::mt19937 random(1);
  for (const Bytes& whole : samples()) {
    for (int round = 0; round < 20000; ++round) {
      Bytes bytes = whole;
      for (uint32_t i = 0; i <= random() % 3; ++i) {
        const uint32_t values[] = {0,
                                   1,
                                   0x7fffffff,
                                   0x80000000,
                                   0xffffffff,
                                   static_cast<uint32_t>(random() % 256),
                                   static_cast<uint32_t>(random())};
        put(bytes, random() % (bytes.size() / 4) * 4, values[random() % 7]);
      }
      seal(bytes);
      expect_refused_or_in_range(bytes);
    }
  }
}

TEST(OpenPrepared, RefusesCountsThatOverflow) {
  for (const uint32_t huge : {0x40000000u, 0x55555556u, 0x80000000u, 0xffffffffu}) {
    for (const size_t offset : {offsetof(PreparedHeader, batch_count), offsetof(PreparedHeader, vertex_count),
                                offsetof(PreparedHeader, triangle_count)}) {
      for (Bytes bytes : samples()) {
        put(bytes, offset, huge);
        seal(bytes);
        EXPECT_FALSE(opens(bytes)) << offset;
      }
    }
  }
}

TEST(OpenPrepared, RefusesEachRangeThatIsLeft) {
  const Bytes whole = samples()[0];
  const PreparedLayout layout(header_of(whole));
  const auto refuses = [&](uint64_t offset, const auto& value) {
    Bytes bytes = whole;
    put(bytes, offset, value);
    seal(bytes);
    EXPECT_FALSE(opens(bytes)) << "offset " << offset;
  };
  const float nan = std::nanf("");
  refuses(layout.batches + offsetof(PreparedBatch, bounds), nan);
  refuses(layout.batches + offsetof(PreparedBatch, bounds), 1e30f);  // Above the maximum.
  refuses(layout.batches + offsetof(PreparedBatch, submesh), header_of(whole).submesh_count);
  refuses(layout.batches + offsetof(PreparedBatch, first_triangle), 1u);
  refuses(layout.batches + offsetof(PreparedBatch, triangle_count), 0u);
  refuses(layout.batches + offsetof(PreparedBatch, triangle_count), 33u);
  refuses(layout.batches + offsetof(PreparedBatch, first_vertex), 1u);
  refuses(layout.batches + offsetof(PreparedBatch, vertex_count), 0u);
  refuses(layout.batches + offsetof(PreparedBatch, vertex_count), 97u);
  refuses(layout.vertices, header_of(whole).mesh_vertex_count);
  refuses(layout.local_indices, uint8_t{255});
  refuses(offsetof(PreparedHeader, settings), 31u);
  refuses(offsetof(PreparedHeader, mesh_vertex_count), 1u);
  refuses(offsetof(PreparedHeader, submesh_count), 0u);
  refuses(offsetof(PreparedHeader, zero), 1u);
}

TEST(OpenPrepared, SaysWhatIsWrong) {
  const auto message = [](const Bytes& bytes) { return umbrage::open_prepared(bytes).error().message; };
  EXPECT_NE(message({}).find("shorter than their header"), std::string::npos);
  EXPECT_NE(message(Bytes(4096)).find("not from prepare_mesh"), std::string::npos);
  Bytes bytes = samples()[0];
  put(bytes, offsetof(PreparedHeader, version), 99u);
  EXPECT_NE(message(bytes).find("version 99"), std::string::npos);
  bytes = samples()[0];
  bytes.back() ^= std::byte{1};
  EXPECT_NE(message(bytes).find("checksum"), std::string::npos);
}

TEST(OpenPrepared, RefusesBytesBetweenWords) {
  const Bytes whole = samples()[0];
  for (size_t shift = 1; shift < 4; ++shift) {
    Bytes bytes(whole.size() + shift);
    std::copy(whole.begin(), whole.end(), bytes.begin() + static_cast<ptrdiff_t>(shift));
    const auto mesh = umbrage::open_prepared(std::span(bytes).subspan(shift));
    ASSERT_FALSE(mesh.ok());
    EXPECT_NE(mesh.error().message.find("multiple of 4"), std::string::npos);
  }
}

}  // namespace
}  // namespace test
