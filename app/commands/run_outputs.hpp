// What render and compare write alike: --dump, --trace, --stats.
#pragma once
#include <filesystem>

#include "commands/output.hpp"
#include "commands/progress.hpp"
#include "commands/session.hpp"
#include "umbrage/result.hpp"

namespace app {

/// Says before the work when one of them, or the command's own output, could not be written.
umbrage::Result<void> check_run_outputs(const SharedOptions& options, const std::filesystem::path& output);

/// Those that the options ask for; statistics last.
umbrage::Result<void> write_run_outputs(Session& session, Outputs& outputs, Progress& progress);

}  // namespace app
