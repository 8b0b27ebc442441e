// umbrage info: devices, what each can do, which presets it can run and why not.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>

#include "commands/output.hpp"
#include "umbrage/result.hpp"

namespace app {

enum class InfoFormat : uint8_t { text, json };

struct InfoOptions {
  InfoFormat format = InfoFormat::text;
  std::filesystem::path recommended;  ///< Empty: nothing is measured.
  std::string device;                 ///< To measure.
};

void add_info_options(CLI::App& command, InfoOptions& options);
/// Prints to standard output, or measures and writes a file.
umbrage::Result<void> run_info(const InfoOptions& options, Outputs& outputs);

}  // namespace app
