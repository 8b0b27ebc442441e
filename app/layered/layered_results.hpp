// Rows of `bench layered`: kept as JSON between runs, told as CSV, figures and a page.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "umbrage/result.hpp"

namespace app {

struct LayeredRow {
  std::string scene, test_case, figure, writer;
  uint32_t side = 0, maps = 0;
  double gpu_ms = 0, gpu_ms_spread = 0;  ///< Least; from the least to the largest median of a round.
  double cpu_us = 0;                     ///< Least of prepare and record.
  uint32_t splits = 0;
  uint32_t rounds = 0, repeats = 0;  ///< How often it was come back to, and runs in all.

  bool is_same_measurement(const LayeredRow& other) const {
    return scene == other.scene && test_case == other.test_case && writer == other.writer && side == other.side &&
           maps == other.maps;
  }
};

/// What results were measured with; results of other circumstances are not mixed.
struct LayeredCircumstances {
  std::string device, driver, api, version;
  bool is_quick = false;
  bool operator==(const LayeredCircumstances&) const = default;
};

struct LayeredResults {
  LayeredCircumstances circumstances;
  std::string date;  ///< Of the newest row.
  std::vector<LayeredRow> rows;

  /// Adds a round: a new row, or what is known of it better.
  void add(const LayeredRow&);
  const LayeredRow* find(const std::string& scene, const std::string& test_case, const std::string& writer,
                         uint32_t side, uint32_t maps) const;
};

nlohmann::ordered_json to_json(const LayeredResults&);
/// Errors: not what to_json made.
umbrage::Result<LayeredResults> results_from_json(const nlohmann::json&, const std::string& file);
std::string to_csv(const LayeredResults&);

/// A figure of the chapter as measured: file stem ("figure-19.3-dragon"), title and SVG.
struct LayeredFigure {
  std::string stem, title, svg;
};
std::vector<LayeredFigure> layered_figures(const LayeredResults&);

/// A claim of the chapter and what came out.
struct LayeredClaim {
  std::string claim, found;
};
std::vector<LayeredClaim> layered_claims(const LayeredResults&);
std::string layered_report_html(const LayeredResults&);

}  // namespace app
