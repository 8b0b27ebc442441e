#include "commands/bench_cascades.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "commands/active_lights.hpp"
#include "commands/camera_source.hpp"
#include "commands/cascade_results.hpp"
#include "commands/image_file.hpp"
#include "commands/json_file.hpp"
#include "commands/parse.hpp"
#include "commands/progress.hpp"
#include "commands/session.hpp"
#include "commands/stats_json.hpp"
#include "commands/surfaces.hpp"

namespace app {

using umbrage::Result;

namespace {

constexpr double kFrameRate = 30;
constexpr uint32_t kWarmUp = 2;
constexpr const char* kPresets[] = {"cascades-redraw", "cascades-cached", "cascades-scrolled",
                                    "cascades-scrolled-literal", "cascades-guard-band"};
constexpr const char* kScrolled = "cascades-scrolled";
/// Pictures of the figures: four columns and three rows of 256 texels.
constexpr uint32_t kFigureWidth = 1044, kFigureHeight = 784;
constexpr uint32_t kMovers = 24;
constexpr uint32_t kLeastReach = 100, kMostReach = 2000;

enum class Movers : uint8_t { none, some };

struct Motion {
  const char* name;
  Movers movers;
  /// The camera at a frame, from where the scene's stands.
  glm::mat4 (*camera)(const glm::mat4& start, double frame);
};

glm::vec3 horizontal(const glm::vec3& v) {
  const glm::vec3 flat(v.x, 0, v.z);
  return glm::length(flat) > 1e-4f ? glm::normalize(flat) : glm::vec3(0, 0, -1);
}

glm::mat4 moved(glm::mat4 camera, const glm::vec3& by) {
  camera[3] += glm::vec4(by, 0);
  return camera;
}

/// Forward and to the right, so that both borders of the maps are exposed.
glm::vec3 heading(const glm::mat4& camera) {
  const glm::vec3 forward = horizontal(-glm::vec3(camera[2]));
  return glm::normalize(forward + 0.5f * glm::cross(forward, glm::vec3(0, 1, 0)));
}

glm::mat4 turned(const glm::mat4& camera, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  const glm::mat4 about_y(glm::vec4(c, 0, -s, 0), glm::vec4(0, 1, 0, 0), glm::vec4(s, 0, c, 0), glm::vec4(0, 0, 0, 1));
  glm::mat4 out = about_y * camera;
  out[3] = camera[3];
  return out;
}

float seconds(double frame) { return static_cast<float>(frame / kFrameRate); }

constexpr Motion kMotions[] = {
    {"translation 15 m/s", Movers::none,
     [](const glm::mat4& start, double frame) { return moved(start, heading(start) * (15 * seconds(frame))); }},
    {"rotation 210°/s", Movers::none,
     [](const glm::mat4& start, double frame) { return turned(start, glm::radians(210.0f) * seconds(frame)); }},
    {"walking 1.5 m/s", Movers::none,
     [](const glm::mat4& start, double frame) {
       const float t = seconds(frame);
       return moved(turned(start, 0.1f * std::sin(t)),
                    heading(start) * (1.5f * t) + glm::vec3(0, 0.03f * std::sin(12 * t), 0));
     }},
    {"standing still", Movers::none, [](const glm::mat4& start, double) { return start; }},
    {"standing still with movers", Movers::some, [](const glm::mat4& start, double) { return start; }},
    {"walking with movers", Movers::some,
     [](const glm::mat4& start, double frame) { return moved(start, heading(start) * (1.5f * seconds(frame))); }},
    {"teleports", Movers::none,
     [](const glm::mat4& start, double frame) {
       return moved(start, heading(start) * (60.0f * static_cast<float>(std::lround(frame) / 3 % 2)));
     }},
};

/// Boxes of half a metre that circle in front of the camera.
void add_movers(Scene& scene, const glm::mat4& camera) {
  Primitive box;
  for (uint32_t face = 0; face < 6; ++face) {
    const uint32_t axis = face / 2;
    glm::vec3 normal(0), u(0), v(0);
    normal[axis] = face % 2 ? 1.0f : -1.0f;
    u[(axis + 1) % 3] = normal[axis];
    v[(axis + 2) % 3] = 1;
    const auto first = static_cast<uint32_t>(box.positions.size());
    for (const glm::vec2& corner : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      box.positions.push_back(0.25f * (normal + u * corner.x + v * corner.y));
      box.normals.push_back(normal);
    }
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) box.indices.push_back(first + i);
  }
  if (scene.materials.empty()) scene.materials.emplace_back();
  scene.meshes.push_back({.name = "mover", .primitives = {box}, .weights = {}});
  Animation& animation = scene.animations.emplace_back();
  animation.duration = 4;
  const glm::vec3 middle = glm::vec3(camera[3]) + 15.0f * horizontal(-glm::vec3(camera[2])) - glm::vec3(0, 1, 0);
  for (uint32_t i = 0; i < kMovers; ++i) {
    Channel circle{.node = static_cast<uint32_t>(scene.nodes.size())};
    for (uint32_t key = 0; key <= 16; ++key) {
      const float angle = 6.2831853f * (static_cast<float>(key) / 16 + static_cast<float>(i) / kMovers);
      const float radius = 3 + static_cast<float>(i % 4) * 3;
      circle.times.push_back(animation.duration * static_cast<float>(key) / 16);
      const glm::vec3 at = middle + radius * glm::vec3(std::cos(angle), 0, std::sin(angle));
      circle.values.insert(circle.values.end(), {at.x, at.y, at.z});
    }
    Node& node = scene.nodes.emplace_back();
    node.name = "mover " + std::to_string(i);
    node.mesh = static_cast<int>(scene.meshes.size()) - 1;
    animation.channels.push_back(std::move(circle));
  }
}

/// The scene's own, or one from high above.
ActiveLight sun_of(const Pose& pose) {
  for (const PosedLight& light : pose.lights)
    if (light.kind == LightKind::directional) return activate(light, 1, {});
  return {.name = "sun",
          .kind = LightKind::directional,
          .direction = glm::normalize(glm::vec3(0.45f, -0.8f, 0.35f)),
          .color = {1, 0.95f, 0.85f},
          .intensity = 20};
}

/// An overview from high above leaves the near cascades empty.
std::string eye_level_camera(const Pose& pose) {
  const auto is_street = [](const PosedCamera& camera) { return camera.name == "street"; };
  return std::any_of(pose.cameras.begin(), pose.cameras.end(), is_street) ? "street" : "";
}

/// Metres that the depth range has to reach towards the sun for every caster to be in it: no ray along the light stays
/// longer within the casters' box.
uint32_t reach_m(const Scene& scene, const Pose& pose, const glm::vec3& direction) {
  Box casters;
  for_each_primitive(scene, pose, [&](const PosedPrimitive& posed) {
    const Material* material = scene.materials.empty() ? nullptr : &scene.materials[posed.primitive->material];
    if (material && (!material->casts_shadow || material->alpha_mode == AlphaMode::blend)) return;
    for (const uint32_t index : posed.primitive->indices) casters.extend(posed.positions[index]);
  });
  if (casters.is_empty()) return kLeastReach;
  const glm::vec3 along = (casters.max - casters.min) / glm::max(glm::abs(direction), glm::vec3(1e-3f));
  return std::clamp(static_cast<uint32_t>(std::ceil(std::min({along.x, along.y, along.z}))), kLeastReach, kMostReach);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double gpu_ms_of(const FrameReport& report) {
  double ms = 0;
  for (const auto& [name, pass_ms] : report.passes)
    if (name.starts_with("cascades")) ms += pass_ms;
  return ms;
}

/// A scene with a renderer, its clock and its camera.
class CascadeStage {
 public:
  static Result<CascadeStage> open(const std::string& name, const BenchOptions& options, Movers movers, uint32_t width,
                                   uint32_t height) {
    auto loaded = load_scene(name);
    if (!loaded) return loaded.error();
    CascadeStage stage;
    stage.scene_ = std::make_unique<Scene>(std::move(*loaded));
    const Pose first = pose(*stage.scene_, 0);
    auto camera =
        CameraSource::create({.name_or_index = eye_level_camera(first)}, first, scene_bounds(*stage.scene_, first),
                             static_cast<float>(width) / static_cast<float>(height));
    if (!camera) return camera.error();
    stage.start_ = camera->at(first, 0);
    if (movers == Movers::some) add_movers(*stage.scene_, stage.start_.world_from_camera);
    stage.movers_ = movers;
    stage.sun_ = sun_of(first);
    stage.reach_m_ = reach_m(*stage.scene_, first, stage.sun_.direction);
    const auto settings = umbrage::preset(kScrolled);
    if (!settings) return settings.error();
    auto renderer = Renderer::create({.width = width,
                                      .height = height,
                                      .device = options.device,
                                      .settings = *settings,
                                      .batch_cache_dir = batch_cache_folder(),
                                      .max_lights = 1},
                                     *stage.scene_);
    if (!renderer) return renderer.error();
    stage.renderer_ = std::make_unique<Renderer>(std::move(*renderer));
    return stage;
  }

  Result<FrameReport> draw(const Motion& motion, double frame, const umbrage::FrameSettings& settings,
                           Show show = Show::image) {
    time_s_ += 1 / kFrameRate;
    const Pose posed = pose(*scene_, movers_ == Movers::some ? time_s_ : 0);
    ViewCamera camera = start_;
    camera.world_from_camera = motion.camera(start_.world_from_camera, frame);
    return renderer_->render({.pose = &posed,
                              .lights = {&sun_, 1},
                              .camera = camera,
                              .settings = settings,
                              .time_s = time_s_,
                              .show = show});
  }
  Renderer& renderer() { return *renderer_; }
  /// What cascade_reach_m should be.
  uint32_t reach() const { return reach_m_; }

 private:
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<Renderer> renderer_;
  ViewCamera start_;
  ActiveLight sun_;
  uint32_t reach_m_ = kLeastReach;
  Movers movers_ = Movers::none;
  double time_s_ = 0;
};

class CascadeRun {
 public:
  CascadeRun(const BenchOptions& options, Outputs& outputs) : options_(options), outputs_(outputs) {}

  Result<void> run() {
    std::error_code failed;
    std::filesystem::create_directories(options_.folder, failed);
    if (failed) return invalid("cannot make " + options_.folder.string() + ": " + failed.message());
    const std::vector<std::string> scenes =
        options_.scenes.empty() ? std::vector<std::string>{"builtin:landscape"} : options_.scenes;
    total_ = scenes.size() * std::size(kMotions) * std::size(kPresets);
    for (const std::string& scene : scenes) {
      for (const Movers movers : {Movers::none, Movers::some})
        if (auto measured = measure_scene(scene, movers); !measured) return measured;
      if (auto drawn = draw_figures(scene); !drawn) return drawn;
    }
    if (auto written = write_text(outputs_, options_.folder / "results.csv", to_csv(results_)); !written)
      return written;
    return write_text(outputs_, options_.folder / "report.html", cascade_report_html(results_));
  }

 private:
  static std::string short_name(const std::string& scene) {
    if (scene.starts_with("builtin:")) return scene.substr(8);
    return std::filesystem::path(scene).stem().string();
  }

  Result<void> resume(const Renderer& renderer) {
    if (is_resumed_) return {};
    is_resumed_ = true;
    const std::filesystem::path file = options_.folder / "results.json";
    const std::time_t now = std::time(nullptr);
    char date[16];
    std::tm utc{};
    std::strftime(date, sizeof date, "%Y-%m-%d", gmtime_r(&now, &utc));
    results_ = {.circumstances = {renderer.device_name(), renderer.driver(), UMBRAGE_VERSION, options_.is_quick},
                .date = date,
                .rows = {}};
    if (!std::filesystem::exists(file)) return {};
    const auto document = read_json(file);
    if (!document) return document.error();
    auto earlier = cascade_results_from_json(*document, file.string());
    if (!earlier) return earlier.error();
    if (earlier->circumstances != results_.circumstances)
      return invalid(file.string() +
                     " was measured with another device, driver, version or --quick: choose another folder");
    results_.rows = std::move(earlier->rows);
    return {};
  }

  Result<void> measure_scene(const std::string& scene, Movers movers) {
    progress_.show("preparing " + scene);
    auto stage = CascadeStage::open(scene, options_, movers, 256, 144);
    if (!stage) return stage.error();
    if (auto ok = resume(stage->renderer()); !ok) return ok;
    for (const Motion& motion : kMotions) {
      if (motion.movers != movers) continue;
      for (const char* preset : kPresets) {
        if (results_.find(short_name(scene), motion.name, preset)) continue;
        progress_.show(short_name(scene) + ", " + motion.name + ", " + preset, results_.rows.size() + 1, total_);
        auto row = measure(*stage, motion, preset);
        if (!row) return row.error();
        row->scene = short_name(scene);
        results_.rows.push_back(std::move(*row));
      }
      if (auto saved = write_text(outputs_, options_.folder / "results.json", to_text(to_json(results_))); !saved)
        return saved;
    }
    return {};
  }

  Result<CascadeRow> measure(CascadeStage& stage, const Motion& motion, const char* preset) {
    auto settings = umbrage::preset(preset);
    if (!settings) return settings.error();
    // What moves turns static within the warm-up where it stops, and never where it does not.
    settings->frame.static_after_ms = 50;
    settings->frame.cascade_reach_m = stage.reach();
    CascadeRow row{
        .motion = motion.name, .preset = preset, .reach_m = stage.reach(), .frames = options_.is_quick ? 6u : 24u};
    row.cascade_triangles.resize(settings->frame.cascade_count);
    row.cascade_texels.resize(settings->frame.cascade_count);
    std::vector<double> gpu_ms, cpu_ms;
    for (uint32_t frame = 0; frame < kWarmUp + row.frames; ++frame) {
      const auto report = stage.draw(motion, frame, settings->frame);
      if (!report) return report.error();
      if (frame < kWarmUp) continue;
      gpu_ms.push_back(gpu_ms_of(*report));
      cpu_ms.push_back(report->cpu_record_ms);
      for (size_t i = 0; i < report->cascades.size(); ++i) add(row, i, report->cascades[i]);
    }
    for (const double ms : gpu_ms) row.gpu_ms += ms / row.frames;
    row.gpu_ms_median = median(std::move(gpu_ms));
    row.cpu_record_ms = median(std::move(cpu_ms));
    return row;
  }

  static void add(CascadeRow& row, size_t i, const umbrage::CascadeStatistics& cascade) {
    using Action = umbrage::CascadeStatistics::Action;
    const double share = 1.0 / row.frames;
    (cascade.action == Action::kept       ? row.kept
     : cascade.action == Action::scrolled ? row.scrolled
                                          : row.cleared) += share;
    row.static_triangles += share * static_cast<double>(cascade.static_triangles);
    row.active_triangles += share * static_cast<double>(cascade.active_triangles);
    row.texels_exposed += share * cascade.texels_exposed;
    row.occluded_casters += share * cascade.occluded_casters;
    row.cascade_triangles[i] += share * static_cast<double>(cascade.static_triangles + cascade.active_triangles);
    row.cascade_texels[i] += share * cascade.texels_exposed;
  }

  /// Figures 3 and 4 of the paper, and 5: the scene.
  Result<void> draw_figures(const std::string& scene) {
    progress_.show(short_name(scene) + ", figures");
    auto stage = CascadeStage::open(scene, options_, Movers::none, kFigureWidth, kFigureHeight);
    if (!stage) return stage.error();
    auto settings = umbrage::preset(kScrolled);
    if (!settings) return settings.error();
    settings->frame.cascade_reach_m = stage->reach();
    const struct {
      const char* stem;
      const Motion& motion;
      Show show;
    } figures[] = {{"figure-3-", kMotions[0], Show::cascades},
                   {"figure-4-", kMotions[1], Show::cascades},
                   {"figure-5-", kMotions[0], Show::image}};
    for (const auto& figure : figures) {
      for (uint32_t frame = 0; frame < 2; ++frame)
        if (const auto drawn = stage->draw(figure.motion, frame, settings->frame, figure.show); !drawn)
          return drawn.error();
      const auto pixels = stage->renderer().read_image();
      if (!pixels) return pixels.error();
      const std::filesystem::path target = options_.folder / (figure.stem + short_name(scene) + ".png");
      if (auto written = write_png(outputs_, target, kFigureWidth, kFigureHeight, *pixels); !written) return written;
    }
    return {};
  }

  const BenchOptions& options_;
  Outputs& outputs_;
  Progress progress_;
  CascadeResults results_;
  bool is_resumed_ = false;
  size_t total_ = 0;
};

}  // namespace

Result<void> run_cascades_bench(const BenchOptions& options, Outputs& outputs) {
  return CascadeRun(options, outputs).run();
}

}  // namespace app
