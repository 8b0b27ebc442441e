// Reference of the page rasteriser: triangles in clip space → depth at the centres of a view's texels. Vertices snap to 1/256 of
// a texel, an integer edge function per texel, the top-left rule, depth in double precision from the snapped vertices.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace reference {

/// A square of a view's texels, row by row. Reversed depth: 1 at the near plane, 0 where nothing is.
struct DepthWindow {
  DepthWindow(uint32_t view_resolution, glm::uvec2 first_texel, uint32_t window_side)
      : resolution(view_resolution),
        first(first_texel),
        side(window_side),
        depth(size_t(side) * side),
        covered(size_t(side) * side) {}
  uint32_t resolution;  ///< Of the view.
  glm::uvec2 first;
  uint32_t side;
  std::vector<double> depth;
  std::vector<bool> covered;
};

/// Adds a triangle, cut at the near plane (z <= w), the far one (z >= 0) and far beyond the view's sides.
void draw_triangle(DepthWindow&, const std::array<glm::vec4, 3>& clip_positions);

}  // namespace reference
