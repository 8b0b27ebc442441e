// Boxes around a light for the tests of cube projection: every small lattice box, random ones, and awkward ones.
#pragma once
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "umbrage/types.hpp"

namespace umbrage::test {

/// All 3,375 boxes, points, lines and plates with corners on {-2, -1, 0, 1, 2}³: every tie there is.
inline std::vector<Aabb> lattice_boxes() {
  std::vector<std::array<float, 2>> spans;
  for (float lo = -2; lo <= 2; ++lo)
    for (float hi = lo; hi <= 2; ++hi) spans.push_back({lo, hi});
  std::vector<Aabb> boxes;
  for (const auto& x : spans)
    for (const auto& y : spans)
      for (const auto& z : spans) boxes.push_back({{x[0], y[0], z[0]}, {x[1], y[1], z[1]}});
  return boxes;
}

/// Centres at 0.1…10 from the light in any direction, half sizes per axis log-uniform between the given multiples of
/// that distance.
inline std::vector<Aabb> random_boxes(size_t count, float smallest, float largest, uint32_t seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Aabb> boxes;
  while (boxes.size() < count) {
    const Vec3 d{normal(engine), normal(engine), normal(engine)};
    const float length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    if (length < 1e-3f) continue;
    const float distance = std::pow(10.0f, 2 * unit(engine) - 1);
    const auto half = [&] { return distance * smallest * std::pow(largest / smallest, unit(engine)); };
    const Vec3 c{d.x / length * distance, d.y / length * distance, d.z / length * distance};
    const Vec3 h{half(), half(), half()};
    boxes.push_back({{c.x - h.x, c.y - h.y, c.z - h.z}, {c.x + h.x, c.y + h.y, c.z + h.z}});
  }
  return boxes;
}

/// Slivers, edges along a pyramid's border, huge and tiny boxes, boxes that just miss or touch, on all axes and sides.
inline std::vector<Aabb> awkward_boxes() {
  const float below = std::nextafter(1.0f, 0.0f), above = std::nextafter(1.0f, 2.0f);
  const std::vector<Aabb> kinds = {
      {{1, 1, 1}, {1, 1, 1}},
      {{1, below, 0}, {1, above, 0}},
      {{1, above, -0.5f}, {1, 2, 0.5f}},
      {{1, -below, 0.25f}, {above, below, 0.25f}},
      {{1e-30f, -1e-30f, -1e-30f}, {2e-30f, 1e-30f, 1e-30f}},
      {{-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f}},
      {{0.5f, -1e6f, -1e6f}, {0.6f, 1e6f, 1e6f}},
      {{1e-6f, -3, 2}, {5, 3, 2.5f}},
      {{-1e-6f, -3, 2}, {5, 3, 2.5f}},
      {{0, 0, 0}, {4, 3, 2}},
      {{0, -1, -1}, {0, 1, 1}},
      {{0, 0, -5}, {0, 0, 5}},
      {{-3, -2, -1}, {3, 2, 1}},
      {{0.999f, -100, -0.001f}, {1, 100, 0.001f}},
      {{100, 99.99f, -1e-3f}, {100.01f, 100, 1e-3f}},
  };
  std::vector<Aabb> boxes;
  for (const Aabb& kind : kinds)
    for (size_t turn = 0; turn < 3; ++turn)
      for (uint32_t mirror = 0; mirror < 8; ++mirror) {
        const std::array<float, 3> lo{kind.min.x, kind.min.y, kind.min.z}, hi{kind.max.x, kind.max.y, kind.max.z};
        std::array<float, 3> new_lo, new_hi;
        for (size_t axis = 0; axis < 3; ++axis) {
          const size_t from = (axis + turn) % 3;
          const bool flip = (mirror >> axis & 1) != 0;
          new_lo[axis] = flip ? -hi[from] : lo[from];
          new_hi[axis] = flip ? -lo[from] : hi[from];
        }
        boxes.push_back({{new_lo[0], new_lo[1], new_lo[2]}, {new_hi[0], new_hi[1], new_hi[2]}});
      }
  return boxes;
}

inline std::vector<Aabb> all_boxes(size_t random_count) {
  std::vector<Aabb> boxes = lattice_boxes();
  for (const std::vector<Aabb>& more :
       {awkward_boxes(), random_boxes(random_count, 1e-3f, 0.3f, 1), random_boxes(random_count, 0.1f, 3.0f, 2)})
    boxes.insert(boxes.end(), more.begin(), more.end());
  return boxes;
}

}  // namespace umbrage::test
