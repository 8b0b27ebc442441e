// Things that stand about in a town. Each stands on y = 0 at the origin and faces +z unless said otherwise.
#pragma once
#include "scenes/roof.hpp"

namespace app {

// Lamps. The light itself belongs at *_light, in an open lantern whose mantle shines above it and whose bars are thin.
constexpr glm::vec3 street_lamp_light{0, 3.35f, 0.95f};
constexpr glm::vec3 wall_lamp_light{0, 0, 0.62f};  ///< The bracket's plate is on the wall z = 0 at the light's height.
constexpr glm::vec3 yard_lamp_light{0, 2.45f, 0};
void add_street_lamp(MeshBuilder&, Detail);
void add_wall_lamp(MeshBuilder&, Detail);
void add_yard_lamp(MeshBuilder&, Detail);

void add_bench(MeshBuilder&, Detail);
void add_barrels(MeshBuilder&, Detail);
void add_crates(MeshBuilder&, Detail);
void add_cart(MeshBuilder&, Detail);
void add_well(MeshBuilder&, Detail);
void add_firewood(MeshBuilder&, Detail);
void add_market_stall(MeshBuilder&, Detail, Mat cloth);
void add_fountain(MeshBuilder&, Detail);
void add_laundry(MeshBuilder&, Detail);       ///< 6 m along x between two posts.
void add_picket_fence(MeshBuilder&, Detail);  ///< fence_m along x, centred.
void add_stone_wall(MeshBuilder&, Detail);    ///< fence_m along x, centred.
void add_flower_bed(MeshBuilder&, Detail);
void add_gravestone(MeshBuilder&, Detail);
void add_planter(MeshBuilder&, Detail);  ///< A tub with a clipped little tree.
constexpr float fence_m = 2.4f;

void add_broad_tree(MeshBuilder&, Detail, Mat leaves, float height, uint32_t seed);
void add_spruce(MeshBuilder&, Detail, uint32_t seed);
void add_poplar(MeshBuilder&, Detail, uint32_t seed);
void add_bush(MeshBuilder&, Detail, uint32_t seed);
// Of woods: few triangles, since there are many of them.
void add_fir(MeshBuilder&, Detail, float height, uint32_t seed);
void add_crown_tree(MeshBuilder&, Detail, Mat leaves, float height, uint32_t seed);

}  // namespace app
