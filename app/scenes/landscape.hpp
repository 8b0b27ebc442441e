// A valley at dusk: a small town by a lake, its lamps lit while the sun still shines low over the hills.
#pragma once
#include "import/scene.hpp"
#include "scenes/mesh_builder.hpp"

namespace app {

/// Placement, lights and cameras do not depend on the detail.
Scene make_landscape(Detail detail);

constexpr uint32_t landscape_lamp_count = 200;  ///< Beside the sun.

}  // namespace app
