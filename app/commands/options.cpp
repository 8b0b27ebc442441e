// The command line's shared options.
#include "commands/options.hpp"

#include <iostream>
#include <numbers>
#include <utility>

#include "scenes/builtin.hpp"

namespace app {
namespace {

constexpr uint64_t kMaxFrames = 1'000'000, kMaxRandomLights = 65'536, kMaxBudgetMib = 1u << 24;
constexpr double kMaxTimeS = 1e6;

/// An option whose text goes through a strict reader; its error becomes wrong usage.
template <class Read>
CLI::Option* add_read(CLI::App& command, const std::string& name, const std::string& value_name, Read read,
                      const std::string& summary) {
  const auto take = [name, read = std::move(read)](const std::string& text) {
    const umbrage::Result<void> result = read(text);
    if (!result) throw CLI::ValidationError(name, result.error().message);
  };
  return command.add_option_function<std::string>(name, take, summary)->type_name(value_name);
}

/// A reader that keeps the value it made.
template <class Parse, class Keep>
auto reader(Parse parse, Keep keep) {
  return [parse, keep](const std::string& text) -> umbrage::Result<void> {
    const auto value = parse(text);
    if (!value) return value.error();
    keep(*value);
    return {};
  };
}

auto number_reader(double& target, double min, double max) {
  return reader([=](const std::string& text) { return parse_number(text, min, max); },
                [&target](double value) { target = value; });
}

template <class T>
auto count_reader(T& target, uint64_t min, uint64_t max) {
  return reader([=](const std::string& text) { return parse_count(text, min, max); },
                [&target](uint64_t value) { target = static_cast<T>(value); });
}

umbrage::Result<Show> parse_show(const std::string& name) {
  std::vector<std::string> names;
  for (const ShowInfo& info : shows()) {
    if (name == info.name) return info.show;
    names.emplace_back(info.name);
  }
  return invalid("there is no \"" + name + "\"; choose from " + join_names(names));
}

void print_shows() {
  for (const ShowInfo& info : shows()) std::cout << info.name << "  " << info.summary << '\n';
}

void print_presets() {
  for (const umbrage::Preset& preset : umbrage::presets()) std::cout << preset.name << "  " << preset.summary << '\n';
}

void print_settings() {
  for (const umbrage::SettingInfo& info : umbrage::setting_infos())
    std::cout << info.key << "=" << info.values << "  " << info.summary << '\n';
}

std::string scene_summary() {
  std::string names;
  for (const BuiltinInfo& info : builtin_scenes()) names.append(names.empty() ? "" : ", ").append(info.name);
  return "A .gltf or .glb file, or builtin:NAME (" + names + ")";
}

void add_camera_options(CLI::App& command, SharedOptions& options) {
  CameraOptions& camera = options.camera;
  auto* name = command
                   .add_option("--camera", camera.name_or_index,
                               "One of the scene's cameras; else the first, else one "
                               "that frames the scene")
                   ->type_name("NAME-OR-INDEX");
  auto* eye = add_read(command, "--eye", "X,Y,Z", reader(parse_vec3, [&](const glm::vec3& v) { camera.eye = v; }),
                       "A camera of one's own: where it is");
  auto* target = add_read(command, "--target", "X,Y,Z",
                          reader(parse_vec3, [&](const glm::vec3& v) { camera.target = v; }), "What it looks at");
  const auto parse_fov = [](const std::string& text) { return parse_number(text, 1, 170); };
  add_read(
      command, "--fov-y", "DEG",
      reader(parse_fov, [&](double degrees) { camera.fov_y = static_cast<float>(degrees * std::numbers::pi / 180); }),
      "Vertical angle of view, 1…170; 60 for a camera of one's own");
  auto* path = command.add_option("--path", options.path_file, "Camera path: keys of time, eye, target, fov")
                   ->type_name("FILE.json");
  eye->needs(target)->excludes(name);
  target->needs(eye);
  path->excludes(name)->excludes(eye);
}

void add_light_options(CLI::App& command, SharedOptions& options) {
  command.add_option("--lights", options.lights_file, "Lights added to the scene's own")->type_name("FILE.json");
  auto* random = add_read(command, "--random-lights", "N", count_reader(options.random_lights, 0, kMaxRandomLights),
                          "N point lights over surfaces that the scene's cameras see");
  add_read(command, "--seed", "S", count_reader(options.seed, 0, UINT64_MAX), "Of the random lights; 1")->needs(random);
  command.add_flag_callback(
      "--no-scene-lights", [&] { options.scene_lights = SceneLights::left_out; }, "Leave out the scene's own lights");
  add_read(command, "--irradiance-threshold", "LUX", number_reader(options.irradiance_threshold, 1e-9, 1e9),
           "A light without a range ends where it gives less; 0.01");
}

void add_settings_options(CLI::App& command, SharedOptions& options) {
  SettingsOptions& settings = options.settings;
  add_read(
      command, "--preset", "NAME",
      [&](const std::string& name) -> umbrage::Result<void> {
        if (name == "list") {
          print_presets();
          throw CLI::Success();
        }
        const auto known = umbrage::preset(name);
        if (!known) return known.error();
        settings.preset = name;
        return {};
      },
      "A row of the preset table; default. list names them");
  command.add_option("--settings", settings.file, "A settings file, applied to the preset")->type_name("FILE.json");
  const auto take_assignment = [&](const std::vector<std::string>& assignments) {
    for (const std::string& assignment : assignments) {
      if (assignment == "list") {
        print_settings();
        throw CLI::Success();
      }
      umbrage::Settings scratch;
      const auto set = apply_assignment(assignment, scratch);
      if (!set) throw CLI::ValidationError("--set", set.error().message);
    }
    settings.assignments = assignments;
  };
  command
      .add_option_function<std::vector<std::string>>("--set", take_assignment,
                                                     "One field of the settings; repeatable. list names them")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const auto parse_budget = [](const std::string& text) { return parse_count(text, 1, kMaxBudgetMib); };
  add_read(command, "--budget", "MIB",
           reader(parse_budget, [&](uint64_t mib) { settings.budget_mib = static_cast<uint32_t>(mib); }),
           "Memory for shadow texels; 256");
}

void add_output_options(CLI::App& command, SharedOptions& options) {
  const auto take_show = [&](const std::string& name) {
    if (name == "list") {
      print_shows();
      throw CLI::Success();
    }
    const auto show = parse_show(name);
    if (!show) throw CLI::ValidationError("--show", show.error().message);
    options.show = *show;
  };
  auto* show = command
                   .add_option_function<std::string>("--show", take_show,
                                                     "A debug picture instead of the image; list names them")
                   ->type_name("NAME");
  const auto parse_light = [](const std::string& text) { return parse_count(text, 0, UINT32_MAX - 1); };
  add_read(command, "--show-light", "INDEX",
           reader(parse_light, [&](uint64_t index) { options.show_light = static_cast<uint32_t>(index); }),
           "The light that the debug picture is about, as in --dump's lights; else it chooses")
      ->needs(show);
  command.add_option("--stats", options.stats_file, "The last frame's statistics")->type_name("FILE.json");
  command.add_option("--trace", options.trace_file, "The last frame's passes as a trace that Perfetto opens")
      ->type_name("FILE.json");
  auto* dump = command.add_option("--dump", options.dump_folder, "Raw arrays of the last frame, and its lights")
                   ->type_name("DIR");
  add_read(command, "--dump-lights", "LIST",
           reader(parse_index_list, [&](const std::vector<IndexRange>& list) { options.dump_lights = list; }),
           "Only these lights, such as 0,5,10-20")
      ->needs(dump);
}

}  // namespace

void add_shared_options(CLI::App& command, SharedOptions& options) {
  command.add_option("SCENE", options.scene, scene_summary())->required();
  add_read(command, "--size", "WxH", reader(parse_size, [&](const Extent& size) { options.size = size; }),
           "Pixels; 1280x720");
  add_camera_options(command, options);
  add_read(command, "--time", "S", number_reader(options.time_s, 0, kMaxTimeS), "Animation time of the first frame; 0");
  add_read(command, "--frames", "N", count_reader(options.frames, 1, kMaxFrames), "Frames in sequence; 1");
  add_read(command, "--fps", "F", number_reader(options.fps, 1e-3, 1e6), "Frames a second of animation; 30");
  add_light_options(command, options);
  add_settings_options(command, options);
  command.add_option("--device", options.device, "Which GPU; the best discrete one, then integrated, then software")
      ->type_name("NAME-OR-INDEX");
  command.add_flag("--validate", options.validate, "With Vulkan's validation layers; any message is an error");
  add_output_options(command, options);
}

void add_mirror_option(CLI::App& command, SharedOptions& options) {
  add_read(command, "--mirror-ball", "X,Y,Z,RADIUS",
           reader(parse_ball, [&](const glm::vec4& ball) { options.mirror_ball = ball; }),
           "A ball that mirrors what is around it. Needs store=page_pool");
}

}  // namespace app
