// Rows of `bench cascades`: kept as JSON between runs, told as CSV and a page.
#pragma once
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "umbrage/result.hpp"

namespace app {

/// One mode in one motion; numbers are means over the frames unless they say otherwise.
struct CascadeRow {
  std::string scene, motion, preset;
  uint32_t reach_m = 0;  ///< The setting cascade_reach_m.
  uint32_t frames = 0;
  double kept = 0, scrolled = 0, cleared = 0;  ///< Cascades of which the static map was.
  double static_triangles = 0, active_triangles = 0;
  double texels_exposed = 0;  ///< Of static maps.
  double occluded_casters = 0;
  double gpu_ms = 0, gpu_ms_median = 0;  ///< All passes of the cascades.
  double cpu_record_ms = 0;              ///< The library's, of the whole frame; median.
  /// Near to far.
  std::vector<double> cascade_triangles, cascade_texels;

  double triangles() const { return static_triangles + active_triangles; }
  bool is_same_measurement(const CascadeRow& other) const {
    return scene == other.scene && motion == other.motion && preset == other.preset;
  }
};

/// What results were measured with; results of other circumstances are not mixed.
struct CascadeCircumstances {
  std::string device, driver, version;
  bool is_quick = false;
  bool operator==(const CascadeCircumstances&) const = default;
};

struct CascadeResults {
  CascadeCircumstances circumstances;
  std::string date;  ///< Of the newest row.
  std::vector<CascadeRow> rows;

  const CascadeRow* find(const std::string& scene, const std::string& motion, const std::string& preset) const;
};

nlohmann::ordered_json to_json(const CascadeResults&);
/// Errors: not what to_json made.
umbrage::Result<CascadeResults> cascade_results_from_json(const nlohmann::json&, const std::string& file);
std::string to_csv(const CascadeResults&);
/// Tables, one a scene, and the pictures that lie beside the page.
std::string cascade_report_html(const CascadeResults&);

}  // namespace app
