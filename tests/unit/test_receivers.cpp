// faces_to_draw, the code that the culling shaders run for every batch, on the CPU: against the reference on many boxes, and
// against receivers that a box does shadow.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "culling/receivers.shared.h"
#include "reference/map_casters.hpp"

namespace umbrage::shared {
namespace {

constexpr uint kModes = 5;

reference::CasterView plain_view(uint face, const vec3& origin) {
  static constexpr double kRows[6][3][3] = {{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
                                            {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                            {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
  const auto row = [&](int i) {
    const glm::dvec3 r(kRows[face][i][0], kRows[face][i][1], kRows[face][i][2]);
    return glm::dvec4(r, -glm::dot(r, glm::dvec3(origin)));
  };
  return {.x = row(0), .y = row(1), .depth = row(2)};
}

/// The cube of a light with random receivers on some faces, as the shaders and as the reference know it.
struct Cube {
  MapRecord map{};
  ShadowView first{};
  uint grid;
  std::vector<uint> tiles = std::vector<uint>(6 * ProjectionSide), depths;
  reference::CasterMap plain;
  std::vector<vec3> points;  ///< Receivers.

  Cube(uint cells, std::mt19937& engine) : grid(cells), depths(6 * cells * cells) {
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit(0, 1);
    first = perspective_view(vec3(3 * normal(engine), normal(engine), 3 * normal(engine)), 0.02f, face_rotation(0), 1);
    map.view_count = 6;
    map.kind = ViewsCube;
    for (uint v = 0; v < 6; ++v) {
      plain.views.push_back(plain_view(v, first.origin));
      plain.receivers.push_back({.tiles = {}, .grid = grid, .farthest = std::vector<float>(grid * grid)});
    }
    for (auto clump = engine() % 6; clump-- > 0;) {
      const vec3 centre = normalize(vec3(normal(engine), normal(engine), normal(engine))) * (0.2f + 6 * unit(engine));
      for (int i = 0; i < 20; ++i) see(centre + 0.3f * vec3(normal(engine), normal(engine), normal(engine)));
    }
  }

  void see(const vec3& relative) {
    const uint face = face_of_direction(relative);
    const vec3 at = face_coordinates(face, relative);
    if (!(at.z > 0)) return;
    const uint x = texel_of(at.x / at.z, ProjectionSide), y = texel_of(at.y / at.z, ProjectionSide);
    const uint cell = y * grid / ProjectionSide * grid + x * grid / ProjectionSide;
    reference::CasterReceivers& known = plain.receivers[face];
    known.tiles[y] |= 1u << x;
    known.farthest[cell] = std::max(known.farthest[cell], at.z);
    tiles[face * ProjectionSide + y] = known.tiles[y];
    depths[face * grid * grid + cell] = floatBitsToUint(known.farthest[cell]);
    map.faces |= 1u << face;
    points.push_back(first.origin + relative);
  }

  uint faces(const Box& box, uint mode) const {
    const MapReceivers receivers = receivers_of(map, reinterpret_cast<uint64_t>(tiles.data()),
                                                reinterpret_cast<uint64_t>(depths.data()), grid, mode);
    return faces_to_draw(map, first, receivers, with_slack(box, first.origin, BoxSlack), mode);
  }
};

constexpr int kKinds = 8;
/// Sizes from points to far larger than the cube's surroundings. Kinds up to 5 are degenerate, huge, or touch the light or the
/// planes between faces.
Box random_box(const vec3& origin, int kind, std::mt19937& engine) {
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit(0, 1);
  vec3 centre = 3.0f * vec3(normal(engine), normal(engine), normal(engine));
  vec3 half = std::exp2(8 * unit(engine) - 6) * vec3(unit(engine), unit(engine), unit(engine));
  if (kind == 0) half = vec3(0);
  if (kind == 1) half[int(engine() % 3)] = 0;
  if (kind == 2) centre = half * (engine() % 2 ? 1.0f : -1.0f);  // a corner at the light
  if (kind == 3)
    centre = vec3(centre.x, centre.x, engine() % 2 ? centre.x : centre.z);  // on an edge or a corner of the cube
  if (kind == 4) centre = 0.5f * half * vec3(normal(engine), normal(engine), normal(engine));
  if (kind == 5) half *= 100.0f;
  return {origin + centre - half, origin + centre + half};
}

TEST(Receivers, FacesAreThoseOfTheReference) {
  std::mt19937 engine(4);
  size_t drawn = 0, open = 0, boxes = 0;
  for (int i = 0; i < 120; ++i) {
    Cube cube(1u << engine() % 6, engine);
    cube.map.receivers = i % 10 == 9 ? ReceiversAnywhere : i % 10 == 8 ? ReceiversInBoxes : ReceiversInSight;
    cube.plain.whole = cube.map.receivers == ReceiversAnywhere;
    for (int k = 0; k < 100; ++k) {
      const Box box = random_box(cube.first.origin, k % kKinds, engine);
      const reference::Box plain{.min = box.lo, .max = box.hi};
      uint before = 63;
      for (uint mode = 0; mode < kModes; ++mode) {
        const uint faces = cube.faces(box, mode);
        const auto test = static_cast<reference::CasterTest>(mode);
        const uint must = reference::views_to_draw(cube.plain, plain, test),
                   may = reference::views_to_draw(cube.plain, plain, test, 3e-5);
        ASSERT_EQ(must & ~faces, 0u) << "cube " << i << ", box " << k << ", mode " << mode << " lacks faces";
        ASSERT_EQ(faces & ~may, 0u) << "cube " << i << ", box " << k << ", mode " << mode << " has faces too many";
        ASSERT_EQ(faces & ~before, 0u) << "each mode drops what the one before does";
        before = faces;
        if (k % kKinds < 6) continue;
        drawn += static_cast<size_t>(bitCount(faces)), open += static_cast<size_t>(bitCount(may & ~must)), ++boxes;
      }
    }
  }
  EXPECT_GT(drawn, boxes / 3);
  EXPECT_LT(open, drawn / 50) << "the reference decides";
}

TEST(Receivers, OfAShadowAreNeverDropped) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> unit(0, 1);
  size_t tested = 0;
  for (int i = 0; i < 400; ++i) {
    const Cube cube(1u << engine() % 6, engine);
    for (const vec3& receiver : cube.points) {
      const vec3 at = mix(cube.first.origin, receiver, unit(engine));
      const vec3 half = 0.3f * unit(engine) * vec3(unit(engine), unit(engine), unit(engine));
      const vec3 centre = at + half * (2.0f * vec3(unit(engine), unit(engine), unit(engine)) - 1.0f);
      const Box box{min(centre - half, at), max(centre + half, at)};
      const uint face = face_of_direction(receiver - cube.first.origin);
      for (uint mode = 0; mode < kModes; ++mode)
        ASSERT_TRUE(cube.faces(box, mode) >> face & 1) << "cube " << i << ", mode " << mode;
      ++tested;
    }
  }
  EXPECT_GT(tested, 5000u);
}

TEST(Receivers, OfEmptyBoxesAreNone) {
  std::mt19937 engine(6);
  Cube cube(8, engine);
  cube.see(vec3(1, 2, 3));
  const Box empty{vec3(1e30f), vec3(-1e30f)};
  for (uint mode = 1; mode < kModes; ++mode) EXPECT_EQ(cube.faces(empty, mode), 0u) << "mode " << mode;
}

}  // namespace
TEST(MarkTexels, PaysWhereFewAreLookedUp) {
  // 10 tiles of 32×32 pixels and 20 lights at each: 204,800 lookups.
  shared::FrameCounters counters{};
  counters.clusters_found = 15;
  counters.pairs_found = 300;
  counters.pool_units = 2 * 204800 / shared::PoolUnit;
  EXPECT_TRUE(shared::marks_texels(counters, 10));
  counters.pool_units -= 1;
  EXPECT_FALSE(shared::marks_texels(counters, 10));
  EXPECT_TRUE(shared::marks_texels(counters, 9));
  EXPECT_TRUE(shared::marks_texels(shared::FrameCounters{}, 10)) << "nothing in sight";
}

}  // namespace umbrage::shared
