// umbrage bench cascades: the motions of "CSM Scrolling" (C9) and what games do besides, in every mode.
#pragma once
#include "commands/bench.hpp"

namespace app {

umbrage::Result<void> run_cascades_bench(const BenchOptions& options, Outputs& outputs);

}  // namespace app
