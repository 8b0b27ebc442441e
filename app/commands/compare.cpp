// umbrage compare.
#include "commands/compare.hpp"

#include <algorithm>
#include <vector>

#include "commands/compare_metrics.hpp"
#include "commands/lights_file.hpp"
#include "commands/progress.hpp"
#include "commands/run_outputs.hpp"
#include "commands/session.hpp"
#include "commands/stats_json.hpp"
#include "reference/reference_loader.hpp"

namespace app {
namespace {

using Json = nlohmann::ordered_json;
using umbrage::Result;

constexpr uint64_t kChunkBytes = 64ull << 20;  // Of visibility and bands read back at once.

reference::Light traced_light(const ActiveLight& light) {
  return {.kind = light.kind,
          .position = light.position,
          .direction = light.direction,
          .color = light.color,
          .intensity = light.intensity,
          .range = light.range,
          .near = reference::default_near(light.range),
          .inner_cone = light.inner_cone,
          .outer_cone = light.outer_cone,
          .faces = light.faces};
}

/// What the camera of the last frame sees, read back.
struct Surfaces {
  std::vector<float> positions, normals;
};

Result<Surfaces> read_surfaces(Renderer& renderer) {
  auto positions = renderer.read_position();
  if (!positions) return positions.error();
  auto normals = renderer.read_normal();
  if (!normals) return normals.error();
  return Surfaces{std::move(*positions), std::move(*normals)};
}

/// Every light in turn, read back in chunks so that no more than a chunk is ever held.
Result<CompareReport> compare_lights(Session& session, const reference::RayTracer& tracer, Progress& progress) {
  const auto surfaces = read_surfaces(session.renderer());
  if (!surfaces) return surfaces.error();
  const Extent& size = session.options().size;
  const reference::SurfaceImage image{size.width, size.height, surfaces->positions, surfaces->normals};
  CompareAccumulator accumulator(image);
  const size_t pixels = size_t(size.width) * size.height;
  const size_t chunk = std::max<size_t>(1, kChunkBytes / (2 * pixels));
  const std::vector<ActiveLight>& lights = session.lights();
  std::vector<uint8_t> visibility, band_px, traced(pixels);
  for (size_t first = 0; first < lights.size(); first += chunk) {
    const size_t count = std::min(chunk, lights.size() - first);
    visibility.resize(count * pixels);
    band_px.resize(count * pixels);
    const auto read = session.renderer().read_visibility(static_cast<uint32_t>(first), static_cast<uint32_t>(count),
                                                         visibility, band_px);
    if (!read) return read.error();
    for (size_t i = 0; i < count; ++i) {
      progress.show("tracing lights", first + i + 1, lights.size());
      const ActiveLight& light = lights[first + i];
      const std::span<const uint8_t> drawn(visibility.data() + i * pixels, pixels);
      const std::span<const uint8_t> band(band_px.data() + i * pixels, pixels);
      tracer.visibility(traced_light(light), image, drawn, traced);
      accumulator.add_light(static_cast<uint32_t>(first + i), light.name, traced_light(light),
                            {.visibility = drawn, .band_px = band, .traced = traced});
    }
  }
  return accumulator.report();
}

/// Fractions of the evaluated pairs.
void add_fractions(Json& document, const PairCounts& counts) {
  document["wrong_outside_band"] = counts.fraction(counts.wrong_outside_band);
  document["wrong_inside_band"] = counts.fraction(counts.wrong_inside_band);
  document["wrong_outside_texel_band"] = counts.fraction(counts.wrong_outside_texel_band);
  document["false_lit"] = counts.fraction(counts.false_lit);
  document["false_dark"] = counts.fraction(counts.false_dark);
  document["acne"] = counts.fraction(counts.acne);
  document["leak"] = counts.fraction(counts.leak);
  document["detached"] = counts.fraction(counts.detached);
}

/// The same as numbers of pixel × light pairs, and those that should or should not have been evaluated.
Json pairs_object(const PairCounts& counts) {
  return {{"evaluated", counts.evaluated},
          {"wrong_outside_band", counts.wrong_outside_band},
          {"wrong_inside_band", counts.wrong_inside_band},
          {"wrong_outside_texel_band", counts.wrong_outside_texel_band},
          {"false_lit", counts.false_lit},
          {"false_dark", counts.false_dark},
          {"missing", counts.missing},
          {"unexpected", counts.unexpected}};
}

void add_report(Json& document, const CompareReport& report, const std::vector<ActiveLight>& lights) {
  add_fractions(document, report.counts);
  document["luminance_rmse"] = report.luminance_rmse;
  document["pairs"] = pairs_object(report.counts);
  Json worst = Json::array();
  for (const LightCounts& light : report.worst) {
    Json entry{{"index", light.index}, {"name", light.name}, {"type", kind_name(lights[light.index].kind)}};
    add_fractions(entry, light.counts);
    entry["pairs"] = pairs_object(light.counts);
    worst.push_back(std::move(entry));
  }
  document["worst_lights"] = std::move(worst);
}

}  // namespace

void add_compare_options(CLI::App& command, CompareOptions& options) {
  add_shared_options(command, options.shared);
  command.add_option("-o,--output", options.report, "The report instead of standard output")->type_name("FILE.json");
}

Result<void> run_compare(const CompareOptions& options, Outputs& outputs) {
  if (const auto checked = check_run_outputs(options.shared, options.report); !checked) return checked.error();
  Progress progress;
  auto session = Session::open(options.shared, progress);
  if (!session) return session.error();
  if (const auto drawn = session->draw_frames(progress, {}); !drawn) return drawn.error();
  progress.show("building the ray tracer");
  const auto tracer = reference::load_ray_tracer(session->scene(), session->pose());
  if (!tracer) return tracer.error();
  const bool has_pages = session->settings().fixed.store == umbrage::Store::page_pool;
  if (has_pages)
    if (const auto marked = session->renderer().mark_lookups(); !marked) return marked.error();
  const auto report = compare_lights(*session, **tracer, progress);
  if (!report) return report.error();
  if (const auto written = write_run_outputs(*session, outputs, progress); !written) return written.error();
  Json document = stats_document(*session);
  add_report(document, *report, session->lights());
  if (has_pages) {
    const auto needed = session->renderer().read_needed_work();
    if (!needed) return needed.error();
    document["texels_needed"] = needed->texels;
    document["triangles_needed"] = needed->triangles;
  }
  progress.clear();
  return write_text(outputs, options.report, to_text(document));
}

}  // namespace app
