#include "commands/cascade_results.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

namespace app {

using Json = nlohmann::ordered_json;
using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {

constexpr const char* kRedraw = "cascades-redraw";

std::string printed(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out.append("&lt;");
    else if (c == '&')
      out.append("&amp;");
    else
      out.push_back(c);
  }
  return out;
}

/// "12.3 x" of a redraw's, or a dash where this is nothing.
std::string ratio(double redraw, double value) { return value > 0 ? printed("%.1f ×", redraw / value) : "—"; }

std::string table_of(const CascadeResults& results, const std::string& scene) {
  std::string html =
      "<table><tr><th>Motion</th><th>Mode</th><th>Triangles a frame</th><th>of them active</th><th>Redraw draws</th>"
      "<th>Texels exposed</th><th>GPU ms</th><th>Redraw takes</th><th>CPU ms</th></tr>\n";
  for (const CascadeRow& row : results.rows) {
    if (row.scene != scene) continue;
    const CascadeRow* redraw = results.find(scene, row.motion, kRedraw);
    html += "<tr><td>" + escaped(row.motion) + "</td><td>" + escaped(row.preset) + "</td><td>" +
            printed("%.0f", row.triangles()) + "</td><td>" + printed("%.0f", row.active_triangles) + "</td><td>" +
            (redraw ? ratio(redraw->triangles(), row.triangles()) : "") + "</td><td>" +
            printed("%.0f", row.texels_exposed) + "</td><td>" + printed("%.2f", row.gpu_ms) + "</td><td>" +
            (redraw ? ratio(redraw->gpu_ms, row.gpu_ms) : "") + "</td><td>" + printed("%.2f", row.cpu_record_ms) +
            "</td></tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

const CascadeRow* CascadeResults::find(const std::string& scene, const std::string& motion,
                                       const std::string& preset) const {
  const CascadeRow wanted{.scene = scene, .motion = motion, .preset = preset};
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const CascadeRow& row) { return row.is_same_measurement(wanted); });
  return found == rows.end() ? nullptr : &*found;
}

Json to_json(const CascadeResults& results) {
  Json rows = Json::array();
  for (const CascadeRow& row : results.rows)
    rows.push_back({{"scene", row.scene},
                    {"preset", row.preset},
                    {"case", row.motion},
                    {"reach_m", row.reach_m},
                    {"frames", row.frames},
                    {"kept", row.kept},
                    {"scrolled", row.scrolled},
                    {"cleared", row.cleared},
                    {"triangles", row.triangles()},
                    {"static_triangles", row.static_triangles},
                    {"active_triangles", row.active_triangles},
                    {"texels_exposed", row.texels_exposed},
                    {"occluded_casters", row.occluded_casters},
                    {"gpu_ms", row.gpu_ms},
                    {"gpu_ms_median", row.gpu_ms_median},
                    {"cpu_record_ms", row.cpu_record_ms},
                    {"cascade_triangles", row.cascade_triangles},
                    {"cascade_texels", row.cascade_texels}});
  const CascadeCircumstances& in = results.circumstances;
  return {{"suite", "cascades"},   {"device", {{"name", in.device}, {"driver", in.driver}}},
          {"version", in.version}, {"date", results.date},
          {"quick", in.is_quick},  {"rows", std::move(rows)}};
}

Result<CascadeResults> cascade_results_from_json(const nlohmann::json& document, const std::string& file) {
  try {
    if (document.at("suite") != "cascades")
      return Error{ErrorCode::invalid_argument, file + " holds results of another suite"};
    CascadeResults results;
    const auto& device = document.at("device");
    results.circumstances = {.device = device.at("name"),
                             .driver = device.at("driver"),
                             .version = document.at("version"),
                             .is_quick = document.at("quick")};
    results.date = document.at("date");
    for (const auto& row : document.at("rows"))
      results.rows.push_back({.scene = row.at("scene"),
                              .motion = row.at("case"),
                              .preset = row.at("preset"),
                              .reach_m = row.at("reach_m"),
                              .frames = row.at("frames"),
                              .kept = row.at("kept"),
                              .scrolled = row.at("scrolled"),
                              .cleared = row.at("cleared"),
                              .static_triangles = row.at("static_triangles"),
                              .active_triangles = row.at("active_triangles"),
                              .texels_exposed = row.at("texels_exposed"),
                              .occluded_casters = row.at("occluded_casters"),
                              .gpu_ms = row.at("gpu_ms"),
                              .gpu_ms_median = row.at("gpu_ms_median"),
                              .cpu_record_ms = row.at("cpu_record_ms"),
                              .cascade_triangles = row.at("cascade_triangles"),
                              .cascade_texels = row.at("cascade_texels")});
    return results;
  } catch (const nlohmann::json::exception& fault) {
    return Error{ErrorCode::invalid_argument, file + " is not what this suite writes: " + fault.what()};
  }
}

std::string to_csv(const CascadeResults& results) {
  std::string csv =
      "scene,motion,preset,reach_m,frames,kept,scrolled,cleared,static_triangles,active_triangles,texels_exposed,"
      "occluded_casters,gpu_ms,gpu_ms_median,cpu_record_ms\n";
  for (const CascadeRow& row : results.rows) {
    csv += row.scene + "," + row.motion + "," + row.preset + "," + std::to_string(row.reach_m) + "," +
           std::to_string(row.frames);
    for (const double value :
         {row.kept, row.scrolled, row.cleared, row.static_triangles, row.active_triangles, row.texels_exposed,
          row.occluded_casters, row.gpu_ms, row.gpu_ms_median, row.cpu_record_ms})
      csv.append(",").append(printed("%.6g", value));
    csv.append("\n");
  }
  return csv;
}

std::string cascade_report_html(const CascadeResults& results) {
  const CascadeCircumstances& in = results.circumstances;
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>umbrage bench cascades</title>\n"
      "<style>body{font:15px/1.5 sans-serif;max-width:1080px;margin:2em auto;padding:0 1em}"
      "table{border-collapse:collapse}td,th{border-bottom:1px solid #ddd;padding:.2em .7em;text-align:right}"
      "td:nth-child(-n+2),th:nth-child(-n+2){text-align:left}img{max-width:100%}</style></head><body>\n"
      "<h1>Cascades</h1>\n<p>" +
      escaped(in.device) + ", " + escaped(in.driver) + "; umbrage " + escaped(in.version) + ", " +
      escaped(results.date) + (in.is_quick ? "; quick run: few frames" : "") +
      ". Four cascades of 512 × 512. Means over the frames. GPU times are those of the cascades' passes, CPU times "
      "(medians) those of "
      "recording the library's whole frame.</p>\n";
  std::set<std::string> scenes;
  for (const CascadeRow& row : results.rows) {
    if (!scenes.insert(row.scene).second) continue;
    html.append("<h2>").append(escaped(row.scene)).append("</h2>\n").append(table_of(results, row.scene));
    for (const auto& [stem, text] : {std::pair{"figure-3-", "15 m/s"}, {"figure-4-", "210°/s"}})
      html.append("<h3>")
          .append(text)
          .append(": finished (grey), scrolled (blue), newly drawn (red); near to far</h3>\n<img src=\"")
          .append(stem)
          .append(row.scene)
          .append(".png\" alt=\"")
          .append(text)
          .append("\">\n");
    html.append("<h3>The scene</h3>\n<img src=\"figure-5-").append(row.scene).append(".png\" alt=\"scene\">\n");
  }
  return html + "</body></html>\n";
}

}  // namespace app
