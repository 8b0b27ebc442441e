// The HOUSES scene: a small old town at dusk, made by a generator that gives the same bytes every time.
// Olsson et al. 2014, section 6: 1.01 M triangles, 256 lights of similar size, evenly spread.
#pragma once
#include "import/scene.hpp"
#include "scenes/mesh_builder.hpp"

namespace app {

/// Placement, lamps and cameras do not depend on the detail.
Scene make_town(Detail detail);

constexpr uint32_t town_light_count = 256;

}  // namespace app
