// What can stand in a scene, and where.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace app {

/// Houses follow `first_house`, one model a style.
enum class Model : uint32_t {
  street_lamp,
  wall_lamp,
  yard_lamp,
  bench,
  barrels,
  crates,
  cart,
  well,
  firewood,
  stall_red,
  stall_blue,
  fountain,
  laundry,
  picket_fence,
  stone_wall,
  flower_bed,
  gravestone,
  planter,
  oak,
  lime,
  maple,
  spruce,
  poplar,
  bush,
  church,
  fir,
  tall_fir,
  beech,
  birch,
  reeds,
  hay_bale,
  windmill,
  jetty,
  boat,
  floodlight,
  first_house
};

struct Standing {
  Model model = Model::bench;
  glm::vec3 position{0};
  float turn = 0;  ///< Around y; 0 faces +z.
  float scale = 1;
};

}  // namespace app
