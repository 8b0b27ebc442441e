// umbrage compare SCENE: shadows against the CPU ray tracer, as JSON.
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>

#include "commands/options.hpp"
#include "commands/output.hpp"
#include "umbrage/result.hpp"

namespace app {

struct CompareOptions {
  SharedOptions shared;
  std::filesystem::path report = "-";  ///< "-": standard output.
};

void add_compare_options(CLI::App& command, CompareOptions& options);
/// Draws the frames, compares the last one light by light, writes the report.
umbrage::Result<void> run_compare(const CompareOptions& options, Outputs& outputs);

}  // namespace app
