// What the program says to wrong usage and to input that is not there, and with which exit status. Needs no device.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace {

using Arguments = std::vector<std::string>;

/// The status, and one line on standard error that starts as promised and holds the text.
void expect_error(const Arguments& arguments, int status, const std::string& text) {
  const Outcome outcome = run_program(arguments);
  std::string line;
  for (const std::string& argument : arguments) line += argument + " ";
  EXPECT_EQ(outcome.status, status) << line << "\n" << outcome.err;
  EXPECT_EQ(outcome.out, "") << line;
  EXPECT_TRUE(outcome.err.starts_with("umbrage: error: ")) << line << "\n" << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << line << "\n" << outcome.err;
  EXPECT_NE(outcome.err.find(text), std::string::npos) << line << "\n" << outcome.err;
}

TEST(Usage, HelpListsWhatWorksAndNothingElse) {
  const Outcome outcome = run_program({"--help"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* command : {"render", "compare", "bench", "layered", "info"})
    EXPECT_NE(outcome.out.find(std::string("\n  ") + command + " "), std::string::npos) << command;
  for (const char* command : {"view", "diff"})
    EXPECT_EQ(outcome.out.find(std::string("\n  ") + command + " "), std::string::npos) << command;
  EXPECT_TRUE(run_program({"--version"}).out.starts_with("umbrage "));
}

TEST(Usage, EverySharedOptionIsInTheHelp) {
  for (const char* command : {"render", "compare"}) {
    const Outcome outcome = run_program({command, "--help"});
    EXPECT_EQ(outcome.status, 0);
    for (const char* option :
         {"--size",      "--camera",          "--eye",    "--target",      "--fov-y",
          "--time",      "--frames",          "--fps",    "--lights",      "--random-lights",
          "--seed",      "--no-scene-lights", "--preset", "--set",         "--budget",
          "--device",    "--validate",        "--show",   "--path",        "--trace",
          "--settings",  "--stats",           "--dump",   "--dump-lights", "--irradiance-threshold",
          "--show-light"})
      EXPECT_NE(outcome.out.find(std::string(option) + " "), std::string::npos) << command << ' ' << option;
  }
}

TEST(Usage, ShowListNamesTheDebugPicturesWithoutAScene) {
  const Outcome outcome = run_program({"render", "--show", "list"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name : {"image", "clusters", "explicit-bounds", "lights-per-pixel", "normals", "depth", "resolution",
                           "texels-per-pixel", "pages", "triangles-per-map", "projection-maps", "cube-projection"})
    EXPECT_NE(std::string("\n").append(outcome.out).find(std::string("\n").append(name).append(" ")), std::string::npos)
        << outcome.out;
}

TEST(Usage, ListsPresetsAndSettingsWithoutAScene) {
  const Outcome presets = run_program({"render", "--preset", "list"});
  EXPECT_EQ(presets.status, 0) << presets.err;
  EXPECT_NE(presets.out.find("fixed-cubes  "), std::string::npos) << presets.out;
  const Outcome settings = run_program({"compare", "--set", "list"});
  EXPECT_EQ(settings.status, 0) << settings.err;
  EXPECT_NE(settings.out.find("\nwriter=automatic|traditional|multi_draw|compute|fragments  "), std::string::npos)
      << settings.out;
}

TEST(Usage, WrongCommandsExitWith2) {
  expect_error({}, 2, "--help");
  expect_error({"view", "builtin:houses"}, 2,
               "there is no command \"view\"; choose from render, compare, bench, layered, info");
  expect_error({"bench", "-o", "x"}, 2, "SUITE is required");
  expect_error({"bench", "other", "-o", "x"}, 2, "layered");
  expect_error({"bench", "layered"}, 2, "--output is required");
  expect_error({"--bad"}, 2, "");
  expect_error({"render"}, 2, "SCENE is required");
  expect_error({"render", "a.gltf"}, 2, "--output is required");
  expect_error({"render", "a.gltf", "-o", "a.png", "more"}, 2, "more");
  expect_error({"info", "--device", "0"}, 2, "--recommend");
}

TEST(Usage, WrongValuesExitWith2AndNameTheOption) {
  const std::vector<Arguments> cases = {
      {"--size", "0x0"},    {"--size", "12"},          {"--size", "-4x4"},       {"--size", "20000x1"},
      {"--size", "64x64 "}, {"--time", "nan"},         {"--time", "-1"},         {"--time", "1s"},
      {"--frames", "0"},    {"--frames", "-3"},        {"--frames", "1.5"},      {"--fps", "0"},
      {"--fps", "inf"},     {"--random-lights", "-1"}, {"--random-lights", "x"}, {"--preset", "no-such"},
      {"--set", "writer"},  {"--set", "no_such=1"},    {"--set", "writer=slow"}, {"--set", "max_resolution=99999"},
      {"--budget", "0"},    {"--budget", "-1"},        {"--show", "no-such"},    {"--irradiance-threshold", "0"},
      {"--fov-y", "0"},     {"--fov-y", "180"},
  };
  for (const Arguments& wrong : cases) {
    Arguments arguments = {"render", "a.gltf", "-o", "a.png"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    expect_error(arguments, 2, wrong[0]);
  }
}

TEST(Usage, UnknownNamesAreAnsweredWithTheKnownOnes) {
  const Arguments render = {"render", "a.gltf", "-o", "a.png"};
  const auto with = [&](const char* option, const char* value) {
    Arguments arguments = render;
    arguments.insert(arguments.end(), {option, value});
    return arguments;
  };
  expect_error(with("--preset", "x"), 2, "fixed-cubes");
  expect_error(with("--set", "x=1"), 2, "max_resolution");
  expect_error(with("--show", "x"), 2, "explicit-bounds");
}

TEST(Usage, OptionsThatNeedOrExcludeEachOther) {
  const Arguments cases[] = {
      {"--eye", "1,2,3"},
      {"--target", "1,2,3"},
      {"--eye", "1,2,3", "--target", "0,0,0", "--camera", "0"},
      {"--path", "p.json", "--camera", "0"},
      {"--path", "p.json", "--eye", "1,2,3", "--target", "0,0,0"},
      {"--seed", "4"},
      {"--dump-lights", "0"},
      {"--size", "64x64", "--size", "32x32"},
  };
  for (const Arguments& wrong : cases) {
    Arguments arguments = {"render", "a.gltf", "-o", "a.png"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    expect_error(arguments, 2, wrong[0]);
  }
  expect_error({"render", "a.gltf", "-o", "%d-%04d.png"}, 2, "more than one place");
  expect_error({"render", "a.gltf", "-o", "a.jpg"}, 2, "end the name in .png");
}

TEST(Usage, MissingOrBrokenInputExitsWith1AndNamesIt) {
  const TemporaryFolder folder;
  const std::string image = folder.file("out.png"), room = data_file("room.gltf");
  const auto render = [&](const std::string& scene, const Arguments& more) {
    Arguments arguments = {"render", scene, "-o", image};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect_error(render("no/such.gltf", {}), 1, "no/such.gltf");
  expect_error(render("builtin:no-such", {}), 1, "houses");
  expect_error(render(folder.write("broken.gltf", "{"), {}), 1, "broken.gltf");
  expect_error(render(room, {"--camera", "back"}), 1, "0 (front)");
  expect_error(render(room, {"--lights", "no-such.json"}), 1, "no-such.json");
  const auto lights = folder.write(
      "lights.json",
      R"({"lights": [{"type": "point", "position": [0,0,0]}, {"type": "point", "position": [0,0,0], "range": -1}]})");
  expect_error(render(room, {"--lights", lights}), 1, "lights.json: lights[1].range must be > 0");
  expect_error(render(room, {"--path", folder.write("path.json", R"({"keys": 3})")}), 1, "path.json: keys must be");
  expect_error(render(room, {"--settings", folder.write("s.json", R"({"writer": "slow"})")}), 1, "s.json: writer");
  expect_error(render(room, {"--settings", folder.write("t.json", R"({"speed": 1})")}), 1, "t.json: speed");
  expect_error(render(room, {"--eye", "1,1,1", "--target", "1,1,1"}), 1, "same point");
  EXPECT_FALSE(std::filesystem::exists(image));
}

TEST(Usage, PlacesThatCannotBeWrittenAreToldBeforeTheSceneIsRead) {
  const TemporaryFolder folder;
  const std::string scene = "no/such.gltf", image = folder.file("a.png"), missing = folder.file("missing/s.json");
  expect_error({"render", scene, "-o", folder.file("missing/a.png")}, 1, "missing/a.png: cannot be written");
  expect_error({"render", scene, "-o", image, "--stats", missing}, 1, "missing/s.json: cannot be written");
  expect_error({"render", scene, "-o", image, "--trace", missing}, 1, "missing/s.json: cannot be written");
  expect_error({"compare", scene, "-o", missing}, 1, "missing/s.json: cannot be written");
  expect_error({"render", scene, "-o", folder.file("")}, 1, "is a folder");
}

TEST(Usage, AMessageStaysOneLineWhateverTheFileHolds) {
  const TemporaryFolder folder;
  const auto lights = folder.write("lights.json", R"({"lights": [], "two\nlines\u001b[31m": 1})");
  expect_error({"render", data_file("room.gltf"), "-o", folder.file("a.png"), "--lights", lights}, 1, "two lines");
}

}  // namespace
