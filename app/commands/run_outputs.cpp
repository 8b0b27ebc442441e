// What render and compare write alike.
#include "commands/run_outputs.hpp"

#include "commands/dump.hpp"
#include "commands/stats_json.hpp"

namespace app {

umbrage::Result<void> check_run_outputs(const SharedOptions& options, const std::filesystem::path& output) {
  for (const std::filesystem::path& target : {output, options.trace_file, options.stats_file}) {
    if (target.empty()) continue;
    if (const auto checked = check_target(target); !checked) return checked.error();
  }
  return {};
}

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
