// JSON and CSV of layered measurements.
#include "layered/layered_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace app {

using Json = nlohmann::ordered_json;
using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {
/// Clocks are no finer than that.
double in_tenths_of_us(double ms) { return std::round(ms * 1e4) / 1e4; }
double in_ns(double us) { return std::round(us * 1e3) / 1e3; }
}  // namespace

const LayeredRow* LayeredResults::find(const std::string& scene, const std::string& test_case,
                                       const std::string& writer, uint32_t side, uint32_t maps) const {
  const LayeredRow wanted{.scene = scene, .test_case = test_case, .writer = writer, .side = side, .maps = maps};
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const LayeredRow& row) { return row.is_same_measurement(wanted); });
  return found == rows.end() ? nullptr : &*found;
}

void LayeredResults::add(const LayeredRow& round) {
  const auto known =
      std::find_if(rows.begin(), rows.end(), [&](const LayeredRow& row) { return row.is_same_measurement(round); });
  if (known == rows.end()) {
    rows.push_back(round);
    return;
  }
  const double median = std::max(known->gpu_ms + known->gpu_ms_spread, round.gpu_ms + round.gpu_ms_spread);
  known->gpu_ms = std::min(known->gpu_ms, round.gpu_ms);
  known->gpu_ms_spread = median - known->gpu_ms;
  known->cpu_us = std::min(known->cpu_us, round.cpu_us);
  known->splits = round.splits;
  known->rounds += round.rounds;
  known->repeats += round.repeats;
}

Json to_json(const LayeredResults& results) {
  Json rows = Json::array();
  for (const LayeredRow& row : results.rows)
    rows.push_back({{"scene", row.scene},
                    {"preset", row.writer},
                    {"case", row.test_case},
                    {"figure", row.figure},
                    {"side", row.side},
                    {"maps", row.maps},
                    {"gpu_ms", in_tenths_of_us(row.gpu_ms)},
                    {"gpu_ms_spread", in_tenths_of_us(row.gpu_ms_spread)},
                    {"gpu_ms_per_map", in_tenths_of_us(row.gpu_ms / row.maps)},
                    {"cpu_us", in_ns(row.cpu_us)},
                    {"cpu_us_per_map", in_ns(row.cpu_us / row.maps)},
                    {"splits", row.splits},
                    {"rounds", row.rounds},
                    {"repeats", row.repeats}});
  const LayeredCircumstances& in = results.circumstances;
  return {{"suite", "layered"},    {"device", {{"name", in.device}, {"driver", in.driver}, {"api", in.api}}},
          {"version", in.version}, {"date", results.date},
          {"quick", in.is_quick},  {"rows", std::move(rows)}};
}

Result<LayeredResults> results_from_json(const nlohmann::json& document, const std::string& file) {
  try {
    if (document.at("suite") != "layered")
      return Error{ErrorCode::invalid_argument, file + " holds results of another suite"};
    LayeredResults results;
    const auto& device = document.at("device");
    results.circumstances = {.device = device.at("name"),
                             .driver = device.at("driver"),
                             .api = device.at("api"),
                             .version = document.at("version"),
                             .is_quick = document.at("quick")};
    results.date = document.at("date");
    for (const auto& row : document.at("rows"))
      results.rows.push_back({.scene = row.at("scene"),
                              .test_case = row.at("case"),
                              .figure = row.at("figure"),
                              .writer = row.at("preset"),
                              .side = row.at("side"),
                              .maps = row.at("maps"),
                              .gpu_ms = row.at("gpu_ms"),
                              .gpu_ms_spread = row.at("gpu_ms_spread"),
                              .cpu_us = row.at("cpu_us"),
                              .splits = row.at("splits"),
                              .rounds = row.at("rounds"),
                              .repeats = row.at("repeats")});
    if (std::any_of(results.rows.begin(), results.rows.end(), [](const LayeredRow& row) { return row.maps == 0; }))
      return Error{ErrorCode::invalid_argument, file + ": a row has no maps"};
    return results;
  } catch (const nlohmann::json::exception& fault) {
    return Error{ErrorCode::invalid_argument, file + " is not what bench layered writes: " + fault.what()};
  }
}

std::string to_csv(const LayeredResults& results) {
  std::string text =
      "scene,case,figure,writer,side,maps,gpu_ms,gpu_ms_spread,gpu_ms_per_map,cpu_us,cpu_us_per_map,splits,repeats\n";
  for (const LayeredRow& row : results.rows) {
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, "%u,%u,%.4f,%.4f,%.4f,%.2f,%.2f,%u,%u\n", row.side, row.maps, row.gpu_ms,
                  row.gpu_ms_spread, row.gpu_ms / row.maps, row.cpu_us, row.cpu_us / row.maps, row.splits, row.repeats);
    text += row.scene + ",\"" + row.test_case + "\"," + row.figure + "," + row.writer + "," + numbers;
  }
  return text;
}

}  // namespace app
