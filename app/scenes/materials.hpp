// What the built-in scenes are made of: one table of materials and the images that they use.
#pragma once
#include <cstdint>

#include "import/scene.hpp"

namespace app {

/// Index into Scene::materials. Names of painted wood and plaster say their colour.
enum class Mat : uint32_t {
  plaster_cream,
  plaster_ochre,
  plaster_rose,
  plaster_blue,
  plaster_white,
  plaster_sage,
  stone,
  trim,
  flagstone,
  cobble,
  grass,
  earth,
  roof_red,
  roof_brown,
  roof_slate,
  timber,
  plank,
  paint_green,
  paint_red,
  paint_blue,
  paint_white,
  iron,
  gold,
  glass,
  window_bright,
  window_warm,
  glow,
  dial,
  bark,
  leaf_green,
  leaf_olive,
  leaf_autumn,
  leaf_dark,
  leaf_gold,
  leaf_fir,
  petal_red,
  petal_yellow,
  cloth_white,
  cloth_red,
  cloth_blue,
  straw,
  fruit_orange,
  fruit_green,
  water,
  gravel,
  sand,
  forest_floor,
  wheat,
  stubble,
  plough,
  lake,
  sky,
  count
};

/// Fills scene.images and scene.materials. Texture coordinates are metres; the materials scale them.
void add_materials(Scene& scene);

}  // namespace app
