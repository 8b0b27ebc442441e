// umbrage info: devices, what each can do, which presets it can run and why not.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>

#include "umbrage/result.hpp"

namespace app {

enum class InfoFormat : uint8_t { text, json };

struct InfoOptions {
  InfoFormat format = InfoFormat::text;
};

void add_info_options(CLI::App& command, InfoOptions& options);
/// Prints to standard output.
umbrage::Result<void> run_info(const InfoOptions& options);

}  // namespace app
