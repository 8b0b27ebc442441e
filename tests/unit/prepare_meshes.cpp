// Generated meshes; the same on every machine that runs the same standard library.
#include "prepare_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace test {
namespace {

using umbrage::Vec3;

void add_triangle(TriangleMesh& mesh, Vec3 corner, float size) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back(corner);
  mesh.positions.push_back({corner.x + size, corner.y, corner.z});
  mesh.positions.push_back({corner.x, corner.y + size, corner.z});
  for (uint32_t i = 0; i < 3; ++i) mesh.indices.push_back(first + i);
}

/// Every triangle the same three vertices.
TriangleMesh repeated(uint32_t count) {
  TriangleMesh mesh{"repeated", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}};
  for (uint32_t t = 0; t < count; ++t) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
  return mesh;
}

/// Distinct vertices, one place.
TriangleMesh coincident(uint32_t count) {
  TriangleMesh mesh{"coincident", {}, {}, {}};
  for (uint32_t t = 0; t < count; ++t) add_triangle(mesh, {3, -4, 5}, 0);
  return mesh;
}

/// Repeated indices within a triangle, and three vertices on a line.
TriangleMesh degenerate(uint32_t count) {
  TriangleMesh mesh{"degenerate", {}, {}, {}};
  for (uint32_t t = 0; t < count + 2; ++t) mesh.positions.push_back({static_cast<float>(t), 0, 0});
  for (uint32_t t = 0; t < count; ++t) {
    if (t % 3 == 0) mesh.indices.insert(mesh.indices.end(), {t, t, t});
    if (t % 3 == 1) mesh.indices.insert(mesh.indices.end(), {t, t + 1, t});
    if (t % 3 == 2) mesh.indices.insert(mesh.indices.end(), {t, t + 1, t + 2});
  }
  return mesh;
}

TriangleMesh scaled_soup(const char* name, uint32_t count, float scale) {
  TriangleMesh mesh = soup(count, 5);
  mesh.name = name;
  for (Vec3& p : mesh.positions) p = {p.x * scale, (0.5f - p.y) * scale, p.z * scale};
  return mesh;
}

/// From end to end of what floats hold.
TriangleMesh whole_range(uint32_t count) {
  constexpr float Max = std::numeric_limits<float>::max();
  TriangleMesh mesh{"whole range", {{-Max, -Max, -Max}, {Max, Max, Max}, {Max, -Max, 0}, {0, 0, 1}}, {}, {}};
  for (uint32_t t = 0; t < count; ++t) {
    for (uint32_t i = 0; i < 3; ++i) mesh.indices.push_back((t + i) % 4);
  }
  return mesh;
}

/// A line whose gaps shrink steadily: everyone's nearest is the next one, so that few pairs are each other's nearest.
TriangleMesh shrinking_gaps(uint32_t count) {
  TriangleMesh mesh{"shrinking gaps", {}, {}, {}};
  float x = 0;
  for (uint32_t t = 0; t < count; ++t) {
    add_triangle(mesh, {x, 0, 0}, 0);
    x += 2 - static_cast<float>(t) / static_cast<float>(count);
  }
  return mesh;
}

/// Sizes over 80 powers of two, nested around one corner.
TriangleMesh nested(uint32_t count) {
  TriangleMesh mesh{"nested", {}, {}, {}};
  for (uint32_t t = 0; t < count; ++t) add_triangle(mesh, {0, 0, 0}, std::ldexp(1.0f, static_cast<int>(t % 80) - 40));
  return mesh;
}

/// All share one vertex.
TriangleMesh fan(uint32_t count) {
  TriangleMesh mesh{"fan", {{0, 0, 1}}, {}, {}};
  for (uint32_t t = 0; t <= count; ++t) {
    const float angle = 6.2831853f * static_cast<float>(t) / static_cast<float>(count);
    mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
    if (t > 0) mesh.indices.insert(mesh.indices.end(), {0, t, t + 1});
  }
  return mesh;
}

}  // namespace

TriangleMesh wavy_grid(uint32_t columns, uint32_t rows) {
  TriangleMesh mesh{"grid", {}, {}, {}};
  for (uint32_t y = 0; y <= rows; ++y) {
    for (uint32_t x = 0; x <= columns; ++x) {
      const auto u = static_cast<float>(x), v = static_cast<float>(y);
      mesh.positions.push_back({u, v, 6 * std::sin(0.11f * u) * std::cos(0.07f * v)});
    }
  }
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < columns; ++x) {
      const uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  }
  return mesh;
}

TriangleMesh rough_grid(uint32_t columns, uint32_t rows, uint32_t seed) {
  TriangleMesh mesh = wavy_grid(columns, rows);
  mesh.name = "rough grid";
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> offset(-0.4f, 0.4f);
  for (Vec3& p : mesh.positions) p = {p.x + offset(random), p.y + offset(random), p.z + offset(random)};
  return mesh;
}

TriangleMesh soup(uint32_t triangle_count, uint32_t seed) {
  TriangleMesh mesh{"soup", {}, {}, {}};
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  for (uint32_t t = 0; t < triangle_count; ++t) {
    const Vec3 centre{unit(random), unit(random), unit(random)};
    const float size = 0.05f * std::exp2(-8 * unit(random));
    for (uint32_t i = 0; i < 3; ++i) {
      const Vec3 away{unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f};
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back({centre.x + size * away.x, centre.y + size * away.y, centre.z + size * away.z});
    }
  }
  return mesh;
}

TriangleMesh soup_of_submeshes(uint32_t triangle_count, uint32_t submesh_count, uint32_t seed) {
  TriangleMesh mesh = soup(triangle_count, seed);
  mesh.name = "submeshes";
  std::mt19937 random(seed);
  uint32_t first = 0;
  for (uint32_t s = 0; s < submesh_count; ++s) {
    const uint32_t left = triangle_count - first / 3;
    const uint32_t triangles = s + 1 == submesh_count ? left : static_cast<uint32_t>(random() % (left + 1));
    mesh.submeshes.push_back({.first_index = first, .index_count = 3 * triangles});
    first += 3 * triangles;
  }
  mesh.submeshes.push_back({.first_index = 3, .index_count = 0});
  std::shuffle(mesh.submeshes.begin(), mesh.submeshes.end(), random);
  return mesh;
}

std::vector<TriangleMesh> adversarial_meshes(uint32_t triangle_count) {
  TriangleMesh none{"none", {}, {}, {}};
  TriangleMesh only_positions{"only positions", {{1, 2, 3}}, {}, {}};
  TriangleMesh one = soup(1, 1);
  one.name = "one";
  return {none,
          only_positions,
          one,
          repeated(triangle_count),
          coincident(triangle_count),
          degenerate(triangle_count),
          scaled_soup("huge", triangle_count, 1e30f),
          scaled_soup("tiny", triangle_count, 1e-39f),
          whole_range(triangle_count),
          shrinking_gaps(triangle_count),
          nested(triangle_count),
          fan(triangle_count)};
}

}  // namespace test
