// Cube projection (P1, E6, E7) against brute force: exact clipping in double precision, and dense samples of the boxes.
#include "umbrage/cube_projection.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <string>

#include "tests/unit/box_clipper.hpp"
#include "tests/unit/cube_boxes.hpp"
#include "views/cube_projection.shared.h"

namespace umbrage::test {
namespace {

using shared::CubeFaceCount;

constexpr double slack = shared::CubeProjectionSlack;
/// Window change that separates "touches for certain" from "may touch" in the double-precision clipping.
constexpr double clip_tolerance = 1e-9;

std::string describe(const Aabb& b) {
  std::ostringstream out;
  out.precision(9);
  out << '[' << b.min.x << ' ' << b.min.y << ' ' << b.min.z << "] – [" << b.max.x << ' ' << b.max.y << ' ' << b.max.z
      << ']';
  return out.str();
}

double largest(const Aabb& b) {
  return std::max({std::abs(b.min.x), std::abs(b.min.y), std::abs(b.min.z), std::abs(b.max.x), std::abs(b.max.y),
                   std::abs(b.max.z)});
}

std::optional<Seen> surely_seen(uint32_t face, const Aabb& box, const Window& window = {}) {
  return see(face, box, window.grown(-clip_tolerance), 1e-9 * largest(box));
}

std::optional<Seen> maybe_seen(uint32_t face, const Aabb& box, const Window& window = {}) {
  return see(face, box, window.grown(clip_tolerance));
}

bool within(const Window& inner, const Window& outer, double tolerance) {
  return inner.s_min >= outer.s_min - tolerance && inner.t_min >= outer.t_min - tolerance &&
         inner.s_max <= outer.s_max + tolerance && inner.t_max <= outer.t_max + tolerance;
}

uint32_t count_bits(std::span<const uint64_t> rows) {
  return std::accumulate(rows.begin(), rows.end(), 0u,
                         [](uint32_t sum, uint64_t row) { return sum + static_cast<uint32_t>(std::popcount(row)); });
}

uint32_t tile_count(const CubeTileRect& r) { return (r.x_end - r.x_begin) * (r.y_end - r.y_begin); }

/// Points of a box: a lattice with its corners, and on each of its lines along an axis the points where faces meet.
std::vector<Vec3> samples_of(const Aabb& box, uint32_t steps) {
  const std::array<float, 3> lo{box.min.x, box.min.y, box.min.z}, hi{box.max.x, box.max.y, box.max.z};
  const auto at = [&](size_t axis, uint32_t i) {
    const float u = static_cast<float>(i) / static_cast<float>(steps);
    return i == steps ? hi[axis] : std::clamp(lo[axis] * (1 - u) + hi[axis] * u, lo[axis], hi[axis]);
  };
  std::vector<Vec3> samples;
  for (uint32_t i = 0; i <= steps; ++i)
    for (uint32_t j = 0; j <= steps; ++j)
      for (uint32_t k = 0; k <= steps; ++k) {
        const std::array<float, 3> p{at(0, i), at(1, j), at(2, k)};
        samples.push_back({p[0], p[1], p[2]});
        for (size_t axis = 0; axis < 3; ++axis)
          for (const float crossing :
               {p[(axis + 1) % 3], -p[(axis + 1) % 3], p[(axis + 2) % 3], -p[(axis + 2) % 3], 0.0f}) {
            if (crossing < lo[axis] || crossing > hi[axis]) continue;
            std::array<float, 3> q = p;
            q[axis] = crossing;
            samples.push_back({q[0], q[1], q[2]});
          }
      }
  return samples;
}

TEST(CubeProjection, FaceMaskIsThatOfClipping) {
  for (const Aabb& box : all_boxes(4000)) {
    const uint32_t mask = cube_face_mask(box);
    for (uint32_t face = 0; face < CubeFaceCount; ++face) {
      const bool hit = (mask >> face & 1) != 0;
      ASSERT_EQ(hit, project_to_cube_face(box, CubeFace(face)).has_value()) << describe(box) << " face " << face;
      ASSERT_TRUE(!hit || maybe_seen(face, box)) << "false face " << face << " of " << describe(box);
      ASSERT_TRUE(hit || !surely_seen(face, box)) << "missing face " << face << " of " << describe(box);
    }
  }
}

TEST(CubeProjection, RectangleAndDepthsAreThoseOfClipping) {
  double farthest = 0;
  for (const Aabb& box : all_boxes(4000))
    for (uint32_t face = 0; face < CubeFaceCount; ++face) {
      const std::optional<CubeFaceProjection> found = project_to_cube_face(box, CubeFace(face));
      if (!found) continue;
      const Window rect{found->min.x, found->min.y, found->max.x, found->max.y};
      ASSERT_TRUE(within(rect, {}, 0)) << describe(box) << " face " << face;
      const std::optional<Seen> most = maybe_seen(face, box), least = surely_seen(face, box);
      ASSERT_TRUE(most && within(rect, most->bounds, slack + 1e-6)) << describe(box) << " face " << face;
      if (!least) continue;
      ASSERT_TRUE(within(least->bounds, rect, 1e-8)) << describe(box) << " face " << face;
      farthest = std::max({farthest, least->bounds.s_min - rect.s_min, rect.s_max - least->bounds.s_max,
                           least->bounds.t_min - rect.t_min, rect.t_max - least->bounds.t_max});
      const double depth_tolerance = 1e-8 * largest(box);
      ASSERT_NEAR(found->depth_max, least->depth_max, depth_tolerance) << describe(box) << " face " << face;
      ASSERT_LE(found->depth_min, least->depth_min + depth_tolerance) << describe(box) << " face " << face;
      ASSERT_GE(found->depth_min, most->depth_min - depth_tolerance) << describe(box) << " face " << face;
    }
  std::cout << "rectangles exceed the exact ones by at most " << farthest << " in s or t (slack " << slack << ")\n";
}

TEST(CubeProjection, TilesHoldEverySample) {
  for (const Aabb& box : all_boxes(300)) {
    const std::vector<Vec3> samples = samples_of(box, 4);
    for (const uint32_t tiles : {1u, 3u, 8u, 32u, 64u}) {
      std::array<std::array<uint64_t, 64>, CubeFaceCount> masks{};
      std::array<CubeTileRect, CubeFaceCount> rects{};
      for (uint32_t face = 0; face < CubeFaceCount; ++face) {
        cube_tile_mask(box, CubeFace(face), std::span(masks[face]).first(tiles));
        if (const auto found = project_to_cube_face(box, CubeFace(face))) rects[face] = cube_tile_rect(*found, tiles);
        ASSERT_LE(count_bits(masks[face]), tile_count(rects[face])) << describe(box);
      }
      for (const Vec3& p : samples) {
        if (p.x == 0 && p.y == 0 && p.z == 0) continue;  // The light itself has no direction.
        const uint32_t face = shared::face_of_direction({p.x, p.y, p.z});
        const Point c = face_point(face, {p.x, p.y, p.z});
        const uint32_t x = shared::texel_of(static_cast<float>(c.x) / static_cast<float>(c.z), tiles);
        const uint32_t y = shared::texel_of(static_cast<float>(c.y) / static_cast<float>(c.z), tiles);
        const CubeTileRect& r = rects[face];
        ASSERT_TRUE(x >= r.x_begin && x < r.x_end && y >= r.y_begin && y < r.y_end)
            << describe(box) << " face " << face << " tile " << x << ' ' << y << " of " << tiles;
        ASSERT_TRUE(masks[face][y] >> x & 1)
            << describe(box) << " face " << face << " tile " << x << ' ' << y << " of " << tiles;
      }
    }
  }
}

TEST(CubeProjection, TileMaskIsThatOfClippingEachTile) {
  std::vector<Aabb> boxes = awkward_boxes();
  for (const std::vector<Aabb>& more : {lattice_boxes(), random_boxes(400, 0.01f, 2.0f, 3)})
    for (size_t i = 0; i<more.size(); i += more.size()> 1000 ? 7 : 1) boxes.push_back(more[i]);
  for (const Aabb& box : boxes)
    for (uint32_t face = 0; face < CubeFaceCount; ++face)
      for (const uint32_t tiles : {3u, 8u}) {
        std::array<uint64_t, 64> mask{};
        cube_tile_mask(box, CubeFace(face), std::span(mask).first(tiles));
        for (uint32_t y = 0; y < tiles; ++y)
          for (uint32_t x = 0; x < tiles; ++x) {
            const double side = 2.0 / tiles;
            const Window tile{x * side - 1, y * side - 1, (x + 1) * side - 1, (y + 1) * side - 1};
            const bool set = (mask[y] >> x & 1) != 0;
            ASSERT_TRUE(!set || see(face, box, tile.grown(3 * slack)))
                << "false tile " << x << ' ' << y << " of " << tiles << ", face " << face << ", " << describe(box);
            ASSERT_TRUE(set || !surely_seen(face, box, tile))
                << "missing tile " << x << ' ' << y << " of " << tiles << ", face " << face << ", " << describe(box);
          }
      }
}

TEST(CubeProjection, BoxesBesideOrBehindAFaceGiveNoTile) {
  const Aabb ahead{{2, -0.5f, -0.5f}, {3, 0.5f, 0.5f}}, beside{{1, 4, -1}, {2, 5, 1}}, behind{{-3, -1, -1}, {-2, 1, 1}};
  EXPECT_EQ(cube_face_mask(ahead), 1u);
  EXPECT_EQ(cube_face_mask(beside), 4u);
  EXPECT_EQ(cube_face_mask(behind), 2u);
  EXPECT_EQ(cube_face_mask({{-1, -1, -1}, {1, 1, 1}}), 63u);
}

TEST(CubeProjection, EmptyAndNanBoxesGiveNoTile) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Aabb& box : {Aabb{{1, 1, 1}, {2, 0, 2}}, Aabb{{3, 0, 0}, {2, 1, 1}}, Aabb{{nan, 0, 0}, {1, 1, 1}},
                          Aabb{{0, 0, 0}, {1, nan, 1}}, Aabb{{nan, nan, nan}, {nan, nan, nan}}}) {
    EXPECT_EQ(cube_face_mask(box), 0u);
    for (uint32_t face = 0; face < CubeFaceCount; ++face) {
      EXPECT_FALSE(project_to_cube_face(box, CubeFace(face)));
      std::array<uint64_t, 8> rows;
      rows.fill(~uint64_t{0});
      cube_tile_mask(box, CubeFace(face), rows);
      EXPECT_EQ(count_bits(rows), 0u);
    }
  }
}

TEST(CubeProjection, GrownReceiversHoldTheirFilterTaps) {
  const uint32_t resolution = 64, tiles = 64;
  const float filter_texels = 2;
  for (const Aabb& box : random_boxes(500, 0.01f, 1.0f, 4)) {
    const Aabb grown = grow_receiver_box(box, resolution, filter_texels, 0.0f);
    std::array<std::array<uint64_t, tiles>, CubeFaceCount> masks{};
    for (uint32_t face = 0; face < CubeFaceCount; ++face) cube_tile_mask(grown, CubeFace(face), masks[face]);
    for (const Vec3& p : samples_of(box, 2)) {
      if (p.x == 0 && p.y == 0 && p.z == 0) continue;
      const uint32_t face = shared::face_of_direction({p.x, p.y, p.z});
      const shared::vec3 c = shared::face_coordinates(face, {p.x, p.y, p.z});
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const float step = 2.0f / static_cast<float>(resolution);
          const shared::CubeTap tap = shared::cube_tap(face, c.x / c.z + step * static_cast<float>(dx),
                                                       c.y / c.z + step * static_cast<float>(dy));
          const uint32_t x = shared::texel_of(tap.s, tiles), y = shared::texel_of(tap.t, tiles);
          ASSERT_TRUE(masks[tap.face][y] >> x & 1)
              << describe(box) << " face " << tap.face << " tile " << x << ' ' << y;
        }
    }
  }
}

TEST(CubeProjection, GrowingAddsMarginAndBias) {
  const Aabb grown = grow_receiver_box({{-1, 2, 3}, {1, 3, 4}}, 8, 1.0f, 0.5f);
  const float margin = 4.5f * 2 / 8 + 0.5f;
  EXPECT_FLOAT_EQ(grown.min.x, -1 - margin);
  EXPECT_FLOAT_EQ(grown.max.z, 4 + margin);
}

/// Listing 1 of the poster, carried over to any face, before and after its clamp. It rejects nothing.
struct PosterRect {
  Window unclamped, clamped;
};
PosterRect poster_rect(uint32_t face, const Aabb& box) {
  const Point a = face_point(face, {box.min.x, box.min.y, box.min.z}),
              b = face_point(face, {box.max.x, box.max.y, box.max.z});
  const double rd_min = 1 / std::max(1e-6, std::min(a.z, b.z)), rd_max = 1 / std::max(1e-6, std::max(a.z, b.z));
  const auto [s_lo, s_hi] = std::minmax(a.x, b.x);
  const auto [t_lo, t_hi] = std::minmax(a.y, b.y);
  const Window w{std::min(s_lo * rd_min, s_lo * rd_max), std::min(t_lo * rd_min, t_lo * rd_max),
                 std::max(s_hi * rd_min, s_hi * rd_max), std::max(t_hi * rd_min, t_hi * rd_max)};
  const auto clamp = [](double v) { return std::clamp(v, -1.0, 1.0); };
  return {w, {clamp(w.s_min), clamp(w.t_min), clamp(w.s_max), clamp(w.t_max)}};
}

/// Faces and tiles marked on a 32 × 32 projection map, in all and by each method.
struct Coverage {
  uint64_t boxes = 0, faces = 0, silhouette = 0, rectangle = 0, poster_faces = 0, poster = 0, mended_faces = 0,
           mended = 0;
};

void add_coverage(Coverage& sum, const Aabb& box, uint32_t face) {
  constexpr uint32_t tiles = 32;
  const auto count = [](const Window& w) {
    const auto tile = [](double v) { return std::min(uint32_t((v * 0.5 + 0.5) * tiles), tiles - 1); };
    return (tile(w.s_max) - tile(w.s_min) + 1) * (tile(w.t_max) - tile(w.t_min) + 1);
  };
  const PosterRect poster = poster_rect(face, box);
  const Window& u = poster.unclamped;
  ++sum.poster_faces;
  sum.poster += count(poster.clamped);
  if (std::max(face_point(face, {box.min.x, box.min.y, box.min.z}).z,
               face_point(face, {box.max.x, box.max.y, box.max.z}).z) > 0 &&
      u.s_min <= 1 && u.s_max >= -1 && u.t_min <= 1 && u.t_max >= -1) {
    ++sum.mended_faces;
    sum.mended += count(poster.clamped);
  }
  const auto found = project_to_cube_face(box, CubeFace(face));
  if (!found) return;
  ++sum.faces;
  sum.rectangle += tile_count(cube_tile_rect(*found, tiles));
  std::array<uint64_t, tiles> rows;
  cube_tile_mask(box, CubeFace(face), rows);
  sum.silhouette += count_bits(rows);
}

TEST(CubeProjection, CoversLessThanThePosterAndNoMoreThanTheRectangle) {
  std::cout
      << "half size / distance, per box: faces | tiles of the silhouette, of the rectangle | poster with unclamped "
         "rejection: faces, tiles | poster as printed: faces, tiles\n";
  const std::array<std::array<float, 2>, 4> ranges{{{0.003f, 0.03f}, {0.03f, 0.1f}, {0.1f, 0.3f}, {0.3f, 1.0f}}};
  for (const auto& [smallest, largest_size] : ranges) {
    Coverage sum;
    for (const Aabb& box : random_boxes(4000, smallest, largest_size, 5)) {
      ++sum.boxes;
      for (uint32_t face = 0; face < CubeFaceCount; ++face) add_coverage(sum, box, face);
    }
    EXPECT_LE(sum.silhouette, sum.rectangle);
    EXPECT_LE(sum.rectangle, sum.mended);
    EXPECT_LE(sum.faces, sum.mended_faces);
    EXPECT_LT(sum.mended, sum.poster);
    const auto mean = [&](uint64_t total) { return static_cast<double>(total) / static_cast<double>(sum.boxes); };
    std::cout << smallest << "–" << largest_size << ": " << mean(sum.faces) << " | " << mean(sum.silhouette) << ", "
              << mean(sum.rectangle) << " | " << mean(sum.mended_faces) << ", " << mean(sum.mended) << " | "
              << mean(sum.poster_faces) << ", " << mean(sum.poster) << '\n';
  }
}

}  // namespace
}  // namespace umbrage::test
