// Walls and what is in them. A wall stands in the plane z = 0 of the current frame, centred on x, outside towards +z.
#pragma once
#include <optional>
#include <vector>

#include "scenes/mesh_builder.hpp"
#include "scenes/random.hpp"

namespace app {

enum class OpeningKind : uint8_t { window, door, shop_window };

/// A hole in a wall with its woodwork; x is its middle, y its bottom.
struct Opening {
  OpeningKind kind = OpeningKind::window;
  float x = 0, y = 0, width = 0.9f, height = 1.3f;
  Mat pane = Mat::glass;
  Mat frame = Mat::paint_white;
  std::optional<Mat> shutters;
  bool flowers = false;
};

struct Wall {
  float width = 1, bottom = 0, top = 1;
  Mat mat = Mat::plaster_cream;
  std::optional<float> gable;  ///< Height of the apex of a triangle on top.
  std::vector<Opening> openings;
};

constexpr float reveal_m = 0.17f;  ///< From a wall's face back to its window frames.

/// `random` is a copy: what a detail draws from it changes nothing that is decided afterwards.
void add_wall(MeshBuilder& builder, const Wall& wall, Detail detail, Random random);
/// Beams on the wall's face: plates, posts beside openings, braces in the outer bays, and a lattice in the gable.
void add_timber(MeshBuilder& builder, const Wall& wall, Mat mat, Detail detail);
/// Rails and balusters from `from` to `to` on level ground.
void add_railing(MeshBuilder& builder, Mat mat, glm::vec3 from, glm::vec3 to, float height, Detail detail);
/// A striped cloth on two arms over a shop front, from x = -width/2 to width/2 at height y.
void add_awning(MeshBuilder& builder, Mat stripe, float width, float y, Detail detail);
/// Leaves and flowers around `centre` within half sizes `spread`.
void add_flowers(MeshBuilder& builder, glm::vec3 centre, glm::vec3 spread, int count, Random& random);
/// A window pane as if somebody was at home, or not.
Mat pick_pane(Random& random);

}  // namespace app
