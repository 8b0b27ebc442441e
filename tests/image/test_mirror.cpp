// The mirror ball of `umbrage render`: what it shows is what is there, lit by maps that were marked for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include <glm/glm.hpp>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace {

constexpr glm::vec3 kBall(1.2f, 1.9f, 1.0f), kEye(-2.6f, 2.9f, -2.4f);
constexpr float kRadius = 0.5f;

std::string text_of(const glm::vec3& v) {
  return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// side × side vectors of a dump.
std::vector<glm::vec3> vectors_of(const std::filesystem::path& file, size_t side) {
  const std::string bytes = file_text(file);
  std::vector<glm::vec3> values(side * side);
  const size_t size = values.size() * sizeof(glm::vec3);
  EXPECT_GT(bytes.size(), size) << file;
  if (bytes.size() > size) std::memcpy(values.data(), bytes.data() + bytes.size() - size, size);
  return values;
}

/// The room with the ball, seen by a camera of one's own; what it dumps and its statistics are in the folder.
void draw_room(const TemporaryFolder& folder, const std::string& name, const glm::vec3& eye, const glm::vec3& target,
               const std::string& fov, const std::string& size) {
  const Outcome outcome =
      run_program({"render", data_file("room.gltf"), "-o", folder.file(name + ".png").string(), "--size", size, "--eye",
                   text_of(eye), "--target", text_of(target), "--fov-y", fov, "--mirror-ball",
                   text_of(kBall) + "," + std::to_string(kRadius), "--dump", folder.file(name).string(), "--stats",
                   folder.file(name + ".json").string(), "--validate"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
}

TEST(Mirror, ShowsWhatIsThereInMarkedMaps) {
  const TemporaryFolder folder;
  constexpr size_t kSide = 96, kPatch = 16;
  draw_room(folder, "ball", kEye, kBall, "15", "96x96");
  const nlohmann::json stats = parse_json(file_text(folder.file("ball.json")));
  EXPECT_EQ(stats.at("unmarked_taps"), 0) << "surfaces in the mirror are answered by whole maps";
  EXPECT_EQ(stats.at("unbacked_taps"), 0);
  const auto position = vectors_of(folder.file("ball") / "position.npy", kSide);
  const auto color = vectors_of(folder.file("ball") / "color.npy", kSide);
  int compared = 0;
  for (const auto& [x, y] : {std::pair{48, 48}, {36, 48}, {60, 48}, {48, 62}, {40, 58}}) {
    const size_t pixel = static_cast<size_t>(y) * kSide + static_cast<size_t>(x);
    const glm::vec3 normal = glm::normalize(position[pixel] - kBall), to_eye = glm::normalize(kEye - position[pixel]);
    ASSERT_NEAR(glm::distance(position[pixel], kBall), kRadius, 0.01f * kRadius) << "the ball is in the middle";
    // The same from the ball's middle, whose own faces cannot be seen from within.
    const std::string name = "seen-" + std::to_string(compared) + "-" + std::to_string(pixel);
    draw_room(folder, name, kBall, kBall + glm::reflect(-to_eye, normal), "3", "16x16");
    const auto seen = vectors_of(folder.file(name) / "color.npy", kPatch);
    glm::vec3 least(1e9f), most(0);
    for (const glm::vec3& value : seen) least = glm::min(least, value), most = glm::max(most, value);
    if (glm::any(glm::greaterThan(most, 1.2f * least + 1e-3f))) continue;  // an edge: texels of the cube map blur it
    const float grazing = 1 - glm::dot(normal, to_eye);
    const float share = glm::mix(0.95f, 1.0f, std::pow(grazing, 5.0f));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_GE(color[pixel][channel], 0.9f * share * least[channel] - 1e-3f) << name << ", channel " << channel;
      EXPECT_LE(color[pixel][channel], 1.1f * share * most[channel] + 1e-3f) << name << ", channel " << channel;
    }
    EXPECT_GT(most.r + most.g + most.b, 0.01f) << name << ": black proves nothing";
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

TEST(Mirror, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.png").string();
  for (const char* ball : {"1,2,3", "1,2,3,0", "1,2,3,-1", "1,2,3,x", ",,,", "1", ""})
    EXPECT_EQ(run_program({"render", data_file("room.gltf"), "-o", file, "--mirror-ball", ball}).status, 2) << ball;
  const Outcome outcome = run_program(
      {"render", data_file("room.gltf"), "-o", file, "--mirror-ball", "0,1,0,0.5", "--preset", "fixed-cubes"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("store=page_pool"), std::string::npos) << outcome.err;
}

}  // namespace
