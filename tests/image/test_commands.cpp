// render, compare and info on a small scene: what they write, and that nothing half-written stays.
#include <gtest/gtest.h>
#include <signal.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using Names = std::set<std::string>;

/// The room has four lights: bulb (point), lamp (spot), moon (directional), endless (a point without a range).
constexpr uint32_t kWidth = 160, kHeight = 96, kRoomLights = 4;

Arguments room(const std::string& command, const Arguments& more) {
  Arguments arguments = {command, data_file("room.gltf"), "--size", "160x96"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

constexpr const char* kShows[] = {
    "clusters",         "explicit-bounds", "lights-per-pixel",  "normals",         "depth",          "resolution",
    "texels-per-pixel", "pages",           "triangles-per-map", "projection-maps", "cube-projection"};
constexpr const char* kShowsOfLights[] = {"resolution", "texels-per-pixel", "pages", "triangles-per-map",
                                          "projection-maps"};

Outcome run_well(const Arguments& arguments) {
  Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return outcome;
}

std::vector<uint8_t> pixels_of(const fs::path& path) {
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels = stbi_load(path.c_str(), &width, &height, &channels, 3);
  EXPECT_NE(pixels, nullptr) << path;
  if (!pixels) return {};
  EXPECT_EQ(width, int(kWidth));
  EXPECT_EQ(height, int(kHeight));
  std::vector<uint8_t> copy(pixels, pixels + size_t(width) * static_cast<size_t>(height) * 3);
  stbi_image_free(pixels);
  return copy;
}

/// The array's bytes; the header must say so much.
std::string array_of(const fs::path& path, const std::string& type, const std::string& shape) {
  const std::string text = read_all(path);
  const std::string wanted = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  EXPECT_EQ(text.substr(10, wanted.size()), wanted) << path;
  const size_t start = 10 + static_cast<uint8_t>(text[8]) + 256u * static_cast<uint8_t>(text[9]);
  return text.substr(start);
}

std::vector<float> floats_of(const fs::path& path) {
  const std::string bytes = array_of(path, "<f4", "96, 160, 3");
  std::vector<float> values(bytes.size() / 4);
  std::memcpy(values.data(), bytes.data(), values.size() * 4);
  EXPECT_EQ(values.size(), size_t(kWidth) * kHeight * 3);
  return values;
}

TEST(Render, WritesAPictureThatShowsSomething) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("a.png")}));
  EXPECT_EQ(folder.names(), Names{"a.png"});
  const std::vector<uint8_t> pixels = pixels_of(folder.file("a.png"));
  EXPECT_GT(std::set<uint8_t>(pixels.begin(), pixels.end()).size(), 32u);
}

TEST(Render, EveryLightLightsAndCastsShadows) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("a.png"), "--dump", folder.file("d")}));
  const std::string visibility = array_of(folder.file("d") / "visibility.npy", "|u1", "4, 96, 160");
  for (size_t light = 0; light < kRoomLights; ++light) {
    const std::string row = visibility.substr(light * kWidth * kHeight, kWidth * kHeight);
    EXPECT_GT(std::count(row.begin(), row.end(), '\0'), 20) << "light " << light << " casts no shadow";
    EXPECT_GT(std::count(row.begin(), row.end(), '\xfe'), 20) << "light " << light << " lights nothing";
  }
}

TEST(Render, WhatALightDoesNotSeeIsDarker) {
  const TemporaryFolder folder;
  const auto bulb = folder.write("bulb.json", R"({"lights": [{"type": "point", "position": [0.3, 2.5, 1],
                                                              "intensity": 12, "range": 30}]})");
  run_well(
      room("render", {"-o", folder.file("a.png"), "--no-scene-lights", "--lights", bulb, "--dump", folder.file("d")}));
  const std::vector<float> normal = floats_of(folder.file("d") / "normal.npy");
  const std::vector<float> color = floats_of(folder.file("d") / "color.npy");
  const std::string visibility = array_of(folder.file("d") / "visibility.npy", "|u1", "1, 96, 160");
  double sum[2] = {};
  size_t count[2] = {};
  for (size_t pixel = 0; pixel < visibility.size(); ++pixel) {
    const auto seen = static_cast<uint8_t>(visibility[pixel]);
    if (normal[3 * pixel + 1] < 0.9f || (seen != 0 && seen != 254)) continue;  // The floor and the tops of the boxes.
    sum[seen == 254] += double(color[3 * pixel]);
    ++count[seen == 254];
  }
  ASSERT_GT(count[0], 20u);
  ASSERT_GT(count[1], 200u);
  EXPECT_LT(sum[0] / double(count[0]), 0.5 * sum[1] / double(count[1]));
}

TEST(Render, WritesEveryFrameOfASequenceAndOnlyTheLastOtherwise) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("f-%04d.png"), "--frames", "3", "--fps", "2"}));
  EXPECT_EQ(folder.names(), (Names{"f-0000.png", "f-0001.png", "f-0002.png"}));
  EXPECT_NE(pixels_of(folder.file("f-0000.png")), pixels_of(folder.file("f-0002.png")));  // A box slides.
  run_well(room("render", {"-o", folder.file("last.png"), "--frames", "3", "--fps", "2"}));
  run_well(room("render", {"-o", folder.file("at1s.png"), "--time", "1"}));
  EXPECT_EQ(pixels_of(folder.file("last.png")), pixels_of(folder.file("f-0002.png")));
  EXPECT_EQ(pixels_of(folder.file("at1s.png")), pixels_of(folder.file("f-0002.png")));
}

TEST(Render, TwoRunsGiveTheSameBytes) {
  const TemporaryFolder folder;
  for (const char* run : {"a", "b"})
    run_well(room("render", {"-o", folder.file(std::string(run) + ".png"), "--dump", folder.file(run),
                             "--random-lights", "40", "--seed", "9"}));
  EXPECT_EQ(read_all(folder.file("a.png")), read_all(folder.file("b.png")));
  for (const char* name : {"position.npy", "normal.npy", "color.npy", "visibility.npy", "lights.json"})
    EXPECT_EQ(read_all(folder.file("a") / name), read_all(folder.file("b") / name)) << name;
}

TEST(Render, StatisticsHoldEveryKey) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("a.png"), "--stats", folder.file("s.json"), "--frames", "4"}));
  const nlohmann::json stats = parse_json(read_all(folder.file("s.json")));
  for (const char* key : {"device",
                          "driver",
                          "preset",
                          "settings",
                          "size",
                          "frame_ms",
                          "wall_ms",
                          "cpu_record_ms",
                          "passes",
                          "lights",
                          "lights_visible",
                          "lighting_computations",
                          "clusters",
                          "cluster_light_pairs",
                          "shadow_maps",
                          "pages_requested",
                          "pages_resident",
                          "pages_rendered",
                          "texels_allocated",
                          "batches_drawn",
                          "triangles_drawn",
                          "shadow_memory_bytes",
                          "table_memory_bytes",
                          "unbacked_taps",
                          "unmarked_taps",
                          "overflows",
                          "lights_degraded"})
    EXPECT_TRUE(stats.contains(key)) << key;
  EXPECT_EQ(stats["size"], (std::vector<uint32_t>{kWidth, kHeight}));
  EXPECT_EQ(stats["preset"], "default");
  EXPECT_EQ(stats["lights"], kRoomLights);
  EXPECT_EQ(stats["lights_visible"], kRoomLights);
  EXPECT_EQ(stats["unbacked_taps"], 0);
  EXPECT_EQ(stats["overflows"], 0);
  EXPECT_EQ(stats["frames"], 4);
  for (const char* key : {"frame_ms", "wall_ms", "cpu_record_ms", "clusters", "lighting_computations", "shadow_maps",
                          "batches_drawn", "triangles_drawn", "shadow_memory_bytes", "table_memory_bytes"})
    EXPECT_GT(stats[key], 0) << key;
  EXPECT_GE(stats["lighting_computations"], stats["clusters"]);
  double passes_ms = 0;
  for (const auto& pass : stats["passes"].items()) passes_ms += pass.value().get<double>();
  EXPECT_GT(passes_ms, 0);
  EXPECT_GT(stats["passes"].size(), 4u);
}

class ShortLists : public testing::TestWithParam<const char*> {};

TEST_P(ShortLists, ChangeNothing) {
  const TemporaryFolder folder;
  const Arguments many = {"--random-lights", "400", "--preset", GetParam(), "--stats", folder.file("s.json")};
  const auto render = [&](const std::string& name, const Arguments& more) {
    Arguments arguments = room("render", many);
    arguments.insert(arguments.end(), {"-o", folder.file(name)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_well(arguments);
  };
  render("long.png", {});
  const nlohmann::json needed = parse_json(read_all(folder.file("s.json")));
  ASSERT_GT(needed["cluster_light_pairs"], 1024);
  if (std::string(GetParam()) == "fixed-cubes") { ASSERT_GT(needed["caster_pairs"], 1024); }
  render("short.png", {"--set", "max_cluster_light_pairs=1024", "--set", "max_caster_pairs=1024"});
  EXPECT_EQ(parse_json(read_all(folder.file("s.json")))["overflows"], 0);
  EXPECT_EQ(read_all(folder.file("short.png")), read_all(folder.file("long.png")));
}

INSTANTIATE_TEST_SUITE_P(Presets, ShortLists, testing::Values("fixed-cubes", "default"));

TEST(Render, SettingsComeFromPresetFileAssignmentAndBudgetInThisOrder) {
  const TemporaryFolder folder;
  const auto settings_of = [&](const Arguments& more) {
    Arguments arguments = room("render", {"-o", folder.file("a.png"), "--stats", folder.file("s.json")});
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_well(arguments);
    return parse_json(read_all(folder.file("s.json")))["settings"];
  };
  const nlohmann::json changed = settings_of(
      {"--preset", "fixed-cubes", "--set", "max_resolution=256", "--set", "writer=traditional", "--budget", "64"});
  EXPECT_EQ(changed["max_resolution"], 256);
  EXPECT_EQ(changed["writer"], "traditional");
  EXPECT_EQ(changed["budget_mib"], 64);
  const auto file = folder.write("settings.json", changed.dump());
  EXPECT_EQ(settings_of({"--settings", file}), changed);
  EXPECT_EQ(settings_of({"--settings", file, "--set", "max_resolution=128"})["max_resolution"], 128);
}

TEST(Render, DumpsArraysThatAgreeWithEachOther) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("a.png"), "--dump", folder.file("d")}));
  const std::vector<float> position = floats_of(folder.file("d") / "position.npy");
  const std::vector<float> normal = floats_of(folder.file("d") / "normal.npy");
  const std::vector<float> color = floats_of(folder.file("d") / "color.npy");
  const std::string visibility = array_of(folder.file("d") / "visibility.npy", "|u1", "4, 96, 160");
  size_t background = 0;
  for (size_t pixel = 0; pixel < size_t(kWidth) * kHeight; ++pixel) {
    const float* p = &position[3 * pixel];
    const float* n = &normal[3 * pixel];
    if (std::isnan(p[0])) {
      ++background;
      for (size_t light = 0; light < kRoomLights; ++light)
        ASSERT_EQ(static_cast<uint8_t>(visibility[light * kWidth * kHeight + pixel]), 255);
      continue;
    }
    EXPECT_GE(p[1], -0.01f);
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 0.01f);
    for (size_t c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(color[3 * pixel + c]));
  }
  EXPECT_GT(background, 0u);
  EXPECT_LT(background, size_t(kWidth) * kHeight / 2);

  const nlohmann::json lights = parse_json(read_all(folder.file("d") / "lights.json"))["lights"];
  ASSERT_EQ(lights.size(), kRoomLights);
  EXPECT_EQ(lights[0]["name"], "bulb");
  EXPECT_EQ(lights[1]["type"], "spot");
  EXPECT_NEAR(lights[1]["outer_cone_deg"], 34.377, 1e-3);
  EXPECT_EQ(lights[2]["type"], "directional");
  EXPECT_NEAR(lights[3]["range"], std::sqrt(2 / 0.01), 1e-3);  // √(intensity / threshold)
}

TEST(Render, ADumpedLightsFileGivesTheSamePicture) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("a.png"), "--dump", folder.file("d"), "--random-lights", "12"}));
  const std::string lights = folder.file("d") / "lights.json";
  run_well(room("render", {"-o", folder.file("b.png"), "--no-scene-lights", "--lights", lights}));
  EXPECT_EQ(read_all(folder.file("a.png")), read_all(folder.file("b.png")));
}

TEST(Render, DumpLightsChoosesRows) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("a.png"), "--dump", folder.file("all")}));
  run_well(room("render", {"-o", folder.file("a.png"), "--dump", folder.file("two"), "--dump-lights", "3,1"}));
  const size_t row = kWidth * kHeight;
  const std::string all = array_of(folder.file("all") / "visibility.npy", "|u1", "4, 96, 160");
  const std::string two = array_of(folder.file("two") / "visibility.npy", "|u1", "2, 96, 160");
  EXPECT_EQ(two, all.substr(row, row) + all.substr(3 * row, row));
  EXPECT_EQ(parse_json(read_all(folder.file("two") / "lights.json"))["lights"][1]["name"], "endless");
  const Outcome beyond =
      run_program(room("render", {"-o", folder.file("a.png"), "--dump", folder.file("none"), "--dump-lights", "4"}));
  EXPECT_EQ(beyond.status, 1);
  EXPECT_NE(beyond.err.find("there is no light 4"), std::string::npos) << beyond.err;
  EXPECT_FALSE(fs::exists(folder.file("none")));
}

TEST(Render, EveryDebugPictureDiffersFromTheImage) {
  const TemporaryFolder folder;
  Names different;
  run_well(room("render", {"-o", folder.file("image.png")}));
  different.insert(read_all(folder.file("image.png")));
  for (const char* show : kShows) {
    run_well(room("render", {"-o", folder.file("show.png"), "--show", show}));
    EXPECT_TRUE(different.insert(read_all(folder.file("show.png"))).second) << show;
    run_well(room("render", {"-o", folder.file("again.png"), "--show", show}));
    EXPECT_EQ(read_all(folder.file("again.png")), read_all(folder.file("show.png"))) << show;
  }
}

TEST(Render, DebugPicturesOfMapsAreAboutTheLightAskedFor) {
  const TemporaryFolder folder;
  for (const char* show : kShowsOfLights) {
    Names different;
    for (const char* light : {"0", "1", "3"}) {
      run_well(room("render", {"-o", folder.file("show.png"), "--show", show, "--show-light", light}));
      EXPECT_TRUE(different.insert(read_all(folder.file("show.png"))).second) << show << ' ' << light;
    }
  }
  const auto refuse = [&](const Arguments& more, const char* text) {
    Arguments arguments = room("render", {"-o", folder.file("none.png")});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder.file("none.png")));
  };
  refuse({"--show", "pages", "--show-light", "4"}, "there is no light 4");
  refuse({"--show", "depth", "--show-light", "0"}, "not about one light");
  for (const char* show : {"pages", "triangles-per-map", "projection-maps"})
    refuse({"--show", show, "--preset", "fixed-cubes"}, "store=page_pool");
}

TEST(Render, FixedCubesHaveDebugPicturesOfTheirOneResolution) {
  const TemporaryFolder folder;
  for (const char* show : {"resolution", "texels-per-pixel"}) {
    Names different;
    for (const char* side : {"64", "256"}) {
      const std::string smallest = std::string("min_resolution=") + side,
                        largest = std::string("max_resolution=") + side;
      run_well(room("render", {"-o", folder.file("show.png"), "--preset", "fixed-cubes", "--set", smallest, "--set",
                               largest, "--show", show}));
      different.insert(read_all(folder.file("show.png")));
    }
    // The cube is the light's, whatever its map.
    EXPECT_EQ(different.size(), 2u) << show;
  }
  run_well(room("render", {"-o", folder.file("show.png"), "--preset", "fixed-cubes", "--show", "cube-projection"}));
}

TEST(Render, EveryPixelSeesAMarkedPage) {
  const TemporaryFolder folder;
  for (const char* light : {"0", "1", "2", "3"}) {
    run_well(room("render", {"-o", folder.file("pages.png"), "--show", "pages", "--show-light", light}));
    const std::vector<uint8_t> pixels = pixels_of(folder.file("pages.png"));
    size_t unmarked = 0;  // Magenta, dimmed where the image is dark.
    for (size_t i = 0; i < pixels.size(); i += 3)
      unmarked += pixels[i] > 100 && pixels[i] == pixels[i + 2] && pixels[i + 1] == 0;
    EXPECT_EQ(unmarked, 0u) << light;
  }
}

TEST(Render, ACameraOfOnesOwnAndAPathAgree) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("path.json", R"({"keys": [{"time": 0, "eye": [3, 1, 5], "target": [0, 1, 0], "fov": 50},
                                                           {"time": 2, "eye": [-1, 3, 5], "target": [0, 1, 0], "fov": 50}]})");
  run_well(room("render", {"-o", folder.file("eye.png"), "--eye", "3,1,5", "--target", "0,1,0", "--fov-y", "50"}));
  run_well(room("render", {"-o", folder.file("path.png"), "--path", path}));
  run_well(room("render", {"-o", folder.file("path-later.png"), "--path", path, "--time", "2"}));
  EXPECT_EQ(pixels_of(folder.file("eye.png")), pixels_of(folder.file("path.png")));
  EXPECT_NE(pixels_of(folder.file("eye.png")), pixels_of(folder.file("path-later.png")));
}

TEST(Render, TheTraceIsOneThatViewersOpen) {
  const TemporaryFolder folder;
  run_well(room("render", {"-o", folder.file("a.png"), "--trace", folder.file("t.json")}));
  const nlohmann::json events = parse_json(read_all(folder.file("t.json")))["traceEvents"];
  double end = 0;
  size_t passes = 0;
  for (const auto& event : events) {
    if (event["ph"] != "X" || event["cat"] != "gpu") continue;
    EXPECT_GE(event["ts"].get<double>(), end - 1e-6);
    end = event["ts"].get<double>() + event["dur"].get<double>();
    ++passes;
  }
  EXPECT_GT(passes, 4u);
}

TEST(Render, LeavesNothingWhenItFails) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(room("render", {"-o", folder.file("missing/a.png")}));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("missing/a.png"), std::string::npos) << outcome.err;
  EXPECT_TRUE(folder.names().empty());
}

TEST(Render, LeavesNothingHalfWrittenWhenInterrupted) {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder, said;
    const pid_t process = start_program(room("render", {"-o", folder.file("f-%06d.png"), "--frames", "1000000"}),
                                        said.file("out"), said.file("err"));
    for (int i = 0; i < 6000 && folder.names().size() < 3; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_GE(folder.names().size(), 3u) << read_all(said.file("err"));
    kill(process, signal_number);
    EXPECT_EQ(wait_for(process), -signal_number);
    for (const std::string& name : folder.names()) {
      ASSERT_TRUE(name.ends_with(".png")) << name;
      pixels_of(folder.file(name));
    }
  }
}

TEST(Render, AnUnknownDeviceIsAnsweredWithTheKnownOnes) {
  const Outcome outcome = run_program(room("render", {"-o", "a.png", "--device", "no such device"}));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("no such device"), std::string::npos) << outcome.err;
  const nlohmann::json info = parse_json(run_well({"info", "--json"}).out);
  EXPECT_NE(outcome.err.find(info["devices"][0]["name"].get<std::string>()), std::string::npos) << outcome.err;
}

TEST(Compare, ReportsOnStandardOutputOrInAFile) {
  const TemporaryFolder folder;
  const nlohmann::json report = parse_json(run_well(room("compare", {})).out);
  for (const char* key : {"wrong_outside_band", "wrong_inside_band", "wrong_outside_texel_band", "false_lit",
                          "false_dark", "luminance_rmse", "worst_lights", "device", "settings", "frame_ms", "passes"})
    EXPECT_TRUE(report.contains(key)) << key;
  EXPECT_GT(report["pairs"]["evaluated"], size_t(kWidth) * kHeight);
  EXPECT_EQ(report["pairs"]["missing"], 0);
  EXPECT_EQ(report["pairs"]["unexpected"], 0);
  EXPECT_LE(report["wrong_outside_texel_band"], 0.005);
  EXPECT_GT(report["texels_needed"], 1000u);
  EXPECT_LT(report["texels_needed"], report["texels_allocated"].get<uint64_t>());
  EXPECT_GT(report["triangles_needed"], 10u);
  EXPECT_LE(report["triangles_needed"], report["triangles_drawn"].get<uint64_t>());
  const Outcome silent = run_well(room("compare", {"-o", folder.file("r.json")}));
  EXPECT_EQ(silent.out, "");
  EXPECT_EQ(parse_json(read_all(folder.file("r.json")))["pairs"], report["pairs"]);
}

TEST(Compare, SeesWhenMapsAreTooCoarse) {
  const Arguments coarse = {"--set", "min_resolution=16", "--set", "max_resolution=16"};
  const nlohmann::json fine = parse_json(run_well(room("compare", {})).out);
  const nlohmann::json rough = parse_json(run_well(room("compare", coarse)).out);
  EXPECT_GT(rough["wrong_outside_band"].get<double>(), fine["wrong_outside_band"].get<double>());
  EXPECT_GT(rough["wrong_outside_band"].get<double>(), 0.001);
}

TEST(Validation, IsSilentOnEveryWriterAndPicture) {
  const TemporaryFolder folder;
  if (!parse_json(run_well({"info", "--json"}).out)["validation_layer"])
    GTEST_SKIP() << "the validation layers are not installed";
  const std::pair<const char*, const char*> writers[] = {{"fixed-cubes", "writer=traditional"},
                                                         {"fixed-cubes", "writer=multi_draw"},
                                                         {"default", "writer=compute"},
                                                         {"default", "writer=fragments"}};
  for (const auto& [preset, writer] : writers)
    run_well(room("render", {"-o", folder.file("a.png"), "--validate", "--frames", "3", "--preset", preset, "--set",
                             writer, "--dump", folder.file("d")}));
  for (const char* show : kShows) run_well(room("render", {"-o", folder.file("a.png"), "--validate", "--show", show}));
}

TEST(Info, SaysWhatEachDeviceCanDo) {
  const nlohmann::json info = parse_json(run_well({"info", "--json"}).out);
  ASSERT_GE(info["devices"].size(), 1u);
  for (const auto& device : info["devices"]) {
    for (const char* key : {"index", "name", "type", "driver", "api", "supported", "checks", "modes"})
      EXPECT_TRUE(device.contains(key)) << key;
    EXPECT_TRUE(device["supported"].get<bool>() || !device["reason"].get<std::string>().empty());
    EXPECT_EQ(device["modes"][0]["preset"], "default");
  }
  const std::string text = run_well({"info"}).out;
  EXPECT_NE(text.find(info["devices"][0]["name"].get<std::string>()), std::string::npos);
  EXPECT_NE(text.find("bufferDeviceAddress"), std::string::npos);
  EXPECT_NE(text.find("fixed-cubes"), std::string::npos);
}

}  // namespace
