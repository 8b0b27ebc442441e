// Files that others made to break importers: each loads or is refused with a message, within a time and an address
// space.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "import_test_files.hpp"

namespace import_test {
namespace {

namespace fs = std::filesystem;

/// Errors that the Khronos validator reports for a file; -1: there is no report.
int reported_errors(const fs::path& file) {
  std::ifstream report(file.string() + ".report.json");
  if (!report) return -1;
  return nlohmann::json::parse(report).at("issues").at("numErrors").get<int>();
}

std::string in_folder(const fs::path& file, const fs::path& folder) { return fs::relative(file, folder).string(); }

TEST(Robustness, EveryFileLoadsOrIsRefusedInTime) {
  const fs::path folder = scene_file("robustness");
  if (folder.empty()) GTEST_SKIP() << "no robustness in UMBRAGE_SCENES_DIR";
  size_t loaded = 0, refused = 0, valid = 0;
  for (const fs::path& file : gltf_files(folder)) {
    SCOPED_TRACE(in_folder(file, folder));
    const auto start = std::chrono::steady_clock::now();
    const auto scene = app::import_gltf(file);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 5);
    const int errors = reported_errors(file);
    const std::string verdict = scene.ok() ? "loads" : scene.error().message;
    std::printf("%-100s %3d  %s\n", in_folder(file, folder).c_str(), errors, verdict.c_str());
    scene.ok() ? ++loaded : ++refused;
    if (errors == 0) {
      ++valid;
      // None of the valid files here requires an extension that is not supported.
      EXPECT_TRUE(scene.ok()) << scene.error().message;
    }
    if (!scene.ok()) {
      EXPECT_EQ(scene.error().message.rfind(file.filename().string() + ": ", 0), 0u) << scene.error().message;
      EXPECT_EQ(scene.error().message.find('\n'), std::string::npos) << scene.error().message;
      EXPECT_NE(scene.error().code, umbrage::ErrorCode::out_of_memory);
    } else {
      app::pose(scene.value(), 0.7);
    }
  }
  std::printf("%zu files load, %zu are refused; %zu are valid\n", loaded, refused, valid);
  EXPECT_GT(valid, 0u);
  EXPECT_GT(refused, 0u);
}

TEST(Robustness, EveryFileIsDoneIn128MebibytesMore) {
  const fs::path folder = scene_file("robustness");
  if (folder.empty()) GTEST_SKIP() << "no robustness in UMBRAGE_SCENES_DIR";
  EXPECT_TRUE(succeeds_within(size_t{128} << 20, [&] {
    for (const fs::path& file : gltf_files(folder)) {
      const auto scene = app::import_gltf(file);
      if (!scene.ok() && scene.error().code == umbrage::ErrorCode::out_of_memory) return false;
    }
    return true;
  }));
}

struct Refusal {
  const char* file;
  const char* message;
};

/// What a person reads who made the mistake.
constexpr Refusal refusals[] = {
    {"assimp/IndexOutOfRange/IndexOutOfRange.gltf", "meshes[0].primitives[0]: index 255 is beyond its 24 vertices"},
    {"assimp/RecursiveNodes/RecursiveNodes.gltf", "is its own ancestor"},
    {"assimp/MissingBin/BoxTextured.gltf", "there is no file"},
    {"assimp/wrongTypes/badArray.gltf", "meshes[0].primitives: must be an array, is object"},
    {"glTF-Validator/base/data/node/node_parent_override.gltf", "nodes[2]: is a child of nodes[0] and of nodes[1]"},
    {"glTF-Validator/base/data/mesh/accessor_unequal_count.gltf", "COLOR_0 has 4 elements, POSITION 3"},
    {"glTF-Validator/base/data/animation_data/invalid_input_values.gltf", "is negative"},
    {"glTF-Validator/base/data/glb/invalid_version.glb", "only version 2 is read"},
    {"glTF-Validator/base/data/root/undefined_used_extensions.gltf", "KHR_extension is not supported"},
};

TEST(Robustness, FaultsAreNamed) {
  if (scene_file("robustness").empty()) GTEST_SKIP() << "no robustness in UMBRAGE_SCENES_DIR";
  for (const Refusal& refusal : refusals) {
    const fs::path file = scene_file(std::string("robustness/") + refusal.file);
    ASSERT_FALSE(file.empty()) << refusal.file;
    EXPECT_REFUSED(app::import_gltf(file), refusal.message);
  }
}

}  // namespace
}  // namespace import_test
