// The command line's options that commands share, read strictly.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands/active_lights.hpp"
#include "commands/camera_source.hpp"
#include "commands/parse.hpp"
#include "commands/settings_choice.hpp"
#include "host/renderer.hpp"

namespace app {

enum class SceneLights : uint8_t { used, left_out };

/// Options of render and compare. Paths that are empty were not given.
struct SharedOptions {
  std::string scene;
  Extent size;
  CameraOptions camera;
  std::filesystem::path path_file;
  double time_s = 0;
  uint32_t frames = 1;
  double fps = 30;
  std::filesystem::path lights_file;
  uint32_t random_lights = 0;
  uint64_t seed = 1;
  SceneLights scene_lights = SceneLights::used;
  double irradiance_threshold = kIrradianceThreshold;
  SettingsOptions settings;
  std::string device;
  bool validate = false;
  Show show = Show::image;
  std::optional<uint32_t> show_light;
  std::optional<glm::vec4> mirror_ball;  ///< Middle and radius.
  std::filesystem::path stats_file, trace_file, dump_folder;
  std::vector<IndexRange> dump_lights;  ///< Empty: all.
};

/// Adds them to a subcommand; options must live as long as it. Wrong values throw CLI::ValidationError while parsing.
void add_shared_options(CLI::App& command, SharedOptions& options);
/// Of render alone: the ray tracer knows no mirrors.
void add_mirror_option(CLI::App& command, SharedOptions& options);

}  // namespace app
