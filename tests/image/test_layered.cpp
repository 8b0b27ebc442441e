// umbrage layered and info --recommend, as users run them.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <set>
#include <tuple>

#include <stb/stb_image.h>
#include "program.hpp"
#include "temporary_folder.hpp"

namespace {

struct Picture {
  int width = 0, height = 0;
  size_t colors = 0;  ///< Different ones.
};

Picture read_picture(const std::string& file) {
  Picture picture;
  int channels = 0;
  unsigned char* texels = stbi_load(file.c_str(), &picture.width, &picture.height, &channels, 3);
  if (!texels) return picture;
  std::set<unsigned> seen;
  for (int i = 0; i < picture.width * picture.height; ++i)
    seen.insert(texels[3 * i] << 16 | texels[3 * i + 1] << 8 | texels[3 * i + 2]);
  picture.colors = seen.size();
  stbi_image_free(texels);
  return picture;
}

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Layered, EveryUseMakesItsPictureUnderValidation) {
  const TemporaryFolder folder;
  const std::tuple<const char*, int, int> uses[] = {
      {"cube", 3, 2},       {"cube-array", 6, 4},      {"cascades", 4, 1}, {"cascade-sets", 4, 3}, {"warped", 2, 1},
      {"reflection", 2, 1}, {"reflection-cube", 1, 1}, {"stereo", 2, 1},   {"cad", 2, 2}};
  for (const auto& [use, columns, rows] : uses) {
    const std::string file = folder.file(std::string(use) + ".png").string();
    const Outcome outcome =
        run_program({"layered", use, data_file("room.gltf"), "-o", file, "--size", "96x64", "--validate"});
    ASSERT_EQ(outcome.status, 0) << use << ": " << outcome.err;
    const bool has_faces = std::string(use).starts_with("cube");
    const Picture picture = read_picture(file);
    EXPECT_EQ(picture.width, columns * (has_faces ? 64 : 96)) << use;
    EXPECT_EQ(picture.height, rows * 64) << use;
    EXPECT_GT(picture.colors, 10u) << use << " is a blank";
  }
}

TEST(Layered, WritersMakeTheSamePicture) {
  const TemporaryFolder folder;
  const auto drawn = [&](const char* use, const char* writer) {
    const std::string file = folder.file(std::string(use) + "-" + writer + ".png").string();
    const Outcome outcome =
        run_program({"layered", use, data_file("room.gltf"), "-o", file, "--size", "80x80", "--writer", writer});
    if (outcome.status != 0 && outcome.err.find(" needs ") != std::string::npos)
      return std::string();  // not on this device
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return bytes_of(file);
  };
  for (const char* use : {"cube", "stereo"}) {
    const std::string expected = drawn(use, "traditional");
    for (const char* writer : {"vertex_layer", "multiview"}) {
      const std::string found = drawn(use, writer);
      EXPECT_TRUE(found.empty() || found == expected) << use << ", " << writer;
    }
  }
}

TEST(Layered, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program({"layered", "other", data_file("room.gltf"), "-o", folder.file("a.png").string()}).status, 2);
  EXPECT_EQ(
      run_program({"layered", "cube", data_file("room.gltf"), "-o", folder.file("a.png").string(), "--writer", "atlas"})
          .status,
      2);
  const Outcome colored = run_program(
      {"layered", "stereo", data_file("room.gltf"), "-o", folder.file("a.png").string(), "--writer", "compute"});
  EXPECT_EQ(colored.status, 1);
  EXPECT_NE(colored.err.find("depth alone"), std::string::npos) << colored.err;
  const Outcome unnamed = run_program({"layered", "cube", data_file("room.gltf"), "-o", folder.file("a.png").string(),
                                       "--recommended", data_file("room.gltf")});
  EXPECT_EQ(unnamed.status, 1);
  EXPECT_NE(unnamed.err.find("layered_writers.cube_map"), std::string::npos) << unnamed.err;
}

TEST(Layered, RecommendationsAreMeasuredAndUsed) {
  const TemporaryFolder folder;
  const std::string file = folder.file("best.json").string();
  const Outcome outcome = run_program({"info", "--recommend", file});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json document = parse_json(bytes_of(file));
  for (const char* use : {"cube_map", "cascades", "many_small_maps", "skinned", "color"}) {
    ASSERT_TRUE(document["layered_writers"].contains(use)) << use;
    // The best is the least of what was measured.
    double least = 1e9, best = 0;
    for (const auto& row : document["measured"]) {
      if (row["use"] != use) continue;
      least = std::min(least, row["gpu_ms"].get<double>());
      if (row["writer"] == document["layered_writers"][use]) best = row["gpu_ms"];
    }
    EXPECT_EQ(best, least) << use;
  }
  EXPECT_EQ(run_program({"layered", "cube", data_file("room.gltf"), "-o", folder.file("a.png").string(), "--size",
                         "32x32", "--recommended", file})
                .status,
            0);
}

// Measures, so it is apart: not beside other tests.
TEST(LayeredBenchLongScene, QuickEndsInTwoMinutesAndResumes) {
  const TemporaryFolder folder;
  const auto run = [&] {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = run_program({"bench", "layered", "--quick", "-o", folder.file("results").string()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  EXPECT_LT(run(), 120);
  const std::string results = folder.file("results/results.json").string();
  const nlohmann::json first = parse_json(bytes_of(results));
  EXPECT_GT(first["rows"].size(), 100u);
  for (const char* name :
       {"results.csv", "report.html", "figure-19.3-ring.svg", "figure-19.4-ring.svg", "figure-19.5-ring.svg",
        "figure-19.6-ring.svg", "figure-19.7-ring.svg", "figure-19.8-ring.svg", "figure-19.9-ring.svg"})
    EXPECT_GT(bytes_of(folder.file(std::string("results/") + name).string()).size(), 500u) << name;
  // A row that is missing, as after an interruption, is measured again, and nothing else is.
  nlohmann::json cut = first;
  cut["rows"].erase(cut["rows"].size() - 1);
  folder.write("results/results.json", cut.dump());
  EXPECT_LT(run(), 30);
  const nlohmann::json second = parse_json(bytes_of(results));
  ASSERT_EQ(second["rows"].size(), first["rows"].size());
  EXPECT_EQ(second["rows"][0], first["rows"][0]);
  cut["device"]["driver"] = "another";
  folder.write("results/results.json", cut.dump());
  const Outcome refused = run_program({"bench", "layered", "--quick", "-o", folder.file("results").string()});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("another device"), std::string::npos) << refused.err;
}

}  // namespace
