// The program's cache of batches: found again, rebuilt when damaged, bounded, and never in the way.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <limits>

#include "import/batch_cache.hpp"
#include "prepare_meshes.hpp"

namespace test {
namespace {

namespace fs = std::filesystem;
using app::BatchCache;
using Bytes = std::vector<std::byte>;

class BatchCacheTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "umbrage-batches-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  static Bytes made(const TriangleMesh& mesh) {
    return *umbrage::prepare_mesh(mesh.positions, mesh.indices, mesh.submeshes, {});
  }
  static Bytes from(BatchCache& cache, const TriangleMesh& mesh) {
    return *cache.prepare(mesh.positions, mesh.indices, mesh.submeshes, {});
  }

  std::vector<fs::path> files() const {
    std::vector<fs::path> result;
    for (const auto& entry : fs::directory_iterator(folder_)) result.push_back(entry.path());
    return result;
  }

  fs::path folder_;
};

void write(const fs::path& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST_F(BatchCacheTest, FindsAMeshAgain) {
  const TriangleMesh mesh = soup_of_submeshes(500, 3, 1);
  const fs::path nested = folder_ / "made" / "when needed";
  BatchCache first(nested);
  EXPECT_EQ(from(first, mesh), made(mesh));
  EXPECT_EQ(first.hits(), 0u);
  EXPECT_EQ(from(first, mesh), made(mesh));
  EXPECT_EQ(first.hits(), 1u);
  BatchCache second(nested);
  EXPECT_EQ(from(second, mesh), made(mesh));
  EXPECT_EQ(second.hits(), 1u);
  EXPECT_EQ(from(second, wavy_grid(9, 9)), made(wavy_grid(9, 9)));
  EXPECT_EQ(second.hits(), 1u);
  EXPECT_EQ(std::distance(fs::directory_iterator(nested), {}), 2);
}

TEST_F(BatchCacheTest, RebuildsWhatIsDamagedOrForeign) {
  const TriangleMesh mesh = wavy_grid(20, 20), other = wavy_grid(21, 20);
  BatchCache cache(folder_);
  from(cache, mesh);
  ASSERT_EQ(files().size(), 1u);
  const fs::path file = files()[0];
  Bytes flipped = made(mesh);
  flipped[flipped.size() / 2] ^= std::byte{1};
  Bytes cut = made(mesh);
  cut.resize(cut.size() / 2);
  for (const Bytes& content : {flipped, cut, Bytes{}, Bytes(5000, std::byte{7}), made(other)}) {
    write(file, content);
    EXPECT_EQ(from(cache, mesh), made(mesh));
    EXPECT_EQ(cache.hits(), 0u);
    EXPECT_EQ(fs::file_size(file), made(mesh).size());
  }
  from(cache, mesh);
  EXPECT_EQ(cache.hits(), 1u);
}

// 64 sparse GiB and a pipe without a writer: reading either would not end well.
TEST_F(BatchCacheTest, DoesNotReadWhatCannotBeItsOwn) {
  const TriangleMesh mesh = wavy_grid(5, 5);
  BatchCache cache(folder_);
  from(cache, mesh);
  const fs::path file = files().at(0);
  fs::resize_file(file, uint64_t{1} << 36);
  EXPECT_EQ(from(cache, mesh), made(mesh));
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(from(cache, mesh), made(mesh));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_EQ(from(cache, mesh), made(mesh));
  EXPECT_EQ(cache.hits(), 0u);
  EXPECT_EQ(files().size(), 1u) << "a temporary file was left";
}

TEST_F(BatchCacheTest, WorksWithoutAFolder) {
  const TriangleMesh mesh = wavy_grid(5, 5);
  write(folder_ / "file", {});
  for (const fs::path& folder : {fs::path(), folder_ / "file", folder_ / "file" / "below", fs::path("/proc/none")}) {
    BatchCache cache(folder);
    EXPECT_EQ(from(cache, mesh), made(mesh)) << folder;
    EXPECT_EQ(cache.hits(), 0u);
  }
}

TEST_F(BatchCacheTest, WorksWithoutThePermissionToWrite) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  BatchCache cache(folder_);
  EXPECT_EQ(from(cache, wavy_grid(5, 5)), made(wavy_grid(5, 5)));
  EXPECT_TRUE(files().empty());
}

TEST_F(BatchCacheTest, ReturnsTheErrorsOfPrepareMesh) {
  BatchCache cache(folder_);
  const std::vector<uint32_t> indices{0, 1, 2};
  const auto result = cache.prepare({}, indices, {}, {});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, umbrage::ErrorCode::invalid_argument);
  EXPECT_TRUE(files().empty());
}

TEST_F(BatchCacheTest, DropsTheLeastRecentlyUsed) {
  std::vector<TriangleMesh> meshes;
  for (uint32_t i = 0; i < 10; ++i) meshes.push_back(soup(400, i));
  const uint64_t one = made(meshes[0]).size();
  BatchCache cache(folder_, 8 * one);
  const fs::path foreign = folder_ / "notes.txt";
  write(foreign, Bytes(20 * one));
  for (uint32_t i = 0; i < 6; ++i) from(cache, meshes[i]);
  // Everything an hour old, then the first is used again.
  for (const fs::path& file : files())
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
  from(cache, meshes[0]);
  ASSERT_EQ(cache.hits(), 1u);
  for (uint32_t i = 6; i < 10; ++i) from(cache, meshes[i]);

  uint64_t held = 0;
  for (const fs::path& file : files()) held += file == foreign ? 0 : fs::file_size(file);
  EXPECT_LE(held, 8 * one);
  EXPECT_TRUE(fs::exists(foreign));
  from(cache, meshes[0]);
  EXPECT_EQ(cache.hits(), 2u) << "what was used lately is gone";
  from(cache, meshes[9]);
  EXPECT_EQ(cache.hits(), 3u) << "what was stored last is gone";
  from(cache, meshes[1]);
  EXPECT_EQ(cache.hits(), 3u) << "what was not used is still there";
}

TEST_F(BatchCacheTest, ForgetsLeftoversOfInterruptedRuns) {
  const fs::path leftover = folder_ / "0123456789abcdef.umbp.aBcDeF";
  write(leftover, Bytes(1 << 20));
  fs::last_write_time(leftover, fs::file_time_type::clock::now() - std::chrono::hours(1));
  BatchCache cache(folder_, 100'000);
  from(cache, wavy_grid(9, 9));
  EXPECT_FALSE(fs::exists(leftover));
}

struct LevelsMesh {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
};

LevelsMesh with_levels(uint32_t side) {
  const TriangleMesh grid = wavy_grid(side, side);
  LevelsMesh mesh{.indices = grid.indices};
  for (const umbrage::Vec3& p : grid.positions) mesh.positions.emplace_back(p.x, p.y, p.z);
  return mesh;
}

void expect_levels(BatchCache& cache, const LevelsMesh& mesh) {
  const app::DetailLevels expected = app::make_detail_levels(mesh.positions, mesh.indices);
  const app::DetailLevels found = cache.levels(mesh.positions, mesh.indices);
  EXPECT_EQ(found.indices, expected.indices);
  EXPECT_EQ(found.first_index, expected.first_index);
  EXPECT_EQ(found.errors_m, expected.errors_m);
}

TEST_F(BatchCacheTest, FindsLevelsOfDetailAgain) {
  const LevelsMesh mesh = with_levels(20), other = with_levels(21), small = with_levels(4);
  ASSERT_GT(app::make_detail_levels(mesh.positions, mesh.indices).errors_m.size(), 2u);
  BatchCache cache(folder_);
  expect_levels(cache, mesh);
  expect_levels(cache, mesh);
  EXPECT_EQ(cache.hits(), 1u);
  expect_levels(cache, other);
  LevelsMesh moved = mesh;
  moved.positions[7].y += 1;
  expect_levels(cache, moved);
  LevelsMesh turned = mesh;
  std::swap(turned.indices[0], turned.indices[1]);
  expect_levels(cache, turned);
  EXPECT_EQ(cache.hits(), 1u);
  EXPECT_EQ(files().size(), 4u);
  expect_levels(cache, small);
  EXPECT_EQ(files().size(), 4u) << "one level is not worth a file";
}

TEST_F(BatchCacheTest, MakesLevelsAnewWhereTheirFileIsDamagedOrForeign) {
  const LevelsMesh mesh = with_levels(20), other = with_levels(21);
  const uint64_t key = app::detail_levels_key(mesh.positions, mesh.indices);
  app::DetailLevels levels = app::make_detail_levels(mesh.positions, mesh.indices);
  const Bytes good = app::bytes_of(levels, key);
  BatchCache cache(folder_);
  expect_levels(cache, mesh);
  const fs::path file = files().at(0);
  std::vector<Bytes> bad{{}, Bytes(5000, std::byte{7}), Bytes(3), Bytes(good.begin(), good.end() - 4), Bytes(good.begin(), good.begin() + 24)};
  for (size_t byte = 0; byte < good.size(); byte += 1 + byte / 16) {
    bad.push_back(good);
    bad.back()[byte] ^= std::byte{4};
  }
  bad.push_back(app::bytes_of(app::make_detail_levels(other.positions, other.indices), key));
  // Whole and of this key, but no levels of the mesh.
  const auto spoilt = [&](auto&& spoil) {
    app::DetailLevels wrong = levels;
    spoil(wrong);
    bad.push_back(app::bytes_of(wrong, key));
  };
  spoilt([&](auto& wrong) { wrong.indices.back() = static_cast<uint32_t>(mesh.positions.size()); });
  spoilt([](auto& wrong) { wrong.errors_m[1] = 0; });
  spoilt([](auto& wrong) { wrong.errors_m.back() = std::numeric_limits<float>::infinity(); });
  spoilt([](auto& wrong) { wrong.errors_m[1] = std::numeric_limits<float>::quiet_NaN(); });
  spoilt([](auto& wrong) { wrong.first_index[2] += 1; });
  spoilt([](auto& wrong) { wrong.first_index.back() += 3; });
  for (const Bytes& content : bad) {
    write(file, content);
    ASSERT_FALSE(app::detail_levels_of(content, key, mesh.positions.size(), mesh.indices));
  }
  write(file, bad.back());
  expect_levels(cache, mesh);
  EXPECT_EQ(cache.hits(), 0u);
  expect_levels(cache, mesh);
  EXPECT_EQ(cache.hits(), 1u);
}

TEST_F(BatchCacheTest, DoesNotStoreWhatIsBeyondItsLimit) {
  BatchCache cache(folder_, 100);
  EXPECT_EQ(from(cache, wavy_grid(9, 9)), made(wavy_grid(9, 9)));
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace test
