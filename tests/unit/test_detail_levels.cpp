// Levels of detail as the program makes them: distances to surfaces against brute force, and what every level must fulfil.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>
#include <numeric>
#include <random>

#include "import/detail_levels.hpp"
#include "import/surface_distance.hpp"

namespace app {
namespace {

struct Surface {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  size_t triangles() const { return indices.size() / 3; }
  glm::dvec3 corner(size_t triangle, size_t i) const { return glm::dvec3(positions[indices[3 * triangle + i]]); }
};

// --- Distances by brute force -------------------------------------------------------------------------------------------

double distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const double length2 = glm::dot(b - a, b - a);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, b - a) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + t * (b - a));
}

/// By barycentric coordinates of the foot of the perpendicular.
double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = b - a, v = c - a, w = p - a;
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), wu = glm::dot(w, u), wv = glm::dot(w, v);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 1e-14 * uu * vv) {
    const double s = (wu * vv - wv * uv) / determinant, t = (wv * uu - wu * uv) / determinant;
    if (s >= 0 && t >= 0 && s + t <= 1) return glm::distance(w, s * u + t * v);
  }
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

double distance_to(const Surface& surface, const glm::dvec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < surface.triangles(); ++i)
    least = std::min(least, distance_to_triangle(p, surface.corner(i, 0), surface.corner(i, 1), surface.corner(i, 2)));
  return least;
}

/// From points all over one surface, so many a triangle, to another.
double distance_between(const Surface& from, const Surface& to, int points, std::mt19937& engine) {
  std::uniform_real_distribution<double> unit(0, 1);
  double most = 0;
  for (size_t i = 0; i < from.triangles(); ++i) {
    for (int point = 0; point < points; ++point) {
      double s = unit(engine), t = unit(engine);
      if (s + t > 1) s = 1 - s, t = 1 - t;
      if (point < 3) s = point == 1, t = point == 2;  // Corners and middles, too.
      else if (point < 6) s = 0.5 * (point != 4), t = 0.5 * (point != 3);
      else if (point == 6) s = t = 1.0 / 3;
      const glm::dvec3 a = from.corner(i, 0);
      most = std::max(most, distance_to(to, a + s * (from.corner(i, 1) - a) + t * (from.corner(i, 2) - a)));
    }
  }
  return most;
}

// --- Surfaces -----------------------------------------------------------------------------------------------------------

/// A grid of rows × columns quads; `place` of coordinates 0…1. Closed ones repeat the vertices of their seam.
template <class Place>
Surface grid(uint32_t rows, uint32_t columns, const Place& place) {
  Surface made;
  for (uint32_t y = 0; y <= rows; ++y)
    for (uint32_t x = 0; x <= columns; ++x)
      made.positions.push_back(place(float(x) / float(columns), float(y) / float(rows)));
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < columns; ++x) {
      const uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
      made.indices.insert(made.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  }
  return made;
}

Surface flat(uint32_t cells) {
  return grid(cells, cells, [](float x, float y) { return glm::vec3(3 * x, 1 + 0.5f * x + 0.25f * y, 2 * y); });
}
/// Whole turns come back to the very same bits.
glm::vec2 turn(float share) {
  const float angle = 2 * glm::pi<float>() * (share == 1 ? 0 : share);
  return {std::cos(angle), std::sin(angle)};
}
Surface sphere(uint32_t rings) {
  return grid(rings, 2 * rings, [](float x, float y) {
    const float polar = glm::pi<float>() * y, across = y == 0 || y == 1 ? 0 : std::sin(polar);
    return glm::vec3(across * turn(x).x, std::cos(polar), across * turn(x).y) * 2.0f;
  });
}
Surface torus(uint32_t rings) {
  return grid(rings, 2 * rings, [](float x, float y) {
    const float out = 1 + 0.4f * turn(y).x;
    return glm::vec3(out * turn(x).x, 0.4f * turn(y).y, out * turn(x).y);
  });
}
Surface hills(uint32_t cells) {
  return grid(cells, cells, [](float x, float y) {
    return glm::vec3(10 * x, std::sin(9 * x) * std::cos(7 * y) + 0.1f * std::sin(31 * x + 17 * y), 10 * y);
  });
}

Surface level_of(const Surface& surface, const DetailLevels& levels, size_t level) {
  const auto begin = levels.indices.begin();
  return {surface.positions, {begin + levels.first_index[level], begin + levels.first_index[level + 1]}};
}

float extent_of(const Surface& surface) {
  glm::vec3 lo = surface.positions[0], hi = lo;
  for (const glm::vec3& p : surface.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
  return glm::length(hi - lo);
}

// --- SurfaceTree --------------------------------------------------------------------------------------------------------

/// Triangles of every size; one in four is degenerate: a point, a line, a corner twice, or next to nothing wide.
Surface random_triangles(size_t count, std::mt19937& engine) {
  std::normal_distribution<float> normal;
  const auto random = [&] { return glm::vec3(normal(engine), normal(engine), normal(engine)); };
  Surface made;
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 centre = 3.0f * random(), a = random(), b = random();
    const float size = std::exp(normal(engine) - 1);
    glm::vec3 corners[3] = {centre, centre + size * a, centre + size * b};
    switch (engine() % 16) {
      case 0: corners[2] = corners[1] = corners[0]; break;
      case 1: corners[2] = corners[0] + (corners[1] - corners[0]) * 0.25f; break;
      case 2: corners[2] = corners[engine() % 2]; break;
      case 3: corners[2] = corners[1] + size * 1e-6f * b; break;
      default: break;
    }
    for (const glm::vec3& corner : corners) {
      made.indices.push_back(static_cast<uint32_t>(made.positions.size()));
      made.positions.push_back(corner);
    }
    if (engine() % 16 == 0) made.indices.back() = made.indices[made.indices.size() - 3];
  }
  return made;
}

TEST(SurfaceTrees, FindTheNearestPoint) {
  std::mt19937 engine(1);
  std::normal_distribution<float> normal;
  for (const size_t count : {1, 2, 4, 5, 9, 64, 700}) {
    const Surface surface = random_triangles(count, engine);
    const SurfaceTree tree(surface.positions, surface.indices);
    for (int i = 0; i < 500; ++i) {
      glm::vec3 point = 4.0f * glm::vec3(normal(engine), normal(engine), normal(engine));
      if (i % 5 == 0) point = surface.positions[engine() % surface.positions.size()];
      if (i % 5 == 1) point = surface.positions[engine() % surface.positions.size()] + 0.01f * point;
      const double expected = distance_to(surface, point);
      const float found = tree.squared_distance(point, 0);
      ASSERT_NEAR(std::sqrt(double(found)), expected, 3e-6 * (1 + expected)) << count << " triangles, point " << i;
      // With a bound, the same or less than the bound, and never nearer than the surface is.
      for (const double share : {0.25, 1.5, 100.0}) {
        const float enough = float(expected * expected * share);
        const float near_enough = tree.squared_distance(point, enough);
        ASSERT_GE(near_enough, found);
        ASSERT_TRUE(near_enough == found || near_enough <= enough) << near_enough << " of " << found;
      }
    }
  }
}

TEST(SurfaceTrees, StopWhenItIsNearEnough) {
  const Surface surface = sphere(32);
  const SurfaceTree tree(surface.positions, surface.indices);
  size_t early = 0;
  for (const glm::vec3& p : surface.positions) {
    const float found = tree.squared_distance(p * 1.5f, 0);
    early += tree.squared_distance(p * 1.5f, 4 * found) > found;
  }
  EXPECT_GT(early, surface.positions.size() / 10);
}

TEST(SampledDistances, AreLargestInEitherDirection) {
  // A tent over a square: its top is 1 above the two triangles that lack it, and these lie below the tent.
  const std::vector<glm::vec3> positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 0}};
  const std::vector<uint32_t> tent = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}, square = {0, 1, 2, 0, 2, 3};
  EXPECT_NEAR(sampled_distance(positions, tent, SurfaceTree(positions, tent), square), 1, 1e-6f);
  // One triangle of the tent: of the others' corners (1, 0, 1) and (-1, 0, 1) are the farthest from it.
  const std::vector<uint32_t> side = {0, 1, 4};
  const Surface one{positions, side};
  EXPECT_NEAR(sampled_distance(positions, tent, SurfaceTree(positions, tent), side), distance_to(one, {1, 0, 1}), 1e-6);
  // A surface that bridges a gap: only samples of it, not corners, lie away from the other.
  const std::vector<glm::vec3> gap = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {9, 0, 0}, {10, 0, 0}, {9, 0, 1}};
  const std::vector<uint32_t> ends = {0, 1, 2, 3, 4, 5}, bridge = {0, 4, 2};
  EXPECT_GT(sampled_distance(gap, ends, SurfaceTree(gap, ends), bridge), 1.5f);
}

// --- Levels -------------------------------------------------------------------------------------------------------------

void expect_sound(const Surface& surface, const DetailLevels& levels) {
  const size_t count = levels.errors_m.size();
  ASSERT_GE(count, 1u);
  ASSERT_LE(count, size_t{umbrage::MaxMeshLevels});
  ASSERT_EQ(levels.first_index.size(), count + 1);
  EXPECT_EQ(levels.first_index.front(), 0u);
  EXPECT_EQ(levels.first_index.back(), levels.indices.size());
  EXPECT_EQ(level_of(surface, levels, 0).indices, surface.indices);
  EXPECT_EQ(levels.errors_m[0], 0);
  for (size_t level = 1; level < count; ++level) {
    EXPECT_GT(levels.errors_m[level], levels.errors_m[level - 1]);
    EXPECT_TRUE(std::isfinite(levels.errors_m[level]));
    const Surface finer = level_of(surface, levels, level - 1), coarser = level_of(surface, levels, level);
    EXPECT_GT(coarser.triangles(), 0u);
    EXPECT_EQ(coarser.indices.size() % 3, 0u);
    EXPECT_LE(coarser.triangles(), finer.triangles() * 3 / 4);
  }
  for (const uint32_t index : levels.indices) ASSERT_LT(index, surface.positions.size());
}

DetailLevels levels_of(const Surface& surface) { return make_detail_levels(surface.positions, surface.indices); }

TEST(DetailLevels, AreFewerTrianglesThatLieFartherOff) {
  std::mt19937 engine(3);
  for (const Surface& surface : {sphere(8), sphere(24), torus(20), hills(40), flat(30), random_triangles(500, engine),
                                 random_triangles(65, engine)})
    expect_sound(surface, levels_of(surface));
  EXPECT_GE(levels_of(sphere(24)).errors_m.size(), 3u);
  EXPECT_GE(levels_of(torus(20)).errors_m.size(), 3u);
}

TEST(DetailLevels, LieAsFarOffAsTheySay) {
  std::mt19937 engine(4);
  for (const Surface& surface : {sphere(12), torus(12), hills(20)}) {
    const DetailLevels levels = levels_of(surface);
    ASSERT_GE(levels.errors_m.size(), 3u);
    for (size_t level = 1; level < levels.errors_m.size(); ++level) {
      const Surface coarse = level_of(surface, levels, level);
      const auto points = static_cast<int>(surface.triangles() * 12 / coarse.triangles());
      const double most =
          std::max(distance_between(surface, coarse, 12, engine), distance_between(coarse, surface, points, engine));
      EXPECT_GE(levels.errors_m[level], 0.8 * most) << "level " << level << ": samples of it miss the worst places";
      EXPECT_LE(levels.errors_m[level], 1.1 * most + 1e-5 * extent_of(surface)) << "level " << level;
      EXPECT_LT(levels.errors_m[level], 0.5f * extent_of(surface));
    }
  }
}

TEST(DetailLevels, OfFlatSurfacesLieWhereTheyLie) {
  const Surface surface = flat(40);
  const DetailLevels levels = levels_of(surface);
  ASSERT_GE(levels.errors_m.size(), 2u);
  EXPECT_LE(levels.errors_m.size(), 3u) << "what is coarser and no farther off takes the place of what is finer";
  const Surface coarsest = level_of(surface, levels, levels.errors_m.size() - 1);
  EXPECT_LE(coarsest.triangles(), 64u);
  EXPECT_LT(levels.errors_m.back(), 1e-5f * extent_of(surface));
  std::mt19937 engine(5);
  EXPECT_LT(distance_between(surface, coarsest, 7, engine), 1e-5 * extent_of(surface));
}

/// Every triangle with vertices of its own.
Surface torn(const Surface& surface) {
  Surface made;
  for (const uint32_t index : surface.indices) {
    made.indices.push_back(static_cast<uint32_t>(made.positions.size()));
    made.positions.push_back(surface.positions[index]);
  }
  return made;
}

TEST(DetailLevels, DoNotOpenSeams) {
  for (const Surface& whole : {sphere(24), torus(20), flat(20)}) {
    const Surface split = torn(whole);
    const DetailLevels levels = levels_of(split), expected = levels_of(whole);
    expect_sound(split, levels);
    ASSERT_EQ(levels.errors_m.size(), expected.errors_m.size());
    for (size_t level = 1; level < levels.errors_m.size(); ++level) {
      const auto triangles = static_cast<double>(level_of(whole, expected, level).triangles());
      EXPECT_NEAR(static_cast<double>(level_of(split, levels, level).triangles()), triangles, 0.1 * triangles);
    }
  }
  // Closed surfaces stay closed: each edge has two triangles, once in either direction.
  for (const Surface& whole : {sphere(16), torus(14)}) {
    const Surface split = torn(whole);
    const DetailLevels levels = levels_of(split);
    ASSERT_GE(levels.errors_m.size(), 2u);
    for (size_t level = 1; level < levels.errors_m.size(); ++level) {
      const std::vector<uint32_t> indices = level_of(split, levels, level).indices;
      std::vector<std::pair<uint32_t, uint32_t>> edges, back;
      for (size_t i = 0; i < indices.size(); ++i) {
        const uint32_t next = indices[i % 3 == 2 ? i - 2 : i + 1];
        edges.push_back({indices[i], next}), back.push_back({next, indices[i]});
      }
      std::sort(edges.begin(), edges.end()), std::sort(back.begin(), back.end());
      EXPECT_EQ(edges, back) << "level " << level;
    }
  }
}

TEST(DetailLevels, OfSmallMeshesAreOne) {
  Surface surface = hills(8);
  for (const size_t triangles : {0u, 1u, 63u, 64u}) {
    Surface part = surface;
    part.indices.resize(3 * triangles);
    const DetailLevels levels = levels_of(part);
    expect_sound(part, levels);
    EXPECT_EQ(levels.errors_m.size(), 1u) << triangles;
  }
  EXPECT_GT(levels_of(surface).errors_m.size(), 1u);
  const DetailLevels one = one_detail_level(surface.indices);
  EXPECT_EQ(one.errors_m.size(), 1u);
  expect_sound(surface, one);
}

TEST(DetailLevels, OfNothingButDegenerateTrianglesAreSound) {
  Surface point = flat(20), line = flat(20);
  for (glm::vec3& p : point.positions) p = {1, 2, 3};
  for (glm::vec3& p : line.positions) p = {p.x, 0, 0};
  for (const Surface& surface : {point, line}) expect_sound(surface, levels_of(surface));
}

TEST(DetailLevels, AreTheSameEveryTime) {
  std::mt19937 engine(6);
  for (const Surface& surface : {torus(20), hills(30), random_triangles(400, engine)}) {
    const DetailLevels a = levels_of(surface), b = levels_of(Surface(surface));
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_EQ(a.first_index, b.first_index);
    EXPECT_EQ(a.errors_m, b.errors_m);
  }
}

}  // namespace
}  // namespace app
