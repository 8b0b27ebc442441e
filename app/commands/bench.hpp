// umbrage bench SUITE -o DIR
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "commands/output.hpp"
#include "umbrage/result.hpp"

namespace app {

struct BenchOptions {
  std::string suite;
  std::filesystem::path folder;
  std::vector<std::string> scenes;  ///< Of the rigid cases; empty: the ring.
  std::string device;
  bool is_quick = false;
};

void add_bench_options(CLI::App& command, BenchOptions& options);
umbrage::Result<void> run_bench(const BenchOptions& options, Outputs& outputs);

}  // namespace app
