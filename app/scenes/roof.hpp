// Roofs: boarded slopes under rows of tiles, ridges, dormers, chimneys.
#pragma once
#include "scenes/facade.hpp"

namespace app {

/// A slope seen from outside, counter-clockwise; the two ends of the ridge may coincide.
struct Slope {
  glm::vec3 eave_left, eave_right, ridge_right, ridge_left;
};

void add_slope(MeshBuilder& builder, Mat tiles, const Slope& slope, Detail detail, Random& random);
/// Half-round tiles over the edge between two slopes, from low (or either) end to the other.
void add_ridge(MeshBuilder& builder, Mat tiles, glm::vec3 from, glm::vec3 to, Detail detail);

enum class RoofKind : uint8_t { gable_side, gable_front, hip };

struct Roof {
  RoofKind kind = RoofKind::gable_side;
  float left = -4, right = 4, back = -8, front = 0;  ///< The walls' faces.
  float eave = 5.6f;                                 ///< Top of the walls.
  float pitch = 0.9f;                                ///< Rise over run.
  float overhang = 0.45f;
  Mat tiles = Mat::roof_red;
  float apex() const;  ///< Height of the ridge line.
};

void add_roof(MeshBuilder& builder, const Roof& roof, Detail detail, Random random);
/// A window in its own little house on the front slope of a side-gabled or hipped roof.
void add_dormer(MeshBuilder& builder, const Roof& roof, float x, Mat wall, Mat frame, Detail detail, Random& random);
/// Stands through the roof at (x, z), up to `top`.
void add_chimney(MeshBuilder& builder, float x, float z, float bottom, float top, Detail detail);

}  // namespace app
