// Statistics and traces as JSON.
#include "commands/stats_json.hpp"

#include <algorithm>

namespace app {
namespace {

using Json = nlohmann::ordered_json;

const char* reason_name(umbrage::Degradation reason) {
  switch (reason) {
    case umbrage::Degradation::none:
      return "none";
    case umbrage::Degradation::coarser:
      return "coarser";
    case umbrage::Degradation::no_map:
      return "no_map";
    case umbrage::Degradation::casters_missing:
      return "casters_missing";
  }
  return "none";
}

/// Name → GPU ms; a name that occurs several times holds the sum.
Json passes_object(const FrameReport& report) {
  Json passes = Json::object();
  for (const auto& [name, gpu_ms] : report.passes) passes[name] = passes.value(name, 0.0) + gpu_ms;
  return passes;
}

void add_counts(Json& document, const FrameReport& report) {
  const umbrage::Statistics& statistics = report.statistics;
  document["lights"] = statistics.lights;
  document["lights_visible"] = statistics.lights_visible;
  document["lighting_computations"] = report.lighting_computations;
  document["clusters"] = statistics.clusters;
  document["cluster_light_pairs"] = statistics.cluster_light_pairs;
  document["shadow_maps"] = statistics.shadow_maps;
  document["shadow_views"] = statistics.shadow_views;
  document["map_resolution"] = statistics.map_resolution;
  document["pages_requested"] = statistics.pages_requested;
  document["pages_resident"] = statistics.pages_resident;
  document["pages_rendered"] = statistics.pages_rendered;
  document["texels_requested"] = statistics.texels_requested;
  document["texels_allocated"] = statistics.texels_allocated;
  document["casters"] = statistics.casters;
  document["caster_pairs"] = statistics.caster_pairs;
  document["batches_drawn"] = statistics.batches_drawn;
  document["triangles_drawn"] = statistics.triangles_drawn;
  document["shadow_memory_bytes"] = statistics.shadow_memory_bytes;
  document["table_memory_bytes"] = statistics.table_memory_bytes;
  document["bytes_read_back"] = statistics.bytes_read_back;
  document["pages_bound"] = statistics.pages_bound;
  document["pages_unbound"] = statistics.pages_unbound;
  document["bind_ms"] = statistics.bind_ms;
  document["unbacked_taps"] = statistics.unbacked_taps;
  document["unmarked_taps"] = statistics.unmarked_taps;
  document["overflows"] = statistics.overflows;
  document["lights_degraded"] = statistics.lights_degraded;
  Json degraded = Json::array();
  for (const umbrage::LightStatus& status : report.degraded)
    degraded.push_back({{"light_id", status.light.value},
                        {"reason", reason_name(status.reason)},
                        {"missing_bytes", status.missing_bytes}});
  document["degraded"] = std::move(degraded);
}

/// Near to far, light by light.
Json cascades_array(const FrameReport& report) {
  constexpr const char* kActions[] = {"kept", "scrolled", "cleared"};
  Json cascades = Json::array();
  for (const umbrage::CascadeStatistics& cascade : report.cascades)
    cascades.push_back({{"light", cascade.light},
                        {"begin_m", cascade.begin_m},
                        {"end_m", cascade.end_m},
                        {"texel_m", cascade.texel_m},
                        {"side", cascade.side},
                        {"static_map", kActions[static_cast<size_t>(cascade.action)]},
                        {"texels_exposed", cascade.texels_exposed},
                        {"static_casters", cascade.static_casters},
                        {"active_casters", cascade.active_casters},
                        {"occluded_casters", cascade.occluded_casters},
                        {"static_triangles", cascade.static_triangles},
                        {"active_triangles", cascade.active_triangles}});
  return cascades;
}

Json event(const char* track_name, int track, const std::string& name, double start_ms, double length_ms) {
  return {{"name", name},          {"cat", track_name},      {"ph", "X"}, {"pid", 1}, {"tid", track},
          {"ts", start_ms * 1000}, {"dur", length_ms * 1000}};
}

Json track_label(int track, const char* name) {
  return {{"name", "thread_name"}, {"ph", "M"}, {"pid", 1}, {"tid", track}, {"args", {{"name", name}}}};
}

}  // namespace

Json stats_document(Session& session) {
  const SharedOptions& options = session.options();
  const RunTimes times = session.times();
  Json document;
  document["device"] = session.renderer().device_name();
  document["driver"] = session.renderer().driver();
  document["scene"] = options.scene;
  document["preset"] = options.settings.preset;
  document["settings"] = settings_document(session.settings());
  document["size"] = {options.size.width, options.size.height};
  document["frames"] = times.frames;
  document["warmup_frames"] = times.warmup_frames;
  document["frame_ms"] = times.frame_ms;
  document["wall_ms"] = times.wall_ms;
  document["cpu_record_ms"] = times.cpu_record_ms;
  document["passes"] = passes_object(session.report());
  add_counts(document, session.report());
  document["cascades"] = cascades_array(session.report());
  return document;
}

Json trace_document(const FrameReport& report) {
  constexpr int kGpu = 1, kCpu = 2;
  Json events = Json::array();
  events.push_back(track_label(kGpu, "GPU passes"));
  events.push_back(track_label(kCpu, "CPU"));
  events.push_back(event("cpu", kCpu, "record shadows", 0, report.cpu_record_ms));
  double start_ms = report.cpu_record_ms;
  for (const auto& [name, gpu_ms] : report.passes) {
    events.push_back(event("gpu", kGpu, name, start_ms, gpu_ms));
    start_ms += gpu_ms;
  }
  return {{"traceEvents", std::move(events)}, {"displayTimeUnit", "ms"}};
}

std::string to_text(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace app
