#include "reference/clusters.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <map>
#include <tuple>

namespace reference {
namespace {

/// The view-space point at a normalised device position. Clip depth must not be that of infinity.
glm::vec3 unproject(const glm::mat4& view_from_clip, glm::vec2 ndc, float clip_depth) {
  const glm::vec4 point = view_from_clip * glm::vec4(ndc, clip_depth, 1);
  return glm::vec3(point) / point.w;
}

/// −1 where the camera looks along −Z, +1 along +Z.
float forward_sign(const glm::mat4& view_from_clip) {
  return unproject(view_from_clip, glm::vec2(0), 0.25f).z < 0 ? -1.0f : 1.0f;
}

float slice_start(const ClusterGrid& grid, uint32_t slice) {
  return float(double(grid.near) * std::pow(double(grid.ratio), double(slice)));
}

}  // namespace

float cubic_ratio(float fov_y_rad, uint32_t tiles_y) { return 1 + 2 * std::tan(0.5f * fov_y_rad) / float(tiles_y); }

float view_depth(const ClusterGrid& grid, glm::vec3 position_ws) {
  const float z = (grid.view_from_world * glm::vec4(position_ws, 1)).z;
  return z * forward_sign(glm::inverse(grid.clip_from_view));
}

uint32_t slice_of(const ClusterGrid& grid, float depth) {
  if (!(depth > grid.near)) return 0;
  const double slice = std::floor(std::log(double(depth) / grid.near) / std::log(double(grid.ratio)));
  return uint32_t(std::clamp(slice, 0.0, double(grid.slices - 1)));
}

std::array<glm::vec3, 8> cell_corners(const ClusterGrid& grid, ClusterCell cell) {
  const glm::mat4 view_from_clip = glm::inverse(grid.clip_from_view);
  const glm::mat4 world_from_view = glm::inverse(grid.view_from_world);
  const float sign = forward_sign(view_from_clip);
  std::array<glm::vec3, 8> corners;
  for (uint32_t i = 0; i < 8; ++i) {
    const glm::vec2 pixel(float((cell.tile_x + (i & 1)) * grid.tile), float((cell.tile_y + (i >> 1 & 1)) * grid.tile));
    glm::vec2 ndc = 2.0f * pixel / glm::vec2(grid.width, grid.height) - 1.0f;
    ndc.y *= grid.pixel_y_sign;
    // The line through the pixel corner, cut at the slice's depth: right for perspective and orthographic cameras.
    const glm::vec3 a = unproject(view_from_clip, ndc, 0.25f), b = unproject(view_from_clip, ndc, 0.75f);
    const float z = sign * slice_start(grid, cell.slice + (i >> 2));
    corners[i] = glm::vec3(world_from_view * glm::vec4(a + (b - a) * ((z - a.z) / (b.z - a.z)), 1));
  }
  return corners;
}

Box implicit_box(const ClusterGrid& grid, ClusterCell cell) {
  Box box;
  for (const glm::vec3 corner : cell_corners(grid, cell)) box.grow(corner);
  return box;
}

uint32_t explicit_bits(const Box& implicit_box, glm::vec3 position_ws) {
  uint32_t bits = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = implicit_box.max[axis] - implicit_box.min[axis];
    const float t = extent > 0 ? (position_ws[axis] - implicit_box.min[axis]) / extent : 0;
    bits |= 1u << (10 * axis + int(std::clamp(std::floor(10 * t), 0.0f, 9.0f)));
  }
  return bits;
}

Box decode_bits(const Box& implicit_box, uint32_t bits, float epsilon) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const uint32_t line = bits >> (10 * axis) & 1023u;
    assert(line != 0);
    const float low = float(std::countr_zero(line)) / 10, high = float(std::bit_width(line)) / 10;
    const float start = implicit_box.min[axis], extent = implicit_box.max[axis] - start;
    box.min[axis] = start + (low - epsilon) * extent;
    box.max[axis] = start + (high + epsilon) * extent;
  }
  return box;
}

std::vector<Cluster> assign_clusters(const ClusterGrid& grid, std::span<const float> positions, float epsilon) {
  assert(positions.size() == size_t(3) * grid.width * grid.height);
  std::map<std::tuple<uint32_t, uint32_t, uint32_t>, Cluster> occupied;
  for (uint32_t pixel = 0; pixel < grid.width * grid.height; ++pixel) {
    const glm::vec3 position(positions[3 * size_t(pixel)], positions[3 * size_t(pixel) + 1],
                             positions[3 * size_t(pixel) + 2]);
    if (std::isnan(position.x)) continue;
    const ClusterCell cell{pixel % grid.width / grid.tile, pixel / grid.width / grid.tile,
                           slice_of(grid, view_depth(grid, position))};
    const auto [entry, added] = occupied.try_emplace({cell.slice, cell.tile_y, cell.tile_x});
    Cluster& cluster = entry->second;
    if (added) {
      cluster.cell = cell;
      cluster.implicit_box = implicit_box(grid, cell);
    }
    cluster.bits |= explicit_bits(cluster.implicit_box, position);
    cluster.samples.push_back(pixel);
  }
  std::vector<Cluster> result;
  result.reserve(occupied.size());
  for (auto& [key, cluster] : occupied) {
    cluster.explicit_box = decode_bits(cluster.implicit_box, cluster.bits, epsilon);
    result.push_back(std::move(cluster));
  }
  return result;
}

}  // namespace reference
