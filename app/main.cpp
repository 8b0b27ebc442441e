// umbrage, the program: reads the command line, runs one command, says what went wrong in one line.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "commands/bench.hpp"
#include "commands/compare.hpp"
#include "commands/info.hpp"
#include "commands/layered.hpp"
#include "commands/output.hpp"
#include "commands/render.hpp"

namespace {

enum ExitStatus : int { kDone = 0, kFailed = 1, kWrongUsage = 2 };

/// One line, whatever a file put into the message.
int report(std::string message, ExitStatus status) {
  for (char& character : message)
    if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f) character = ' ';
  std::fprintf(stderr, "umbrage: error: %s\n", message.c_str());
  return status;
}

std::string command_names(const CLI::App& program) {
  std::string names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

int run(int argc, char** argv, app::Outputs& outputs) {
  CLI::App program("Real-time shadows from hundreds to thousands of lights", "umbrage");
  program.require_subcommand(1);
  program.set_version_flag("--version", std::string("umbrage ") + UMBRAGE_VERSION);
  app::RenderOptions render_options;
  CLI::App* render = program.add_subcommand("render", "Render headless");
  app::add_render_options(*render, render_options);
  app::CompareOptions compare_options;
  CLI::App* compare = program.add_subcommand("compare", "Shadows against the CPU ray tracer, as JSON");
  app::add_compare_options(*compare, compare_options);
  app::BenchOptions bench_options;
  CLI::App* bench = program.add_subcommand("bench", "Measure; writes results, figures and a report");
  app::add_bench_options(*bench, bench_options);
  app::LayeredOptions layered_options;
  CLI::App* layered = program.add_subcommand("layered", "Many views of a scene: cube maps, cascades, reflections, …");
  app::add_layered_options(*layered, layered_options);
  app::InfoOptions info_options;
  CLI::App* info = program.add_subcommand("info", "Devices, what each can do and which presets it can run");
  app::add_info_options(*info, info_options);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& stop) {
    if (stop.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return program.exit(stop);
    const auto begun = program.get_subcommands();
    if (begun.empty() && argc > 1 && argv[1][0] != '-')
      return report("there is no command \"" + std::string(argv[1]) + "\"; choose from " + command_names(program),
                    kWrongUsage);
    const std::string command = begun.empty() ? "" : begun.front()->get_name() + " ";
    return report(std::string(stop.what()) + " (see umbrage " + command + "--help)", kWrongUsage);
  }
  umbrage::Result<void> result;
  if (render->parsed())
    result = app::run_render(render_options, outputs);
  else if (compare->parsed())
    result = app::run_compare(compare_options, outputs);
  else if (bench->parsed())
    result = app::run_bench(bench_options, outputs);
  else if (layered->parsed())
    result = app::run_layered(layered_options, outputs);
  else
    result = app::run_info(info_options, outputs);
  return result ? kDone : report(result.error().message, kFailed);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    app::Outputs outputs;
    return run(argc, argv, outputs);
  } catch (const std::bad_alloc&) {
    return report("out of memory; try a smaller --size, --budget or scene", kFailed);
  } catch (const std::exception& fault) { return report(std::string("unexpected: ") + fault.what(), kFailed); }
}
