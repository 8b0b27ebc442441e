// The town's views.
#pragma once
#include "import/scene.hpp"
#include "scenes/terrain.hpp"

namespace app {

/// `overview` (the first: over the main street towards the church), `street` and `square` at eye height.
void add_cameras(Scene& scene, const Terrain& terrain);

}  // namespace app
