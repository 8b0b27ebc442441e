// Ground as a grid whose triangles are cut along the contours of distance fields, so that kerbs and shores are smooth.
#pragma once
#include <array>
#include <functional>
#include <span>

#include "scenes/mesh_builder.hpp"

namespace app {

/// A kind of ground lies where its field is negative and those of all kinds before it are not.
struct GroundKind {
  Mat mat = Mat::grass;
  float below_m = 0;     ///< Under the height of the land.
  Mat edge = Mat::trim;  ///< Of the step up to what lies higher.
};

constexpr size_t max_ground_fields = 8;
using GroundFields = std::array<float, max_ground_fields>;

struct GroundDesc {
  std::span<const GroundKind> kinds;
  GroundKind rest;                                ///< Where no field is negative.
  std::function<float(glm::vec2)> height;         ///< At (x, z).
  std::function<GroundFields(glm::vec2)> fields;  ///< Metres, as many as there are kinds.
};

/// `lines` are the grid's in x and in z, rising.
void add_ground(MeshBuilder& builder, const GroundDesc& desc, std::span<const float> lines);

/// Grid lines from -half to half: every `step` up to `fine_half`, then ever wider, by at least `coarse`.
struct GridDesc {
  float half, fine_half, step, coarse;
  float growth = 1;  ///< Of the step beyond fine_half, from line to line.
};
std::vector<float> grid_lines(const GridDesc& desc);

/// Signed distance from a segment's, and from an upright rectangle's border.
float segment_distance(glm::vec2 p, glm::vec2 a, glm::vec2 b);
float box_distance(glm::vec2 p, glm::vec2 middle, glm::vec2 half);
/// 0 below `low`, 1 above `high`, smooth between.
float smooth_ramp(float low, float high, float x);

}  // namespace app
