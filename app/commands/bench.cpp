// umbrage bench: the suites. layered: every case, writer, size and number of maps; what an earlier run has measured is kept.
#include "commands/bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <optional>

#include "commands/bench_cascades.hpp"
#include "commands/json_file.hpp"
#include "commands/parse.hpp"
#include "commands/progress.hpp"
#include "commands/session.hpp"
#include "commands/stats_json.hpp"
#include "layered/layered_cases.hpp"
#include "layered/layered_results.hpp"

namespace app {

using umbrage::Result;

namespace {

constexpr const char* kRing = "ring";
constexpr double kEnoughMs = 2000;
constexpr uint32_t kRounds = 3;  // of the full run: what disturbs a row once seldom does so again much later

struct Job {
  const LayeredCase* test_case = nullptr;
  LayeredRow row;
  umbrage::LayeredWriter writer{};
};

/// What is drawn under a scene's name.
struct NamedScene {
  std::string name;
  LayeredArrays arrays;
};

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

Result<std::vector<NamedScene>> load_scenes(const std::vector<std::string>& names) {
  std::vector<NamedScene> scenes;
  for (const std::string& name : names) {
    const auto scene = load_scene(name);
    if (!scene) return scene.error();
    LayeredArrays arrays = layered_arrays(*scene, pose(*scene, 0), nullptr);
    if (arrays.instances.size() != 1)
      return invalid(name + ": bench layered draws one mesh, this scene has " +
                     std::to_string(arrays.instances.size()) + ": give it a file with one");
    scenes.push_back({std::filesystem::path(name).stem().string(), std::move(arrays)});
  }
  if (scenes.empty()) {
    LayeredArrays ring = skinned_ring();
    ring.meshes[0].skin.clear();
    ring.instances[0].bones = 0;
    scenes.push_back({kRing, std::move(ring)});
  }
  return scenes;
}

std::vector<Job> list_jobs(const std::vector<NamedScene>& scenes, const umbrage::Capabilities& has, bool is_quick) {
  const std::vector<uint32_t> maps =
      is_quick ? std::vector<uint32_t>{1, 6, 32} : std::vector<uint32_t>{1, 2, 3, 4, 6, 8, 12, 16, 24, 32};
  const std::vector<uint32_t> sizes =
      is_quick ? std::vector<uint32_t>{256, 1024} : std::vector<uint32_t>{256, 512, 1024, 2048};
  std::vector<Job> jobs;
  for (size_t s = 0; s < scenes.size(); ++s)
    for (const LayeredCase& test_case : layered_cases()) {
      if (test_case.is_skinned && s > 0) continue;  // drawn with the ring, once
      for (const uint32_t side : test_case.rasterizes ? sizes : std::vector<uint32_t>{256})
        for (const umbrage::LayeredWriter writer : kLayeredWriters) {
          if (!can_run(writer, has) || !runs_case(writer, test_case)) continue;
          for (const uint32_t count : maps)
            jobs.push_back({&test_case,
                            {.scene = test_case.is_skinned ? kRing : scenes[s].name,
                             .test_case = test_case.name,
                             .figure = test_case.figure,
                             .writer = std::string(umbrage::name_of(writer)),
                             .side = side,
                             .maps = count},
                            writer});
        }
    }
  return jobs;
}

Result<umbrage::LayeredScene> make_scene(const umbrage::DeviceDesc& device, const LayeredCase& test_case,
                                         LayeredArrays& arrays) {
  if (test_case.is_skinned) arrays = skinned_ring();
  add_hidden_instances(arrays, test_case.instances);
  auto scene = arrays.create(device);
  if (scene && test_case.is_skinned)
    if (auto bent = bend_ring(*scene, test_case.instances); !bent) return bent.error();
  return scene;
}

umbrage::LayeredPassSettings settings_of(const LayeredCase& test_case, umbrage::LayeredWriter writer) {
  using umbrage::LayeredVertices;
  return {.writer = writer,
          .vertices = test_case.is_skinned       ? LayeredVertices::skinned
                      : test_case.instances == 1 ? LayeredVertices::simple
                                                 : LayeredVertices::instanced,
          .selection = test_case.selection,
          .cull_frustum = test_case.cull_frustum,
          .culled_faces = test_case.culled_faces,
          .areas = writer == umbrage::LayeredWriter::atlas,
          .rasterizer_discard = !test_case.rasterizes};
}

std::string time_left(double seconds) {
  return seconds < 90 ? std::to_string(static_cast<int>(std::ceil(seconds))) + " s"
                      : std::to_string(static_cast<int>(std::ceil(seconds / 60))) + " min";
}

/// The rows of an earlier run in the folder, if it was under the same circumstances.
Result<LayeredResults> earlier_results(const std::filesystem::path& file, const LayeredCircumstances& now) {
  LayeredResults fresh{.circumstances = now, .date = today(), .rows = {}};
  if (!std::filesystem::exists(file)) return fresh;
  const auto document = read_json(file);
  if (!document) return document.error();
  auto earlier = results_from_json(*document, file.string());
  if (!earlier) return earlier.error();
  if (earlier->circumstances != now)
    return invalid(file.string() +
                   " was measured with another device, driver, version or --quick: choose another folder");
  return earlier;
}

class LayeredRun {
 public:
  LayeredRun(const BenchOptions& options, Outputs& outputs) : options_(options), outputs_(outputs) {}
  Result<void> run() {
    auto scenes = load_scenes(options_.scenes);
    if (!scenes) return scenes.error();
    auto bench = LayeredBench::create(options_.device);
    if (!bench) return bench.error();
    const LayeredCircumstances now{.device = bench->device_name(),
                                   .driver = bench->driver(),
                                   .api = bench->api(),
                                   .version = UMBRAGE_VERSION,
                                   .is_quick = options_.is_quick};
    std::error_code failed;
    std::filesystem::create_directories(options_.folder, failed);
    if (failed) return invalid("cannot make " + options_.folder.string() + ": " + failed.message());
    auto earlier = earlier_results(options_.folder / "results.json", now);
    if (!earlier) return earlier.error();
    results_ = std::move(*earlier);
    const std::vector<Job> jobs = list_jobs(*scenes, bench->device().enabled, options_.is_quick);
    const uint32_t rounds = options_.is_quick ? 1 : kRounds;
    for (uint32_t round = 1; round <= rounds; ++round) {
      std::vector<Job> left = jobs;
      std::erase_if(left, [&](const Job& job) {
        const LayeredRow* row =
            results_.find(job.row.scene, job.row.test_case, job.row.writer, job.row.side, job.row.maps);
        return row != nullptr && row->rounds >= round;
      });
      const std::string name =
          rounds > 1 ? "round " + std::to_string(round) + " of " + std::to_string(rounds) + ": " : "";
      if (auto measured = measure_all(left, *scenes, *bench, name); !measured) return measured;
    }
    return write_all();
  }

 private:
  /// Roughly what a job costs, for the time left.
  static double weight(const Job& job) {
    return 0.3 + job.row.maps * (1 + job.row.side * job.row.side / 1e6) * job.test_case->instances;
  }

  Result<void> measure_all(const std::vector<Job>& jobs, const std::vector<NamedScene>& scenes, LayeredBench& bench,
                           const std::string& round) {
    double total = 0, done = 0;
    for (const Job& job : jobs) total += weight(job);
    Progress progress;
    const auto start = std::chrono::steady_clock::now();
    const LayeredCase* current_case = nullptr;
    std::string current_scene, current_writer;
    LayeredArrays arrays;
    std::optional<umbrage::LayeredScene> scene;
    for (size_t i = 0; i < jobs.size(); ++i) {
      const Job& job = jobs[i];
      if (job.test_case != current_case || job.row.scene != current_scene) {
        const auto named =
            std::find_if(scenes.begin(), scenes.end(), [&](const NamedScene& s) { return s.name == job.row.scene; });
        if (named != scenes.end()) arrays = named->arrays;
        scene.reset();
        auto made = make_scene(bench.device(), *job.test_case, arrays);
        if (!made) return made.error();
        scene.emplace(std::move(*made));
        current_case = job.test_case, current_scene = job.row.scene;
      }
      if (job.row.writer != current_writer && i > 0)  // an interrupted run loses one writer's rows at most
        if (auto saved = save(); !saved) return saved;
      current_writer = job.row.writer;
      const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const std::string left = done > 0 ? ", " + time_left(elapsed_s * (total - done) / done) + " left" : "";
      progress.show(
          round + job.row.test_case + ", " + job.row.writer + ", " + std::to_string(job.row.side) + "²" + left, i + 1,
          jobs.size());
      // Long jobs need fewer to be found undisturbed once.
      const uint32_t repeats = !options_.is_quick ? 5 : job.row.maps >= 32 ? 2 : 3;
      const auto times = bench.measure(*scene, views_of(arrays, job.row.maps),
                                       {settings_of(*job.test_case, job.writer), job.row.side, repeats, kEnoughMs});
      if (!times) return times.error();
      done += weight(job);
      if (times->splits == 0) continue;  // an atlas larger than the device's images
      LayeredRow row = job.row;
      row.gpu_ms = times->gpu_ms, row.gpu_ms_spread = times->gpu_ms_spread, row.cpu_us = times->cpu_us,
      row.splits = times->splits, row.rounds = 1, row.repeats = times->repeats;
      results_.add(row);
      results_.date = today();
    }
    return save();
  }

  Result<void> save() { return write_text(outputs_, options_.folder / "results.json", to_text(to_json(results_))); }

  Result<void> write_all() {
    if (auto written = write_text(outputs_, options_.folder / "results.csv", to_csv(results_)); !written)
      return written;
    for (const LayeredFigure& figure : layered_figures(results_))
      if (auto written = write_text(outputs_, options_.folder / (figure.stem + ".svg"), figure.svg); !written)
        return written;
    return write_text(outputs_, options_.folder / "report.html", layered_report_html(results_));
  }

  const BenchOptions& options_;
  Outputs& outputs_;
  LayeredResults results_;
};

}  // namespace

void add_bench_options(CLI::App& command, BenchOptions& options) {
  command
      .add_option("SUITE", options.suite,
                  "layered: many views in one pass, Rákos' measurements; cascades: a sun's maps kept and scrolled")
      ->required()
      ->check(CLI::IsMember({"layered", "cascades"}));
  command
      .add_option("-o,--output", options.folder,
                  "Where results.json, results.csv, figures and report.html go; resumed if they are there")
      ->type_name("DIR")
      ->required();
  command
      .add_option(
          "--scene", options.scenes,
          "Repeatable. layered: files of one mesh that the unskinned cases draw; default: a ring of 35,600 triangles. "
          "cascades: files or builtin:NAME, under their own sun if they have one; default: builtin:landscape")
      ->type_name("FILE");
  command.add_option("--device", options.device, "Which GPU: an index of umbrage info, or part of a name")
      ->type_name("NAME-OR-INDEX");
  command.add_flag_callback(
      "--quick", [&options] { options.is_quick = true; }, "Fewer sizes, repeats and frames");
}

Result<void> run_bench(const BenchOptions& options, Outputs& outputs) {
  if (options.suite == "cascades") return run_cascades_bench(options, outputs);
  return LayeredRun(options, outputs).run();
}

}  // namespace app
