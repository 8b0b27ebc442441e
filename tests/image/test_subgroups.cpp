// The software driver's subgroups are as wide as it is told to make its vectors: what is drawn must not depend on that. At 512
// bits the compiler of Mesa 25.0.7 crashes on this program's shaders, so that 4 and 8 lanes are compared.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace {

/// An environment variable while it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  Variable(const Variable&) = delete;
  ~Variable() { unsetenv(name_); }

 private:
  const char* name_;
};

struct Frame {
  std::string visibility, device;
  nlohmann::json statistics;
};

Frame frame_at(const std::string& width_bits, const std::string& preset) {
  const TemporaryFolder folder;
  const Variable width("LP_NATIVE_VECTOR_WIDTH", width_bits);
  const Variable cache("MESA_SHADER_CACHE_DIR",
                       folder.file("cache").string());  // shaders of one width crash at another
  const Outcome outcome = run_program({"render", data_file("room.gltf"), "--size", "160x96", "--preset", preset, "-o",
                                       folder.file("a.png").string(), "--dump", folder.file("dump").string(), "--stats",
                                       folder.file("stats.json").string()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json statistics = parse_json(read_all(folder.file("stats.json")));
  return {read_all(folder.file("dump") / "visibility.npy"), statistics.value("device", ""), statistics};
}

class Subgroups : public testing::TestWithParam<const char*> {};

TEST_P(Subgroups, OfEverySizeSeeTheSame) {
  const Frame narrow = frame_at("128", GetParam()), wide = frame_at("256", GetParam());
  if (narrow.device == wide.device) GTEST_SKIP() << narrow.device << " has one subgroup size";
  ASSERT_FALSE(narrow.visibility.empty());
  EXPECT_EQ(narrow.visibility, wide.visibility);
  for (const char* key : {"clusters", "cluster_light_pairs", "shadow_maps", "pages_requested", "texels_allocated",
                          "caster_pairs", "triangles_drawn"})
    EXPECT_EQ(narrow.statistics[key], wide.statistics[key]) << key;
}

INSTANTIATE_TEST_SUITE_P(Presets, Subgroups, testing::Values("default", "fixed-cubes"));

}  // namespace
