// What render and compare do alike.
#include "commands/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <utility>

#include "commands/active_lights.hpp"
#include "commands/lights_file.hpp"
#include "commands/random_lights.hpp"
#include "commands/surfaces.hpp"
#include "import/gltf_import.hpp"
#include "scenes/builtin.hpp"

namespace app {
namespace {

using umbrage::Result;

constexpr std::string_view kBuiltinPrefix = "builtin:";
constexpr uint32_t kMaxRepeats = 4;

uint32_t warmup_frames(size_t frames) {
  return frames < 2 ? 0 : static_cast<uint32_t>(std::clamp<size_t>(frames / 4, 1, 10));
}

double median_after_warmup(std::vector<double> values) {
  values.erase(values.begin(), values.begin() + warmup_frames(values.size()));
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

Result<std::vector<PosedLight>> added_lights(const SharedOptions& options, const Scene& scene, const Pose& pose,
                                             const Box& bounds) {
  std::vector<PosedLight> lights;
  if (!options.lights_file.empty()) {
    auto read = read_lights(options.lights_file);
    if (!read) return read.error();
    lights = std::move(*read);
  }
  auto random = random_lights(scene, pose, bounds, options.random_lights, options.seed);
  if (!random) return random.error();
  lights.insert(lights.end(), std::make_move_iterator(random->begin()), std::make_move_iterator(random->end()));
  return lights;
}

Result<CameraOptions> camera_options(const SharedOptions& options) {
  CameraOptions camera = options.camera;
  if (camera.eye && *camera.eye == *camera.target)
    return umbrage::Error{umbrage::ErrorCode::invalid_argument,
                          "--eye and --target are the same point: move one of them"};
  if (options.path_file.empty()) return camera;
  auto path = read_camera_path(options.path_file);
  if (!path) return path.error();
  camera.path = std::move(*path);
  return camera;
}

/// Can the debug picture be drawn with these settings, and does it take a light?
Result<void> check_show(const SharedOptions& options, const umbrage::Settings& settings) {
  const auto all = shows();
  const auto info = std::find_if(all.begin(), all.end(), [&](const ShowInfo& i) { return i.show == options.show; });
  const std::string name = std::string("--show ") + info->name;
  const bool has_pages =
      settings.fixed.store == umbrage::Store::page_pool || settings.fixed.store == umbrage::Store::hardware_sparse;
  if (info->needs == ShowNeeds::page_pool && !has_pages)
    return invalid(name +
                   ": needs maps made of pages: choose store=page_pool, as preset default has, or hardware_sparse");
  if (info->needs == ShowNeeds::cascades && settings.frame.cascades == umbrage::CascadeMode::none)
    return invalid(name + ": needs cascades: choose a preset such as cascades-scrolled");
  if (info->light == ShowLight::ignored && options.show_light)
    return invalid(name + ": is not about one light: leave out --show-light");
  return {};
}

}  // namespace

std::string batch_cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache) return std::string(cache) + "/umbrage/batches";
  const char* home = std::getenv("HOME");
  return home && *home ? std::string(home) + "/.cache/umbrage/batches" : std::string();
}

Result<Scene> load_scene(const std::string& name) {
  if (name.starts_with(kBuiltinPrefix)) return builtin_scene(std::string_view(name).substr(kBuiltinPrefix.size()));
  return import_gltf(name);
}

Session::Session(SharedOptions options, umbrage::Settings settings, std::unique_ptr<Scene> scene, CameraSource camera,
                 std::vector<PosedLight> added_lights, const Box& bounds, Renderer renderer)
    : options_(std::move(options)),
      settings_(settings),
      scene_(std::move(scene)),
      camera_(std::move(camera)),
      added_lights_(std::move(added_lights)),
      bounds_(bounds),
      renderer_(std::move(renderer)) {}

Result<Session> Session::open(const SharedOptions& options, Progress& progress) {
  // Small inputs first: their faults show before a large scene is read.
  const auto settings = choose_settings(options.settings);
  if (!settings) return settings.error();
  if (const auto shown = check_show(options, *settings); !shown) return shown.error();
  const auto camera_choice = camera_options(options);
  if (!camera_choice) return camera_choice.error();

  progress.show("reading " + options.scene);
  auto loaded = load_scene(options.scene);
  if (!loaded) return loaded.error();
  auto scene = std::make_unique<Scene>(std::move(*loaded));
  std::optional<MirrorBall> mirror;
  if (options.mirror_ball) mirror = add_mirror_ball(*scene, glm::vec3(*options.mirror_ball), options.mirror_ball->w);
  const Pose first_pose = app::pose(*scene, options.time_s);
  const Box bounds = scene_bounds(*scene, first_pose);
  const float aspect = static_cast<float>(options.size.width) / static_cast<float>(options.size.height);
  auto camera = CameraSource::create(*camera_choice, first_pose, bounds, aspect);
  if (!camera) return camera.error();
  progress.show("placing lights");
  auto added = added_lights(options, *scene, first_pose, bounds);
  if (!added) return added.error();

  const size_t scene_lights = options.scene_lights == SceneLights::used ? first_pose.lights.size() : 0;
  RendererDesc desc{.width = options.size.width,
                    .height = options.size.height,
                    .device = options.device,
                    .validate = options.validate,
                    .settings = *settings,
                    .batch_cache_dir = batch_cache_folder(),
                    .max_lights = static_cast<uint32_t>(scene_lights + added->size()),
                    .mirror = mirror};
  progress.show("preparing " + options.scene);
  auto renderer = Renderer::create(desc, *scene);
  if (!renderer) return renderer.error();
  return Session(options, *settings, std::move(scene), std::move(*camera), std::move(*added), bounds,
                 std::move(*renderer));
}

Result<void> Session::draw(uint32_t frame) {
  const double time_s = time_of(frame);
  pose_ = app::pose(*scene_, time_s);
  const std::span<const PosedLight> none;
  lights_ = active_lights(options_.scene_lights == SceneLights::used ? pose_.lights : none, added_lights_,
                          options_.irradiance_threshold, bounds_);
  if (options_.show_light && *options_.show_light >= lights_.size())
    return invalid("--show-light: there is no light " + std::to_string(*options_.show_light) + ": the frame has " +
                   std::to_string(lights_.size()) + " lights, counted from 0");
  const FrameInput input{.pose = &pose_,
                         .lights = lights_,
                         .camera = camera_.at(pose_, time_s),
                         .settings = settings_.frame,
                         .time_s = time_s,
                         .show = options_.show,
                         .show_light = options_.show_light};
  // Lists that were too short have been sized for the next frame by this one: drawn again, the frame is whole.
  for (uint32_t repeat = 0; repeat <= kMaxRepeats; ++repeat) {
    auto report = renderer_.render(input);
    if (!report) return report.error();
    report_ = std::move(*report);
    if (report_.statistics.overflows == 0) break;
  }
  frame_ms_.push_back(report_.frame_ms);
  wall_ms_.push_back(report_.wall_ms);
  cpu_record_ms_.push_back(report_.cpu_record_ms);
  return {};
}

Result<void> Session::draw_frames(Progress& progress, const std::function<Result<void>(uint32_t)>& after_frame) {
  for (uint32_t frame = 0; frame < options_.frames; ++frame) {
    progress.show("rendering", frame + 1, options_.frames);
    if (const auto drawn = draw(frame); !drawn) return drawn.error();
    if (options_.validate && renderer_.validation_messages() > 0) {
      return umbrage::Error{umbrage::ErrorCode::vulkan,
                            "the validation layers reported " + std::to_string(renderer_.validation_messages()) +
                                " messages by frame " + std::to_string(frame) +
                                ", listed above; this is a fault of umbrage, please report it"};
    }
    if (!after_frame) continue;
    if (const auto done = after_frame(frame); !done) return done.error();
  }
  return {};
}

RunTimes Session::times() const {
  return {.frame_ms = median_after_warmup(frame_ms_),
          .wall_ms = median_after_warmup(wall_ms_),
          .cpu_record_ms = median_after_warmup(cpu_record_ms_),
          .frames = static_cast<uint32_t>(frame_ms_.size()),
          .warmup_frames = warmup_frames(frame_ms_.size())};
}

}  // namespace app
