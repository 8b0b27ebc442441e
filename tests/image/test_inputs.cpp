// Command-line values, lights files, camera paths and settings of people: what is read, what is refused and how.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "commands/active_lights.hpp"
#include "commands/camera_path.hpp"
#include "commands/camera_source.hpp"
#include "commands/image_file.hpp"
#include "commands/lights_file.hpp"
#include "commands/parse.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace app;

TEST(Parse, NumbersAreWholeAndFinite) {
  EXPECT_EQ(*parse_number("1.5"), 1.5);
  EXPECT_EQ(*parse_number("-2e3"), -2000);
  for (const char* text : {"", "nan", "inf", "-inf", "1e999", "1.5x", " 1", "1 ", "0x10", "1,5"})
    EXPECT_FALSE(parse_number(text)) << text;
  EXPECT_FALSE(parse_number("2", 0, 1));
  EXPECT_FALSE(parse_number("-1", 0, 1));
}

TEST(Parse, CountsAreDigitsInRange) {
  EXPECT_EQ(*parse_count("12", 0, 12), 12u);
  EXPECT_EQ(*parse_count("18446744073709551615", 0, UINT64_MAX), UINT64_MAX);
  for (const char* text : {"", "-1", "+1", "1.0", "13", "18446744073709551616", "1e1", "1 "})
    EXPECT_FALSE(parse_count(text, 0, 12)) << text;
}

TEST(Parse, Sizes) {
  const auto size = parse_size("640x360");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 640u);
  EXPECT_EQ(size->height, 360u);
  EXPECT_TRUE(parse_size("16384x1"));
  for (const char* text : {"640", "640x", "x360", "0x360", "-640x360", "640x360x1", "16385x1", "640X360", "640x360 "})
    EXPECT_FALSE(parse_size(text)) << text;
}

TEST(Parse, Vectors) {
  EXPECT_EQ(*parse_vec3("1,-2.5,3e1"), glm::vec3(1, -2.5f, 30));
  for (const char* text : {"", "1,2", "1,2,3,4", "1,2,nan", "1,,3", "1,2,3x", "1e40,0,0"})
    EXPECT_FALSE(parse_vec3(text)) << text;
}

TEST(Parse, IndexLists) {
  const auto ranges = parse_index_list("5,0,10-12,11");
  ASSERT_TRUE(ranges);
  EXPECT_EQ(*expand_indices(*ranges, 13), (std::vector<uint32_t>{0, 5, 10, 11, 12}));
  EXPECT_FALSE(expand_indices(*ranges, 12));
  for (const char* text : {"", ",", "1,", "2-1", "1-", "-1", "a", "1-2-3", "4294967296"})
    EXPECT_FALSE(parse_index_list(text)) << text;
  // A list of all numbers takes no memory before it is held against the lights there are.
  EXPECT_FALSE(expand_indices(*parse_index_list("0-4294967295"), 4));
}

TEST(Parse, NumberedNames) {
  EXPECT_EQ(numbered_name("a/frame-%04d.png", 7), "a/frame-0007.png");
  EXPECT_EQ(numbered_name("%d.png", 12345), "12345.png");
  EXPECT_EQ(numbered_name("100%.png", 3), "100%.png");
  EXPECT_EQ(count_number_places("%04d-%d.png"), 2u);
  EXPECT_EQ(count_number_places("%s%4d%00d%0"), 0u);
}

struct Refusal {
  const char* text;
  const char* message;  // Must occur in the error.
};

std::string lights_of(const std::string& fields) { return R"({"lights": [{)" + fields + "}]}"; }

TEST(LightsFile, ReadsEveryKindAndFillsDefaults) {
  const TemporaryFolder folder;
  const auto lights = read_lights(folder.write("lights.json", R"({"lights": [
      {"type": "point", "position": [1, 2, 3], "faces": "-x  +z"},
      {"type": "spot", "position": [0, 1, 0], "direction": [0, -2, 0], "color": [1, 0.5, 0], "intensity": 20,
       "range": 8, "inner_cone_deg": 10, "outer_cone_deg": 30, "name": "lamp"},
      {"type": "directional", "direction": [3, 0, 4], "intensity": 0.5}]})"));
  ASSERT_TRUE(lights) << lights.error().message;
  ASSERT_EQ(lights->size(), 3u);
  EXPECT_EQ((*lights)[0].position, glm::vec3(1, 2, 3));
  EXPECT_EQ((*lights)[0].color, glm::vec3(1));
  EXPECT_EQ((*lights)[0].intensity, 1);
  EXPECT_TRUE(std::isinf((*lights)[0].range));
  EXPECT_EQ((*lights)[0].faces, 0x12u);
  EXPECT_EQ((*lights)[1].faces, 0x3fu);
  const PosedLight& spot = (*lights)[1];
  EXPECT_EQ(spot.kind, LightKind::spot);
  EXPECT_EQ(spot.name, "lamp");
  EXPECT_EQ(spot.direction, glm::vec3(0, -1, 0));
  EXPECT_FLOAT_EQ(spot.inner_cone, 0.17453293f);
  EXPECT_FLOAT_EQ(spot.outer_cone, 0.52359878f);
  EXPECT_EQ(spot.range, 8);
  EXPECT_FLOAT_EQ((*lights)[2].direction.x, 0.6f);
  EXPECT_FLOAT_EQ((*lights)[2].direction.z, 0.8f);
}

TEST(LightsFile, RefusesWithThePlace) {
  const std::string point = R"("type": "point", "position": [0, 0, 0], )";
  const std::string spot = R"("type": "spot", "position": [0, 0, 0], )";
  const struct {
    std::string text, message;
  } cases[] = {
      {"", "not usable JSON"},
      {"[]", "the document must be an object"},
      {"{}", "needs the key \"lights\""},
      {R"({"lights": {}})", "lights must be an array"},
      {R"({"lights": [], "lamps": 1})", "unknown key \"lamps\""},
      {R"({"lights": [], "lights": []})", "\"lights\" occurs twice"},
      {R"({"lights": [1]})", "lights[0] must be an object"},
      {lights_of(""), "lights[0] needs the key \"type\""},
      {lights_of(R"("type": "area")"), "lights[0].type must be \"point\""},
      {lights_of(R"("type": "point")"), "lights[0] needs the key \"position\""},
      {lights_of(spot + R"("range": 1)"), "lights[0] needs the key \"direction\""},
      {lights_of(R"("type": "point", "position": [0, 0])"), "lights[0].position must be an array of three"},
      {lights_of(R"("type": "point", "position": [0, 0, "1"])"), "lights[0].position[2] must be a number"},
      {lights_of(R"("type": "point", "position": [0, 0, 1e39])"), "lights[0].position[2] must be finite"},
      {lights_of(R"("type": "point", "position": [0, 0, 1e999])"), "not usable JSON"},
      {lights_of(R"("type": "point", "position": [0, 0, NaN])"), "not usable JSON"},
      {lights_of(point + R"("range": 0)"), "lights[0].range must be > 0, is 0"},
      {lights_of(point + R"("range": -2.5)"), "lights[0].range must be > 0, is -2.5"},
      {lights_of(point + R"("range": 1e-60)"), "lights[0].range must be > 0"},
      {lights_of(point + R"("range": "far")"), "lights[0].range must be a number, is string"},
      {lights_of(point + R"("intensity": -1)"), "lights[0].intensity must be ≥ 0"},
      {lights_of(point + R"("color": [1, -1, 0])"), "lights[0].color must not have negative"},
      {lights_of(point + R"("colour": [1, 1, 1])"), "lights[0] has the unknown key \"colour\"; known are type"},
      {lights_of(point + R"("faces": "")"), "lights[0].faces must name a face"},
      {lights_of(point + R"("faces": "+x up")"), "lights[0].faces names \"up\": choose from +x"},
      {lights_of(point + R"("faces": 3)"), "lights[0].faces must be a string"},
      {lights_of(spot + R"("direction": [0, 0, 1], "faces": "-y")"), "lights[0].faces is for point lights"},
      {lights_of(point + R"("name": 7)"), "lights[0].name must be a string"},
      {lights_of(spot + R"("direction": [0, 0, 0])"), "lights[0].direction must have a length > 0"},
      {lights_of(spot + R"("direction": [0, 0, 1], "outer_cone_deg": 91)"), "lights[0].outer_cone_deg must be at most"},
      {lights_of(spot + R"("direction": [0, 0, 1], "outer_cone_deg": 0)"), "lights[0].outer_cone_deg must be > 0"},
      {lights_of(spot + R"("direction": [0, 0, 1], "inner_cone_deg": 50)"), "lights[0] has an inner_cone_deg above"},
      {R"({"lights": [{"type": "directional", "direction": [0, 0, 1]}, {"type": 1}]})", "lights[1].type must be"},
  };
  const TemporaryFolder folder;
  for (const auto& [text, message] : cases) {
    const auto path = folder.write("lights.json", text);
    const auto lights = read_lights(path);
    ASSERT_FALSE(lights) << text;
    EXPECT_NE(lights.error().message.find(message), std::string::npos) << text << "\n" << lights.error().message;
    EXPECT_TRUE(lights.error().message.starts_with(path.string() + ": ")) << lights.error().message;
  }
}

TEST(LightsFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_lights(folder.file("missing.json")));
  EXPECT_FALSE(read_lights(folder.path()));
  const auto endless = read_lights("/dev/zero");
  ASSERT_FALSE(endless);
  EXPECT_NE(endless.error().message.find("larger than 64 MiB"), std::string::npos);
}

TEST(LightsFile, RefusesDeepNesting) {
  const TemporaryFolder folder;
  const auto lights = read_lights(folder.write("deep.json", std::string(1 << 20, '[')));
  ASSERT_FALSE(lights);
  EXPECT_NE(lights.error().message.find("nested deeper"), std::string::npos) << lights.error().message;
}

TEST(LightsFile, WhatIsWrittenReadsBackTheSame) {
  std::vector<ActiveLight> lights(3);
  lights[0] = {.name = "a", .position = {0.1f, -2.7e-7f, 1704.7067f}, .color = {0.3f, 1, 0}, .intensity = 3.1604432f};
  lights[1] = {.kind = LightKind::spot,
               .direction = glm::normalize(glm::vec3(1, 2, 3)),
               .range = 0.7f,
               .inner_cone = 0.123f,
               .outer_cone = 0.456f};
  lights[2] = {.kind = LightKind::directional, .direction = glm::normalize(glm::vec3(-1, -5, 0.3f))};
  const TemporaryFolder folder;
  const auto read = read_lights(folder.write("lights.json", lights_document(lights).dump()));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), lights.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    const ActiveLight again = activate((*read)[i], kIrradianceThreshold, {});
    EXPECT_EQ(again.name, lights[i].name);
    EXPECT_EQ(again.kind, lights[i].kind);
    EXPECT_EQ(again.position, lights[i].position);
    EXPECT_EQ(again.direction, lights[i].direction);
    EXPECT_EQ(again.color, lights[i].color);
    EXPECT_EQ(again.intensity, lights[i].intensity);
    const bool is_spot = lights[i].kind == LightKind::spot, is_directional = lights[i].kind == LightKind::directional;
    EXPECT_TRUE(is_directional || again.range == lights[i].range);
    EXPECT_TRUE(!is_spot || again.inner_cone == lights[i].inner_cone);
    EXPECT_TRUE(!is_spot || again.outer_cone == lights[i].outer_cone);
  }
}

TEST(ActiveLights, RangeWithoutOneFollowsTheThresholdUpToTheScene) {
  const Box bounds{glm::vec3(-10), glm::vec3(10)};
  const PosedLight dim{.color = {0.5f, 0.25f, 0}, .intensity = 0.02f};
  EXPECT_FLOAT_EQ(activate(dim, 0.01, bounds).range, 1);  // √(0.02 · 0.5 / 0.01)
  EXPECT_FLOAT_EQ(activate(dim, 0.0025, bounds).range, 2);
  const PosedLight bright{.intensity = 1e9f};
  EXPECT_FLOAT_EQ(activate(bright, 0.01, bounds).range, 2 * std::sqrt(300.0f));
  const PosedLight dark{.intensity = 0};
  EXPECT_GT(activate(dark, 0.01, bounds).range, 0);
  const PosedLight given{.range = 123};
  EXPECT_EQ(activate(given, 0.01, bounds).range, 123);
}

TEST(CameraPath, MeetsItsKeysAndRestsAtTheEnds) {
  const TemporaryFolder folder;
  const std::string keys = R"("keys": [
      {"time": 0, "eye": [0, 0, 0], "target": [0, 0, -1], "fov": 60},
      {"time": 1, "eye": [1, 0, 0], "target": [1, 0, -1], "fov": 40},
      {"time": 4, "eye": [4, 3, 0], "target": [1, 2, -1]}])";
  for (const char* interpolation : {"linear", "catmull_rom"}) {
    const auto path = read_camera_path(
        folder.write("path.json", R"({"interpolation": ")" + std::string(interpolation) + "\", " + keys + "}"));
    ASSERT_TRUE(path) << path.error().message;
    for (const CameraKey& key : path->keys) {
      EXPECT_NEAR(glm::length(path->at(key.time_s).eye - key.eye), 0, 1e-6f) << interpolation;
      EXPECT_NEAR(path->at(key.time_s).fov_y, key.fov_y, 1e-6f) << interpolation;
    }
    EXPECT_EQ(path->at(-5).eye, path->keys.front().eye);
    EXPECT_EQ(path->at(99).eye, path->keys.back().eye);
    // Where the keys are on a line at even speed, both are that line.
    EXPECT_NEAR(path->at(0.5).eye.x, 0.5f, 1e-6f) << interpolation;
    EXPECT_NEAR(path->at(2.5).eye.x, 2.5f, 1e-6f) << interpolation;
  }
}

TEST(CameraPath, RefusesWithThePlace) {
  const Refusal cases[] = {
      {R"({})", "needs the key \"keys\""},
      {R"({"keys": []})", "keys must hold at least one key"},
      {R"({"keys": [{"time": 0, "eye": [0,0,0]}]})", "keys[0] needs the key \"target\""},
      {R"({"keys": [{"time": 0, "eye": [0,0,0], "target": [0,0,0]}]})", "keys[0] has eye and target at the same point"},
      {R"({"keys": [{"time": 0, "eye": [0,0,0], "target": [0,0,1], "fov": 180}]})", "keys[0].fov must be 1…170"},
      {R"({"keys": [{"time": 0, "eye": [0,0,0], "target": [0,0,1], "up": 1}]})", "keys[0] has the unknown key \"up\""},
      {R"({"keys": [], "interpolation": "cubic"})", "interpolation must be"},
      {R"({"keys": [{"time": 1, "eye": [0,0,0], "target": [0,0,1]}, {"time": 1, "eye": [0,0,0], "target": [0,0,1]}]})",
       "keys[1].time must be later"},
  };
  const TemporaryFolder folder;
  for (const auto& [text, message] : cases) {
    const auto path = read_camera_path(folder.write("path.json", text));
    ASSERT_FALSE(path) << text;
    EXPECT_NE(path.error().message.find(message), std::string::npos) << text << "\n" << path.error().message;
  }
}

Pose pose_with_cameras() {
  Pose pose;
  pose.cameras.push_back({.name = "front", .lens = {.fov_y = 0.5f}, .world_from_camera = glm::mat4(1)});
  pose.cameras.push_back({.name = "0", .lens = {.fov_y = 0.75f}, .world_from_camera = glm::mat4(1)});
  return pose;
}

TEST(CameraSource, FindsByNameThenByIndex) {
  const Pose pose = pose_with_cameras();
  const auto fov_of = [&](const std::string& name) {
    const auto source = CameraSource::create({.name_or_index = name}, pose, {}, 1.5f);
    return source ? source->at(pose, 0).lens.fov_y : -1.0f;
  };
  EXPECT_EQ(fov_of(""), 0.5f);
  EXPECT_EQ(fov_of("front"), 0.5f);
  EXPECT_EQ(fov_of("0"), 0.75f);  // A name before an index.
  EXPECT_EQ(fov_of("1"), 0.75f);
  const auto missing = CameraSource::create({.name_or_index = "back"}, pose, {}, 1.5f);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("0 (front), 1 (0)"), std::string::npos) << missing.error().message;
  EXPECT_FALSE(CameraSource::create({.name_or_index = "2"}, pose, {}, 1.5f));
}

TEST(CameraSource, FramesASceneWithoutCameras) {
  const Box bounds{{-3, 0, -5}, {7, 4, 1}};
  for (const float aspect : {0.5f, 1.0f, 2.0f}) {
    const auto source = CameraSource::create({}, Pose{}, bounds, aspect);
    ASSERT_TRUE(source);
    const ViewCamera camera = source->at({}, 0);
    const glm::mat4 camera_from_world = glm::inverse(camera.world_from_camera);
    const float slope = std::tan(0.5f * camera.lens.fov_y);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 at{corner & 1 ? bounds.min.x : bounds.max.x, corner & 2 ? bounds.min.y : bounds.max.y,
                         corner & 4 ? bounds.min.z : bounds.max.z};
      const glm::vec4 seen = camera_from_world * glm::vec4(at, 1);
      EXPECT_GT(-seen.z, camera.lens.near);
      EXPECT_LE(std::abs(seen.x), -seen.z * slope * aspect);
      EXPECT_LE(std::abs(seen.y), -seen.z * slope);
    }
  }
}

TEST(CameraSource, LooksAtItsTarget) {
  for (const glm::vec3 target : {glm::vec3(4, 2, 1), glm::vec3(1, 9, 1), glm::vec3(1, -9, 1)}) {
    const glm::mat4 camera = look_at(glm::vec3(1), target);
    EXPECT_NEAR(glm::dot(-glm::vec3(camera[2]), glm::normalize(target - glm::vec3(1))), 1, 1e-6f);
    EXPECT_NEAR(glm::determinant(glm::mat3(camera)), 1, 1e-5f);
  }
}

}  // namespace
