// House types. Each is one mesh: floor at y = 0, front wall in the plane z = 0 facing +z, centred on x; its plinth and
// steps reach below the floor into any ground.
#pragma once
#include <span>

#include "scenes/roof.hpp"

namespace app {

struct HouseStyle {
  const char* name = "";
  float width = 8, depth = 8;
  int storeys = 2;
  RoofKind roof = RoofKind::gable_side;
  float pitch = 0.9f;
  Mat wall = Mat::plaster_cream, roof_tiles = Mat::roof_red, paint = Mat::paint_green;
  bool timbered = false;  ///< Upper storeys half-timbered, and standing out over the street by `jetty_m`.
  float jetty_m = 0;
  bool shutters = false, flowers = false, balcony = false, shop = false;
  int dormers = 0;
  float wing_m = 0;  ///< Length of a wing behind (an L); 0: none.
  uint32_t seed = 1;
};

constexpr float storey_m = 2.75f;

std::span<const HouseStyle> house_styles();
void add_house(MeshBuilder& builder, const HouseStyle& style, Detail detail);
/// Nave 9 m × 20 m with its door in the plane z = 0, and a tower of 5.6 m × 5.6 m in front of it, to z = 5.6.
void add_church(MeshBuilder& builder, Detail detail);

}  // namespace app
