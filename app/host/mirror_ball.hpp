// A ball that mirrors what is around it: a mesh of the scene, whose reflection the renderer draws every frame.
#pragma once
#include "import/scene.hpp"

namespace app {

struct MirrorBall {
  glm::vec3 center{0};
  float radius = 1;
  uint32_t mesh = 0;  ///< Of the scene.
};

/// Triangles around a point, with normals; smooth from some metres away at a radius of one.
Primitive ball_primitive(const glm::vec3& center, float radius);
/// Adds its material, its mesh and a node. Casts shadows like any other.
MirrorBall add_mirror_ball(Scene&, const glm::vec3& center, float radius);

}  // namespace app
