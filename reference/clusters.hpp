// Reference of cluster assignment: which clusters a camera's visible samples fall into, and their boxes.
// Olsson et al. 2014, sections 3.1 and 3.3 (explicit bounds).
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/box.hpp"

namespace reference {

/// Screen tiles × exponential depth slices: slice k holds view depths near·ratio^k ≤ z < near·ratio^(k+1).
struct ClusterGrid {
  uint32_t width = 0, height = 0;  ///< Pixels.
  uint32_t tile = 32;              ///< Pixels along a tile's side; the last tiles may reach beyond the picture.
  uint32_t slices = 1;             ///< Depths before the first or beyond the last slice belong to those.
  float near = 0.1f;               ///< > 0.
  float ratio = 1.1f;              ///< > 1.
  glm::mat4 view_from_world{1};    ///< Rigid, mirroring allowed.
  glm::mat4 clip_from_view{
      1};  ///< Any projection whose clip depths 0.25 and 0.75 lie in front: all that Vulkan hosts use.
  /// +1: pixel y grows with normalised y (Vulkan's viewport); −1: a viewport of negative height.
  float pixel_y_sign = 1;

  uint32_t tiles_x() const { return (width + tile - 1) / tile; }
  uint32_t tiles_y() const { return (height + tile - 1) / tile; }
};

/// The ratio that makes cells about as deep as wide (section 3.1): 1 + 2 tan(fov_y / 2) / tiles along y.
float cubic_ratio(float fov_y_rad, uint32_t tiles_y);

struct ClusterCell {
  uint32_t tile_x = 0, tile_y = 0, slice = 0;
};

struct Cluster {
  ClusterCell cell;
  Box implicit_box;               ///< World box of the cell.
  uint32_t bits = 0;              ///< Three 10-bit number lines: x in bits 0…9, y in 10…19, z in 20…29.
  Box explicit_box;               ///< What the bits leave of implicit_box.
  std::vector<uint32_t> samples;  ///< Pixels y·width + x, ascending.
};

/// Depth along the camera's forward axis, positive in front; recovered from clip_from_view for either handedness.
float view_depth(const ClusterGrid&, glm::vec3 position_ws);

uint32_t slice_of(const ClusterGrid&, float depth);

/// The eight world-space corners of a cell, x fastest, then y, then depth.
std::array<glm::vec3, 8> cell_corners(const ClusterGrid&, ClusterCell);

Box implicit_box(const ClusterGrid&, ClusterCell);

/// One bit per axis: ⌊10 t⌋ clamped to 0…9, t = where the position lies between the box's sides (0 where it is flat).
uint32_t explicit_bits(const Box& implicit_box, glm::vec3 position_ws);

/// From the lowest to the highest bit of each line, grown on each side by epsilon × the box's extent, so that
/// rounding in the bits' making never leaves a sample outside. Precondition: each of the three lines has a bit.
Box decode_bits(const Box& implicit_box, uint32_t bits, float epsilon);

/// positions: height × width × 3 floats, world, NaN where nothing is. Clusters ordered by slice, then tile y, then
/// tile x.
std::vector<Cluster> assign_clusters(const ClusterGrid&, std::span<const float> positions, float epsilon);

}  // namespace reference
