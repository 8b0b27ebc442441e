// umbrage render SCENE -o OUT.png
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "commands/options.hpp"
#include "commands/output.hpp"
#include "umbrage/result.hpp"

namespace app {

struct RenderOptions {
  SharedOptions shared;
  std::string image;  ///< Empty: none wanted.
};

void add_render_options(CLI::App& command, RenderOptions& options);
umbrage::Result<void> run_render(const RenderOptions& options, Outputs& outputs);

}  // namespace app
