// Real small files with flipped bytes, cut tails and exchanged numbers: always a scene or a message. The same every
// run.
#include <fstream>
#include <iterator>
#include <random>

#include "import_test_files.hpp"

namespace import_test {
namespace {

constexpr const char* seeds[] = {
    "robustness/cgltf-fuzz/fuzz/data/Box.glb",
    "robustness/meshoptimizer/gltf/fuzz.glb",
    "lights_and_masks/Lights.glb",
    "animated/SimpleSkin.gltf",
    "lights_and_masks/Cubes.glb",
};
constexpr size_t mutations_per_seed = 400;

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// One to four faults. Only the generator's own numbers are used: distributions differ between standard libraries.
std::string mutated(std::string content, std::mt19937& random) {
  const auto below = [&](size_t limit) { return static_cast<size_t>(random()) % limit; };
  for (size_t fault = 0, faults = 1 + below(4); fault < faults && !content.empty(); ++fault) {
    const size_t at = below(content.size());
    switch (below(6)) {
      case 0:
        content[at] = static_cast<char>(static_cast<uint8_t>(content[at]) ^ (1u << below(8)));
        break;
      case 1:
        content[at] = static_cast<char>(random());
        break;
      case 2:
        content.resize(at);
        break;
      case 3:
        content.erase(at, 1 + below(16));
        break;
      case 4:
        content.insert(at, content.substr(below(content.size()), 1 + below(64)));
        break;
      default: {  // another number where one is
        const size_t digit = content.find_first_of("0123456789", at);
        static constexpr const char* numbers[] = {"-1",         "0",          "255",  "65536",
                                                  "2147483647", "4294967296", "1e30", "9e18"};
        if (digit != std::string::npos) content.replace(digit, 1, numbers[below(std::size(numbers))]);
      }
    }
  }
  return content;
}

TEST(Mutations, LoadOrAreRefused) {
  const TemporaryFolder folder;
  size_t loaded = 0, refused = 0;
  for (const char* seed : seeds) {
    const auto file = scene_file(seed);
    if (file.empty()) GTEST_SKIP() << "no " << seed << " in UMBRAGE_SCENES_DIR";
    const std::string content = content_of(file);
    std::mt19937 random(20240607);
    for (size_t i = 0; i < mutations_per_seed; ++i) {
      SCOPED_TRACE(std::string(seed) + ", mutation " + std::to_string(i));
      const auto scene =
          app::import_gltf(folder.write("mutated" + file.extension().string(), mutated(content, random)));
      if (!scene.ok()) {
        ++refused;
        EXPECT_NE(scene.error().code, umbrage::ErrorCode::out_of_memory) << scene.error().message;
        continue;
      }
      ++loaded;
      const app::Pose pose = app::pose(scene.value(), 0.4);
      for (const app::PosedInstance& instance : pose.instances) {
        for (const app::Primitive& primitive : scene.value().meshes[instance.mesh].primitives) {
          EXPECT_EQ(app::deformed_positions(primitive, instance, pose).size(), primitive.positions.size());
          for (const uint32_t index : primitive.indices) ASSERT_LT(index, primitive.positions.size());
        }
      }
    }
  }
  EXPECT_GT(loaded, 0u);
  EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace import_test
