// What render and compare write alike.
#include "commands/run_outputs.hpp"

#include "commands/dump.hpp"
#include "commands/stats_json.hpp"

namespace app {

umbrage::Result<void> write_run_outputs(Session& session, Outputs& outputs, Progress& progress) {
  const SharedOptions& options = session.options();
  if (!options.dump_folder.empty()) {
    const auto dumped = write_dump(session, outputs, progress);
    if (!dumped) return dumped.error();
  }
  if (!options.trace_file.empty()) {
    const auto traced = write_text(outputs, options.trace_file, to_text(trace_document(session.report())));
    if (!traced) return traced.error();
  }
  if (options.stats_file.empty()) return {};
  return write_text(outputs, options.stats_file, to_text(stats_document(session)));
}

}  // namespace app
