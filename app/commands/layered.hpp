// umbrage layered USE SCENE -o OUT.png: what layered passes are for, as pictures.
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "commands/camera_source.hpp"
#include "commands/output.hpp"
#include "commands/parse.hpp"
#include "umbrage/layered_pass.hpp"

namespace app {

struct LayeredOptions {
  std::string use, scene, writer, device;
  std::filesystem::path image, recommended;
  Extent size{480, 320};
  CameraOptions camera;
  double time_s = 0;
  bool validate = false;
};

void add_layered_options(CLI::App& command, LayeredOptions& options);
umbrage::Result<void> run_layered(const LayeredOptions& options, Outputs& outputs);

}  // namespace app
