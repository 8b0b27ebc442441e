// A dome of sky around a scene. It shines, and is beyond the reach of every lamp.
#pragma once
#include "scenes/mesh_builder.hpp"

namespace app {

struct SkyDome {
  float radius_m, bottom_m, rise_m;  ///< Half an ellipsoid, standing on `bottom_m`.
};
/// The texture's u = 0.5 is north, v from the zenith (0) down to the rim.
void add_sky(MeshBuilder& builder, const SkyDome& dome, Detail detail);

}  // namespace app
