// What stands beyond the town. Each model stands on y = 0 at the origin and faces +z unless said otherwise.
#pragma once
#include "scenes/mesh_builder.hpp"

namespace app {

void add_reeds(MeshBuilder&, Detail);
void add_hay_bale(MeshBuilder&, Detail);  ///< Round, rolled along x.
void add_windmill(MeshBuilder&, Detail);  ///< A tower mill, its sails to +z.
void add_jetty(MeshBuilder&, Detail);     ///< From the origin out to z = jetty_m, its planks at y = 0.
void add_boat(MeshBuilder&, Detail);      ///< A rowing boat along z, afloat at y = 0.
constexpr float jetty_m = 26, jetty_half_m = 1.3f;

/// A kerbed pit in the ground; the light belongs at floodlight_light.
void add_floodlight(MeshBuilder&, Detail);
constexpr glm::vec3 floodlight_light{0, 0.35f, 0};

}  // namespace app
