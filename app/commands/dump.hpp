// --dump: the last frame as NumPy arrays, and its lights.
#pragma once
#include "commands/output.hpp"
#include "commands/progress.hpp"
#include "commands/session.hpp"
#include "umbrage/result.hpp"

namespace app {

/// Writes position, normal, color and visibility (.npy) and lights.json into the options' folder, which is made when
/// it is not there. The files are put in place when all of them are complete. With --dump-lights, rows of
/// visibility.npy and entries of lights.json are the chosen lights in ascending order.
umbrage::Result<void> write_dump(Session& session, Outputs& outputs, Progress& progress);

}  // namespace app
