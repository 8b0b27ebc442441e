// Small tileable pictures made in code: albedo and tangent-space normals of plaster, stone, wood, tiles, ground; sky.
#pragma once
#include "import/scene.hpp"

namespace app {

/// albedo is sRGB-encoded and close to white where the material's base colour tints it; normal is OpenGL-style (+Y up).
struct Surface {
  Image albedo, normal;
};

Surface make_plaster();
Surface make_masonry();     ///< Coursed rubble, 2 m.
Surface make_flagstones();  ///< 2 m.
Surface make_cobbles();     ///< 2 m.
Surface make_grass();       ///< 4 m.
Surface make_wood();        ///< Grain along v, 1 m.
Surface make_clay();        ///< Roof tiles' mottling, 2 m.
Surface make_rows();        ///< Of a field, along u, 4 m.
Surface make_ripples();     ///< On water, 12 m.
Image make_window_glow();   ///< One pane over 0…1: a lit room behind curtains.
Image make_sky();           ///< u around, v from zenith (0) to horizon (1): dusk.
Image make_lake_glow();     ///< What a lake shows of it: u from the sun's side, v along.
Image make_evening_sky();   ///< u around, the sun at 0.5; v from zenith (0) to far below the horizon, which is at 0.88.

}  // namespace app
