// The stage references' own sanity: what they promise, on random and on edge input.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "reference/caster_lists.hpp"
#include "reference/clusters.hpp"
#include "reference/hierarchy.hpp"
#include "reference/light_lists.hpp"

namespace {

using reference::Box;
using reference::Light;

class Random {
 public:
  float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  glm::vec3 point(float half) { return {number(-half, half), number(-half, half), number(-half, half)}; }
  glm::vec3 direction() {
    glm::vec3 v = point(1);
    while (glm::length(v) < 0.1f || glm::length(v) > 1) v = point(1);
    return glm::normalize(v);
  }
  Box box(float half, float size) {
    Box box;
    const glm::vec3 corner = point(half);
    box.grow(corner);
    box.grow(corner + glm::vec3(number(0, size), number(0, size), number(0, size)));
    return box;
  }
  glm::vec3 inside(const Box& box) {
    return {number(box.min.x, box.max.x), number(box.min.y, box.max.y), number(box.min.z, box.max.z)};
  }
  Light light() {
    Light light;
    light.kind = app::LightKind(std::uniform_int_distribution<int>(0, 2)(engine_));
    light.position = point(10);
    light.direction = direction();
    light.range = number(0.5f, 8);
    light.near = reference::default_near(light.range);
    light.outer_cone = number(0.1f, 1.5f);
    return light;
  }

 private:
  std::mt19937 engine_{7};
};

/// 100 × 70 pixels, near 0.5, seen from (1, 2, 3).
reference::ClusterGrid make_grid() {
  reference::ClusterGrid grid;
  grid.width = 100, grid.height = 70, grid.slices = 64;
  grid.near = 0.5f, grid.ratio = 1.3f;
  grid.view_from_world = glm::lookAt(glm::vec3(1, 2, 3), glm::vec3(-4, 1, -2), glm::vec3(0, 1, 0));
  grid.clip_from_view = glm::perspectiveRH_ZO(1.0f, 10.0f / 7, 0.5f, 500.0f);
  return grid;
}

/// Random samples in front of the camera, every 13th pixel empty.
std::vector<float> random_positions(const reference::ClusterGrid& grid, Random& random) {
  const glm::mat4 world_from_clip = glm::inverse(grid.clip_from_view * grid.view_from_world);
  std::vector<float> positions;
  for (uint32_t pixel = 0; pixel < grid.width * grid.height; ++pixel) {
    const glm::vec2 center(float(pixel % grid.width) + 0.5f, float(pixel / grid.width) + 0.5f);
    const glm::vec4 p = world_from_clip * glm::vec4(2.0f * center / glm::vec2(grid.width, grid.height) - 1.0f,
                                                    random.number(0.05f, 0.99f), 1);
    for (int axis = 0; axis < 3; ++axis) positions.push_back(pixel % 13 == 0 ? NAN : p[axis] / p.w);
  }
  return positions;
}

TEST(ReferenceClusters, HoldEachSampleOnceInsideBothBoxes) {
  Random random;
  const reference::ClusterGrid grid = make_grid();
  const std::vector<float> positions = random_positions(grid, random);
  constexpr float epsilon = 1e-3f;
  std::vector<int> seen(grid.width * grid.height);
  const auto clusters = reference::assign_clusters(grid, positions, epsilon);
  for (const reference::Cluster& cluster : clusters) {
    EXPECT_FALSE(cluster.samples.empty());
    const glm::vec3 slack = 1e-4f * (cluster.implicit_box.max - cluster.implicit_box.min);
    Box grown = cluster.implicit_box;
    grown.grow(grown.min - 20.0f * slack);
    grown.grow(grown.max + 20.0f * slack);
    EXPECT_TRUE(grown.holds(cluster.explicit_box));
    for (const uint32_t pixel : cluster.samples) {
      ++seen[pixel];
      const glm::vec3 p(positions[3 * pixel], positions[3 * pixel + 1], positions[3 * pixel + 2]);
      EXPECT_TRUE(cluster.explicit_box.holds(p));
      EXPECT_TRUE(grown.holds(p));
      EXPECT_EQ(cluster.cell.tile_x, pixel % grid.width / 32);
      EXPECT_EQ(cluster.cell.tile_y, pixel / grid.width / 32);
    }
  }
  for (size_t pixel = 0; pixel < seen.size(); ++pixel) EXPECT_EQ(seen[pixel], pixel % 13 == 0 ? 0 : 1);
  EXPECT_GT(clusters.size(), 50u);
}

TEST(ReferenceClusters, SlicesAreExponential) {
  const reference::ClusterGrid grid = make_grid();
  EXPECT_EQ(reference::slice_of(grid, 0.1f), 0u);
  EXPECT_EQ(reference::slice_of(grid, 0.5f), 0u);
  for (uint32_t k = 1; k < 20; ++k) {
    const float start = 0.5f * std::pow(1.3f, float(k));
    EXPECT_EQ(reference::slice_of(grid, start * 0.9999f), k - 1);
    EXPECT_EQ(reference::slice_of(grid, start * 1.0001f), k);
  }
  EXPECT_EQ(reference::slice_of(grid, 1e30f), 63u);
  EXPECT_EQ(reference::slice_of(grid, INFINITY), 63u);
}

TEST(ReferenceClusters, CornersLieOnTheTilesEdgesAtTheSlicesDepths) {
  const reference::ClusterGrid grid = make_grid();
  const auto corners = reference::cell_corners(grid, {2, 1, 5});
  for (uint32_t i = 0; i < 8; ++i) {
    const glm::vec4 clip = grid.clip_from_view * grid.view_from_world * glm::vec4(corners[i], 1);
    const glm::vec2 pixel = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(100, 70);
    EXPECT_NEAR(pixel.x, i & 1 ? 96 : 64, 1e-2f);
    EXPECT_NEAR(pixel.y, i & 2 ? 64 : 32, 1e-2f);
    EXPECT_NEAR(reference::view_depth(grid, corners[i]), 0.5f * std::pow(1.3f, i & 4 ? 6.0f : 5.0f), 1e-3f);
  }
}

// Reversed and infinite depth, left-handed views: the same cells of the world.
TEST(ReferenceClusters, DepthConventionsDoNotMatter) {
  const reference::ClusterGrid grid = make_grid();
  const Box expected = reference::implicit_box(grid, {1, 1, 7});
  const auto expect_same = [&](const reference::ClusterGrid& other, const char* name) {
    const Box box = reference::implicit_box(other, {1, 1, 7});
    EXPECT_LT(glm::distance(box.min, expected.min) + glm::distance(box.max, expected.max), 1e-3f) << name;
    EXPECT_NEAR(reference::view_depth(other, {-4, 1, -2}), std::sqrt(51.0f), 1e-4f) << name;
  };
  reference::ClusterGrid reversed = grid;
  const float f = 1 / std::tan(0.5f);
  reversed.clip_from_view = glm::mat4(f * 0.7f, 0, 0, 0, 0, f, 0, 0, 0, 0, 0, -1, 0, 0, 0.5f, 0);
  expect_same(reversed, "reversed infinite");
  reference::ClusterGrid left_handed = grid;
  const glm::mat4 mirror = glm::scale(glm::mat4(1), glm::vec3(1, 1, -1));
  left_handed.view_from_world = mirror * grid.view_from_world;
  left_handed.clip_from_view = grid.clip_from_view * mirror;
  expect_same(left_handed, "left-handed");
}

TEST(ReferenceClusters, OrthographicCellsAreBoxesOfTheSameSize) {
  reference::ClusterGrid grid = make_grid();
  grid.view_from_world = glm::mat4(1);
  grid.clip_from_view = glm::orthoRH_ZO(-5.0f, 5.0f, -3.5f, 3.5f, 0.5f, 100.0f);
  const Box box = reference::implicit_box(grid, {1, 0, 2});
  EXPECT_NEAR(box.min.x, -1.8f, 1e-4f);
  EXPECT_NEAR(box.max.x, 1.4f, 1e-4f);
  EXPECT_NEAR(box.max.z, -0.5f * 1.3f * 1.3f, 1e-4f);
  EXPECT_NEAR(box.min.z, -0.5f * 1.3f * 1.3f * 1.3f, 1e-4f);
}

TEST(ReferenceClusters, BitsAreTenthsOfTheBox) {
  Box box;
  box.grow(glm::vec3(10, 20, 30));
  box.grow(glm::vec3(20, 40, 30));  // flat in z
  EXPECT_EQ(reference::explicit_bits(box, {10, 20, 30}), 1u | 1u << 10 | 1u << 20);
  EXPECT_EQ(reference::explicit_bits(box, {20, 40, 30}), 1u << 9 | 1u << 19 | 1u << 20);
  EXPECT_EQ(reference::explicit_bits(box, {12.5f, 35, 31}), 1u << 2 | 1u << 17 | 1u << 20);
  EXPECT_EQ(reference::explicit_bits(box, {-99, 999, 30}), 1u | 1u << 19 | 1u << 20) << "outside is clamped";
  const Box decoded = reference::decode_bits(box, 1u << 2 | 1u << 4 | 1u << 17 | 1u << 20, 0);
  EXPECT_NEAR(glm::distance(decoded.min, glm::vec3(12, 34, 30)), 0, 1e-5f);
  EXPECT_NEAR(glm::distance(decoded.max, glm::vec3(15, 36, 30)), 0, 1e-5f);
}

TEST(ReferenceLightLists, HoldEveryLightThatReachesASample) {
  Random random;
  std::vector<Light> lights(60);
  for (Light& light : lights) light = random.light();
  size_t reached = 0, listed = 0, spots_left_out = 0;
  for (int i = 0; i < 200; ++i) {
    const Box box = random.box(10, 3);
    std::vector<glm::vec3> samples(50);
    for (glm::vec3& sample : samples) sample = random.inside(box);
    const std::vector<uint32_t> list = reference::assign_lights(std::span(&box, 1), lights).front();
    EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
    const std::vector<uint32_t> needed = reference::lights_reaching(samples, lights);
    EXPECT_TRUE(std::includes(list.begin(), list.end(), needed.begin(), needed.end()));
    reached += needed.size();
    listed += list.size();
    for (const Light& light : lights) {
      spots_left_out += reference::range_meets(light, box) && !reference::cone_may_meet(light, box);
    }
  }
  EXPECT_GT(reached, 0u);
  EXPECT_LT(listed, 200 * lights.size());
  EXPECT_GT(spots_left_out, 100u);
}

TEST(ReferenceLightLists, RangeIsTestedAgainstTheNearestPoint) {
  Box box;
  box.grow(glm::vec3(1, 1, 1));
  box.grow(glm::vec3(2, 2, 2));
  Light light;
  light.range = std::sqrt(3.0f) + 1e-4f;
  EXPECT_TRUE(reference::range_meets(light, box));
  light.range = std::sqrt(3.0f) - 1e-4f;
  EXPECT_FALSE(reference::range_meets(light, box));
  light.position = glm::vec3(1.5f);
  EXPECT_TRUE(reference::range_meets(light, box)) << "inside";
  light.kind = app::LightKind::directional;
  light.position = glm::vec3(1000);
  EXPECT_TRUE(reference::range_meets(light, box));
}

TEST(ReferenceHierarchy, MortonCodesInterleave) {
  Box box;
  box.grow(glm::vec3(0));
  box.grow(glm::vec3(1024));
  EXPECT_EQ(reference::morton_code(box, glm::vec3(0)), 0u);
  EXPECT_EQ(reference::morton_code(box, glm::vec3(1024)), (1u << 30) - 1);
  EXPECT_EQ(reference::morton_code(box, {1, 0, 0}), 1u);
  EXPECT_EQ(reference::morton_code(box, {0, 1, 0}), 2u);
  EXPECT_EQ(reference::morton_code(box, {0, 0, 1}), 4u);
  EXPECT_EQ(reference::morton_code(box, {512, 3, 0}), 1u << 27 | 2u | 16u);
}

TEST(ReferenceHierarchy, TiesKeepTheirOrder) {
  const std::vector<Box> boxes(100, Box{glm::vec3(1), glm::vec3(2)});
  const std::vector<uint32_t> order = reference::morton_order(boxes);
  for (uint32_t i = 0; i < 100; ++i) EXPECT_EQ(order[i], i);
}

TEST(ReferenceHierarchy, NodesHoldTheirChildrenAndLevelsShrinkBy32) {
  Random random;
  for (const size_t count : {0u, 1u, 31u, 32u, 33u, 1024u, 1025u, 3000u}) {
    std::vector<Box> boxes(count);
    for (Box& box : boxes) box = random.box(50, 2);
    const reference::Hierarchy tree = reference::build_hierarchy(boxes);
    if (count == 0) {
      EXPECT_TRUE(tree.levels.empty());
      continue;
    }
    EXPECT_EQ(tree.levels.front().size(), count);
    EXPECT_EQ(tree.levels.back().size(), 1u);
    for (size_t level = 1; level < tree.levels.size(); ++level) {
      EXPECT_EQ(tree.levels[level].size(), (tree.levels[level - 1].size() + 31) / 32);
      for (size_t i = 0; i < tree.levels[level - 1].size(); ++i) {
        EXPECT_TRUE(tree.levels[level][i / 32].holds(tree.levels[level - 1][i]));
      }
    }
  }
}

TEST(ReferenceHierarchy, TraversalFindsWhatBruteForceFinds) {
  Random random;
  std::vector<Box> boxes(2000);
  for (Box& box : boxes) box = random.box(50, 2);
  const reference::Hierarchy tree = reference::build_hierarchy(boxes);
  for (int i = 0; i < 50; ++i) {
    const glm::vec3 center = random.point(60);
    const float radius = random.number(0, 40);
    std::vector<uint32_t> expected;
    for (uint32_t b = 0; b < boxes.size(); ++b) {
      if (reference::squared_distance(boxes[b], center) <= radius * radius) expected.push_back(b);
    }
    EXPECT_EQ(reference::leaves_meeting_sphere(tree, center, radius), expected);
  }
}

/// The face whose pyramid a point lies in; ties are in several.
bool on_face(glm::vec3 p, uint32_t face, float near) {
  const float along = face % 2 == 0 ? p[int(face / 2)] : -p[int(face / 2)];
  const glm::vec3 size = glm::abs(p);
  return along >= near && along >= std::max({size.x, size.y, size.z});
}

TEST(ReferenceCasters, FaceMaskIsExact) {
  Random random;
  size_t faces_hit = 0;
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 center = random.point(5);
    const Box box = random.box(8, 6);
    const float near = random.number(0.01f, 2);
    const uint32_t mask = reference::cube_face_mask(center, near, box);
    for (uint32_t face = 0; face < 6; ++face) {
      bool sampled = false;
      for (int s = 0; s < 400; ++s) sampled = sampled || on_face(random.inside(box) - center, face, near);
      EXPECT_TRUE(!sampled || (mask >> face & 1)) << "a sample lies in the face";
      faces_hit += sampled;
      if (!(mask >> face & 1)) continue;
      // The witness: farthest along the axis, nearest to it across.
      glm::vec3 witness = glm::clamp(center, box.min, box.max);
      const int axis = int(face / 2);
      witness[axis] = face % 2 == 0 ? box.max[axis] : box.min[axis];
      EXPECT_TRUE(on_face(witness - center, face, near));
    }
  }
  EXPECT_GT(faces_hit, 300u);
}

TEST(ReferenceCasters, LightInsideTheBoxSeesItOnAllFaces) {
  Box box;
  box.grow(glm::vec3(-1));
  box.grow(glm::vec3(1));
  EXPECT_EQ(reference::cube_face_mask({0.3f, -0.2f, 0.1f}, 0.1f, box), 63u);
  EXPECT_EQ(reference::cube_face_mask({0, 0, 0}, 1.5f, box), 0u) << "all of it nearer than near";
}

TEST(ReferenceCasters, ListHoldsBatchesInRangeWithTheirViews) {
  Light light;
  light.range = 10;
  light.near = 0.1f;
  const Box right{glm::vec3(4, -0.5f, -0.5f), glm::vec3(5, 0.5f, 0.5f)}, far{glm::vec3(20), glm::vec3(21)};
  const Box corner{glm::vec3(3, 3, -0.5f), glm::vec3(4, 4, 0.5f)};
  const std::vector<Box> batches{far, right, corner};
  const auto casters = reference::list_casters(light, {}, batches);
  ASSERT_EQ(casters.size(), 2u);
  EXPECT_EQ(casters[0], (reference::Caster{1, 1u}));
  EXPECT_EQ(casters[1], (reference::Caster{2, 1u | 4u}));

  light.kind = app::LightKind::spot;
  light.direction = {1, 0, 0};
  const std::vector<glm::vec4> planes{{1, -1, 0, 0}, {1, 1, 0, 0}, {1, 0, -1, 0}, {1, 0, 1, 0}};
  EXPECT_EQ(reference::list_casters(light, planes, batches).size(), 2u) << "the corner touches the side";
  const std::vector<glm::vec4> narrow{{0.5f, -1, 0, 0}, {0.5f, 1, 0, 0}};
  EXPECT_EQ(reference::list_casters(light, narrow, batches), (std::vector<reference::Caster>{{1, 1u}}));
}

}  // namespace
