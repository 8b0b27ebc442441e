// Named views of a built-in scene.
#pragma once
#include <span>

#include "import/scene.hpp"
#include "scenes/terrain.hpp"

namespace app {

struct View {
  const char* name;
  glm::vec2 eye;     ///< x, z.
  float eye_height;  ///< Over the ground.
  glm::vec2 target;
  float target_height;
  float fov_y_deg;
};

void add_cameras(Scene& scene, const Terrain& terrain, std::span<const View> views);

}  // namespace app
