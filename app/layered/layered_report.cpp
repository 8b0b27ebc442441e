// The chapter's figures and claims from measured rows, whichever way they come out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <set>

#include "layered/layered_results.hpp"
#include "layered/line_chart.hpp"

namespace app {

namespace {

constexpr const char* kTraditional = "traditional";
constexpr const char* kLayered = "geometry_invocations";  // what the chapter means by layered
constexpr const char* kLoop = "geometry_loop";            // its form for older hardware
constexpr const char* kVertex = "vertex_layer";           // and what came after
constexpr std::array kLayeredWays{kLayered, kLoop, kVertex};
constexpr std::array kToldMaps{1u, 2u, 3u, 4u, 6u, 12u, 32u};  // in percentages; all are in the figures

std::string printed(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::set<std::string> scenes_of(const LayeredResults& results) {
  std::set<std::string> scenes;
  for (const LayeredRow& row : results.rows) scenes.insert(row.scene);
  return scenes;
}

std::set<uint32_t> values_of(const LayeredResults& results, uint32_t LayeredRow::*member,
                             const std::string& test_case) {
  std::set<uint32_t> values;
  for (const LayeredRow& row : results.rows)
    if (row.test_case == test_case) values.insert(row.*member);
  return values;
}

using Metric = std::function<double(const LayeredRow&)>;
double total_ms(const LayeredRow& row) { return row.gpu_ms; }
double ms_per_map(const LayeredRow& row) { return row.gpu_ms / row.maps; }
double total_us(const LayeredRow& row) { return row.cpu_us; }
double us_per_map(const LayeredRow& row) { return row.cpu_us / row.maps; }

/// A line a writer (and a case, where there are several).
Chart make_chart(const LayeredResults& results, const std::string& scene, const std::vector<std::string>& cases,
                 uint32_t side, std::string title, std::string y_label, const Metric& metric) {
  Chart chart{.title = std::move(title), .x_label = "maps", .y_label = std::move(y_label)};
  for (uint32_t dash = 0; dash < cases.size(); ++dash)
    for (const LayeredRow& row : results.rows) {
      const std::string& test_case = cases[dash];
      if (row.scene != scene || row.test_case != test_case || row.side != side) continue;
      const size_t comma = test_case.rfind(", ");
      const std::string variant = comma == std::string::npos ? test_case : test_case.substr(comma + 2);
      const std::string name = row.writer + (dash == 0 ? "" : ", " + variant);
      auto line =
          std::find_if(chart.lines.begin(), chart.lines.end(), [&](const ChartLine& l) { return l.name == name; });
      if (line == chart.lines.end()) line = chart.lines.insert(line, {name, {}, row.writer, dash});
      line->points.emplace_back(row.maps, metric(row));
    }
  std::set<double> ticks;
  for (ChartLine& line : chart.lines) {
    std::sort(line.points.begin(), line.points.end());
    for (const auto& [maps, value] : line.points) ticks.insert(maps);
  }
  chart.x_ticks.assign(ticks.begin(), ticks.end());
  return chart;
}

/// Layered time over traditional time, of the scene's rows of two cases.
std::optional<double> ratio(const LayeredResults& results, const std::string& scene, const std::string& layered_case,
                            const std::string& traditional_case, uint32_t side, uint32_t maps,
                            const char* writer = kLayered) {
  const LayeredRow* layered = results.find(scene, layered_case, writer, side, maps);
  const LayeredRow* traditional = results.find(scene, traditional_case, kTraditional, side, maps);
  if (!layered || !traditional || traditional->gpu_ms <= 0) return std::nullopt;
  return layered->gpu_ms / traditional->gpu_ms;
}

/// What is found of each layered way that was measured; of the chapter's own without its name.
std::string each_way(const std::function<std::string(const char*)>& find) {
  std::string text;
  for (const char* writer : kLayeredWays)
    if (const std::string found = find(writer); !found.empty())
      text += (text.empty() ? "" : "; ") + (writer == kLayered ? std::string() : std::string(writer) + " ") + found;
  return text.empty() ? "not measured" : text;
}

std::string change_text(double value) { return printed("%+.0f %%", std::round(100 * (value - 1)) + 0.0); }  // no -0 %

/// "+10 % (2), -30 % (32)", and the same for the other layered ways where they were measured.
std::string change_range(const LayeredResults& results, const std::string& scene, const std::string& layered_case,
                         const std::string& traditional_case, uint32_t side, uint32_t from_maps) {
  const auto listed = [&](const char* writer) {
    std::string text;
    for (const uint32_t maps : kToldMaps)
      if (maps >= from_maps)
        if (const auto found = ratio(results, scene, layered_case, traditional_case, side, maps, writer))
          text += (text.empty() ? "" : ", ") + change_text(*found) + " (" + std::to_string(maps) + ")";
    return text;
  };
  return each_way([&](const char* writer) { return listed(writer); });
}

std::string break_even(const LayeredResults& results, const std::string& scene, uint32_t side) {
  return each_way([&](const char* writer) -> std::string {
    uint32_t most = 0;
    for (const uint32_t maps : values_of(results, &LayeredRow::maps, "four instances")) {
      const auto found = ratio(results, scene, "four instances", "four instances", side, maps, writer);
      if (found && *found <= 1) return "from " + std::to_string(maps) + " maps on";
      if (found) most = maps;
    }
    return most == 0 ? "" : "never, up to " + std::to_string(most) + " maps";
  });
}

/// Maps from which on another map costs within a tenth of what it costs at best.
std::string knee(const LayeredResults& results, const std::string& scene, uint32_t side) {
  const auto counts = values_of(results, &LayeredRow::maps, "simple, discard");
  return each_way([&](const char* writer) -> std::string {
    const auto per_map = [&](uint32_t maps) {
      const LayeredRow* row = results.find(scene, "simple, discard", writer, side, maps);
      return row ? ms_per_map(*row) : 0;
    };
    double best = 0;
    for (const uint32_t maps : counts)
      if (const double now = per_map(maps); now > 0 && (best == 0 || now < best)) best = now;
    for (const uint32_t maps : counts)
      if (const double now = per_map(maps); now > 0 && now <= 1.1 * best)
        return "at " + std::to_string(maps) + (maps == 1 ? " map" : " maps");
    return "";
  });
}

std::string size_influence(const LayeredResults& results, const std::string& scene) {
  return each_way([&](const char* writer) {
    std::string text;
    for (const uint32_t side : values_of(results, &LayeredRow::side, "simple"))
      if (const auto found = ratio(results, scene, "simple", "simple", side, 32, writer))
        text += (text.empty() ? "" : ", ") + std::to_string(side) + "²: " + change_text(*found);
    return text;
  });
}

std::string cpu_growth(const LayeredResults& results, const std::string& scene, uint32_t side) {
  std::string text;
  for (const char* writer : {kTraditional, kLayered, "vertex_layer", "multiview", "mesh"}) {
    const LayeredRow* one = results.find(scene, "simple, discard", writer, side, 1);
    const LayeredRow* many = results.find(scene, "simple, discard", writer, side, 32);
    if (one && many && one->cpu_us > 0)
      text += (text.empty() ? "" : "; ") + std::string(writer) + " " + printed("%.1f", one->cpu_us) + " µs → " +
              printed("%.1f", many->cpu_us) + " µs in " + std::to_string(many->splits) +
              (many->splits == 1 ? " pass" : " passes");
  }
  return text.empty() ? "not measured" : text;
}

std::string fastest(const LayeredResults& results, const std::string& scene) {
  std::string text;
  for (const char* test_case : {"simple", "simple, discard", "skeletal", "four instances", "four instances, selected",
                                "back faces", "combined"})
    for (const uint32_t maps : {6u, 32u}) {
      const LayeredRow* best = nullptr;
      for (const LayeredRow& row : results.rows)
        if (row.scene == scene && row.test_case == test_case && row.maps == maps && row.side <= 512 && row.gpu_ms > 0 &&
            (!best || row.gpu_ms < best->gpu_ms))
          best = &row;
      if (best)
        text += (text.empty() ? "" : "; ") + std::string(test_case) + ", " + std::to_string(maps) +
                " maps: " + best->writer + " (" + printed("%.2f", best->gpu_ms) + " ms)";
    }
  return text.empty() ? "not measured" : text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

}  // namespace

std::vector<LayeredFigure> layered_figures(const LayeredResults& results) {
  std::vector<LayeredFigure> figures;
  const auto add = [&](const std::string& number, const std::string& scene, const std::string& title,
                       const std::vector<Chart>& charts) {
    if (charts.empty() || charts[0].lines.empty()) return;
    figures.push_back(
        {"figure-" + number + "-" + scene, "Figure " + number + ", " + scene + ": " + title, charts_svg(charts)});
  };
  for (const std::string& scene : scenes_of(results)) {
    std::vector<Chart> sizes;
    for (const uint32_t side : values_of(results, &LayeredRow::side, "simple"))
      sizes.push_back(make_chart(results, scene, {"simple"}, side, std::to_string(side) + " × " + std::to_string(side),
                                 "GPU ms", total_ms));
    add("19.3", scene, "simple vertex shader, clear and rasterisation included", sizes);
    const auto pair = [&](const std::vector<std::string>& cases) {
      const auto sides = values_of(results, &LayeredRow::side, cases[0]);
      const uint32_t side = sides.empty() ? 0 : *sides.begin();
      return std::vector<Chart>{make_chart(results, scene, cases, side, "total", "GPU ms", total_ms),
                                make_chart(results, scene, cases, side, "per map", "GPU ms", ms_per_map)};
    };
    add("19.4", scene, "simple vertex shader, without rasterisation", pair({"simple, discard"}));
    const auto sides = values_of(results, &LayeredRow::side, "simple, discard");
    const uint32_t side = sides.empty() ? 0 : *sides.begin();
    add("19.5", scene, "processor time of preparing and recording",
        {make_chart(results, scene, {"simple, discard"}, side, "total", "CPU µs", total_us),
         make_chart(results, scene, {"simple, discard"}, side, "per map", "CPU µs", us_per_map)});
    add("19.6", scene, "skeletal vertex shader, without rasterisation", pair({"skeletal"}));
    add("19.7", scene, "four instances, one visible, without rasterisation",
        pair({"four instances", "four instances, frustum", "four instances, selected"}));
    add("19.8", scene, "back-face culling, without rasterisation", pair({"back faces"}));
    add("19.9", scene, "skeletal, four instances, all culling, without rasterisation",
        pair({"combined, no culling", "combined"}));
  }
  return figures;
}

std::vector<LayeredClaim> layered_claims(const LayeredResults& results) {
  std::vector<LayeredClaim> claims;
  for (const std::string& scene : scenes_of(results)) {
    const auto sides = values_of(results, &LayeredRow::side, "skeletal");
    const uint32_t side = sides.empty() ? 256 : *sides.begin();
    const auto add = [&](const std::string& claim, const std::string& found) {
      if (found != "not measured") claims.push_back({claim + " [" + scene + "]", found});
    };
    add("Simple shader, rasterised: about +10 % for layered", change_range(results, scene, "simple", "simple", 256, 1));
    add("Map size barely matters (32 maps)", size_influence(results, scene));
    add("Simple shader, no rasterisation", change_range(results, scene, "simple, discard", "simple, discard", side, 1));
    add("The time per map falls little beyond about six maps: knee", knee(results, scene, side));
    add("Recording cost is constant when layered (1 → 32 maps)", cpu_growth(results, scene, side));
    add("Skeletal: about -30 % from three maps on", change_range(results, scene, "skeletal", "skeletal", side, 3));
    if (results.find(scene, "four instances", kLayered, side, 1))
      add("Four instances, no culling: break-even at 5 to 10 maps", break_even(results, scene, side));
    add("Four instances, frustum culling: about -40 %",
        change_range(results, scene, "four instances, frustum", "four instances", side, 2));
    add("Four instances, batches selected (traditional, too)",
        change_range(results, scene, "four instances, selected", "four instances, selected", side, 2));
    add("Back-face culling: more than -40 % (traditional without)",
        change_range(results, scene, "back faces", "simple, discard", side, 2));
    add("Back-face culling, traditional with the fixed function's",
        change_range(results, scene, "back faces", "back faces", side, 2));
    add("All combined: about -60 % beyond four maps",
        change_range(results, scene, "combined", "combined, no culling", side, 4));
    add("Fastest writers (at the smallest sizes)", fastest(results, scene));
  }
  return claims;
}

std::string layered_report_html(const LayeredResults& results) {
  const LayeredCircumstances& in = results.circumstances;
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>umbrage bench layered</title>\n"
      "<style>body{font:15px/1.5 sans-serif;max-width:980px;margin:2em auto;padding:0 "
      "1em}table{border-collapse:collapse}"
      "td,th{border-bottom:1px solid #ddd;padding:.3em "
      ".8em;text-align:left;vertical-align:top}</style></head><body>\n<h1>Layered rendering</h1>\n<p>" +
      escaped(in.device) + ", " + escaped(in.driver) + ", Vulkan " + escaped(in.api) + "; umbrage " +
      escaped(in.version) + ", " + escaped(results.date) +
      (in.is_quick ? "; quick run: few repeats and map counts" : "") +
      ". Depth is D16. GPU times are the least of the repeats between timestamps, clears included; processor "
      "times are the least of preparing and recording. Percentages are the geometry shader with invocations, and where "
      "they are named other writers, against one pass per map; map counts in brackets.</p>\n"
      "<h2>Claims of the chapter</h2>\n<table><tr><th>Claim</th><th>Measured here</th></tr>\n";
  for (const LayeredClaim& claim : layered_claims(results))
    html += "<tr><td>" + escaped(claim.claim) + "</td><td>" + escaped(claim.found) + "</td></tr>\n";
  html += "</table>\n";
  for (const LayeredFigure& figure : layered_figures(results))
    html += "<h2>" + escaped(figure.title) + "</h2>\n" + figure.svg;
  return html + "</body></html>\n";
}

}  // namespace app
