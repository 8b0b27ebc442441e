// What render and compare write alike: --dump, --trace, --stats.
#pragma once
#include "commands/output.hpp"
#include "commands/progress.hpp"
#include "commands/session.hpp"
#include "umbrage/result.hpp"

namespace app {

/// Those that the options ask for; statistics last.
umbrage::Result<void> write_run_outputs(Session& session, Outputs& outputs, Progress& progress);

}  // namespace app
