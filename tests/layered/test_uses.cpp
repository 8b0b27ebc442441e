// Matrices of the uses (R6), each against what it is for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "layered/layered_uses.hpp"

namespace app {
namespace {

UseScene some_scene() {
  return {.view_from_world = glm::lookAtRH(glm::vec3(-12, 3, 1), glm::vec3(4, 1.5f, -2), glm::vec3(0, 1, 0)),
          .fov_y = 0.9f,
          .aspect = 1.5f,
          .near = 0.2f,
          .far = 40,
          .lowest = {-20, 0, -15},
          .highest = {20, 8, 15},
          .mirror_height = 0.5f};
}

bool is_inside(const glm::mat4& matrix, const glm::vec3& point, float slack = 1e-4f) {
  const glm::vec4 p = matrix * glm::vec4(point, 1);
  const float w = p.w * (1 + slack);
  return p.w > 0 && std::abs(p.x) <= w && std::abs(p.y) <= w && p.z >= -slack * p.w && p.z <= w;
}

/// A point that the camera sees, and how deep it lies.
std::pair<glm::vec3, float> seen_point(const UseScene& scene, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1, 1), depths(scene.near, scene.far);
  const float depth = depths(random), tangent = std::tan(0.5f * scene.fov_y);
  const glm::vec4 p(unit(random) * tangent * scene.aspect * depth, unit(random) * tangent * depth, -depth, 1);
  return {glm::vec3(glm::inverse(scene.view_from_world) * p), depth};
}

glm::vec3 projected(const glm::mat4& matrix, const glm::vec3& point) {
  const glm::vec4 p = matrix * glm::vec4(point, 1);
  return glm::vec3(p) / p.w;
}

TEST(LayeredUses, EveryUseHasFiniteMatrices) {
  const std::pair<LayeredUse, size_t> counts[] = {{LayeredUse::cube, 6},
                                                  {LayeredUse::cube_array, 24},
                                                  {LayeredUse::cascades, 4},
                                                  {LayeredUse::cascade_sets, 12},
                                                  {LayeredUse::warped, 2},
                                                  {LayeredUse::reflection, 2},
                                                  {LayeredUse::reflection_cube, 6},
                                                  {LayeredUse::stereo, 2},
                                                  {LayeredUse::cad, 4}};
  EXPECT_EQ(layered_uses().size(), std::size(counts));
  for (size_t i = 0; i < layered_uses().size(); ++i)
    EXPECT_EQ(static_cast<size_t>(layered_uses()[i].use), i) << "the table is indexed by use";
  for (const auto& [use, count] : counts) {
    const auto matrices = use_matrices(use, some_scene());
    EXPECT_EQ(matrices.size(), count);
    for (const glm::mat4& m : matrices)
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) EXPECT_TRUE(std::isfinite(m[c][r]));
  }
}

TEST(LayeredUses, CubeFacesAreThoseOfVulkansCubeMaps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1, 1);
  const glm::vec3 from(1, 2, 3);
  const auto faces = cube_matrices(from, 0.01f, 100);
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 d(unit(random), unit(random), unit(random));
    // The table of the Vulkan specification, "Cube Map Face Selection and Transformations".
    const glm::vec3 a = glm::abs(d);
    int face;
    float s, t, m;
    if (a.x >= a.y && a.x >= a.z)
      face = d.x > 0 ? 0 : 1, s = d.x > 0 ? -d.z : d.z, t = -d.y, m = a.x;
    else if (a.y >= a.z)
      face = d.y > 0 ? 2 : 3, s = d.x, t = d.y > 0 ? d.z : -d.z, m = a.y;
    else
      face = d.z > 0 ? 4 : 5, s = d.z > 0 ? d.x : -d.x, t = -d.y, m = a.z;
    const glm::vec3 p = projected(faces[static_cast<size_t>(face)], from + 5.0f * d);
    EXPECT_NEAR(p.x, s / m, 1e-3f) << face;
    EXPECT_NEAR(p.y, t / m, 1e-3f) << face;
  }
}

TEST(LayeredUses, CascadesHoldTheirSlices) {
  const UseScene scene = some_scene();
  const auto ends = cascade_ends(scene.near, scene.far, 4);
  const auto one = use_matrices(LayeredUse::cascades, scene), three = use_matrices(LayeredUse::cascade_sets, scene);
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    const auto [point, depth] = seen_point(scene, random);
    const auto slice = static_cast<size_t>(std::lower_bound(ends.begin(), ends.end(), depth) - ends.begin());
    EXPECT_TRUE(is_inside(one[slice], point, 1e-3f)) << depth;
    for (size_t set = 0; set < 3; ++set) EXPECT_TRUE(is_inside(three[4 * set + slice], point, 1e-3f));
  }
  EXPECT_EQ(one[2], three[2]);
  EXPECT_NE(three[2], three[6]);
  for (size_t i = 1; i < 4; ++i) EXPECT_GT(ends[i], ends[i - 1]);
}

TEST(LayeredUses, TheWarpedMapHoldsTheViewAndFavoursWhatIsNear) {
  const UseScene scene = some_scene();
  const auto matrices = use_matrices(LayeredUse::warped, scene);
  std::mt19937 random(3);
  // Texels that a centimetre covers, near to the camera and far from it, in the plain and in the warped map.
  const auto density = [&](const glm::mat4& matrix, const glm::vec3& point) {
    const auto step = [&](const glm::vec3& along) {
      return glm::length(glm::vec2(projected(matrix, point + 0.01f * along) - projected(matrix, point)));
    };
    return step({1, 0, 0}) * step({0, 0, 1});
  };
  double near_gain = 0, far_gain = 0;
  for (int i = 0; i < 500; ++i) {
    const auto [point, depth] = seen_point(scene, random);
    EXPECT_TRUE(is_inside(matrices[1], point, 1e-3f));
    (depth < 8 ? near_gain : far_gain) +=
        std::log(density(matrices[1], point) / density(matrices[0], point)) / (depth < 8 ? 100 : 400);
    // Parallel light stays parallel: along it, the place on the map does not change.
    const glm::vec3 moved = projected(matrices[1], point + 2.0f * glm::normalize(kSunDirection));
    EXPECT_LT(glm::length(glm::vec2(moved - projected(matrices[1], point))), 2e-3f);
    EXPECT_GT(moved.z, projected(matrices[1], point).z);
  }
  EXPECT_GT(near_gain, far_gain);
}

TEST(LayeredUses, TheMirroredViewIsTheViewOfTheMirroredScene) {
  const UseScene scene = some_scene();
  const auto matrices = use_matrices(LayeredUse::reflection, scene);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> x(-15, 15), y(0.6f, 7), z(-12, 12);
  int seen = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 point(x(random), y(random), z(random)),
        mirrored(point.x, 2 * scene.mirror_height - point.y, point.z);
    const glm::vec4 clip = matrices[1] * glm::vec4(point, 1);
    if (clip.w <= 0.2f) continue;
    ++seen;
    const glm::vec3 a = projected(matrices[1], point), b = projected(matrices[0], mirrored);
    EXPECT_NEAR(a.x, b.x, 1e-3f);
    EXPECT_NEAR(a.y, b.y, 1e-3f);
    EXPECT_GT(clip.z, 0) << "above the mirror";
    const glm::vec4 below = matrices[1] * glm::vec4(point.x, scene.mirror_height - 0.1f, point.z, 1);
    EXPECT_LT(below.z, 0) << "below the mirror";
  }
  EXPECT_GT(seen, 100);
}

TEST(LayeredUses, EyesAreSixtyFourMillimetresApart) {
  const UseScene scene = some_scene();
  const auto eyes = use_matrices(LayeredUse::stereo, scene);
  const glm::vec3 ahead = glm::vec3(glm::inverse(scene.view_from_world) * glm::vec4(0, 0, -5, 1));
  const float disparity = projected(eyes[0], ahead).x - projected(eyes[1], ahead).x;
  EXPECT_NEAR(disparity, 0.064f / (5 * std::tan(0.45f) * scene.aspect), 1e-4f);
  EXPECT_NEAR(projected(eyes[0], ahead).y, projected(eyes[1], ahead).y, 1e-5f);
}

TEST(LayeredUses, CadViewsShowTheWholeBoxUndistorted) {
  const UseScene scene = some_scene();
  const auto views = use_matrices(LayeredUse::cad, scene);
  for (int view = 0; view < 3; ++view) {
    for (int i = 0; i < 8; ++i)
      EXPECT_TRUE(is_inside(views[size_t(view)], {i & 1 ? 20 : -20, i & 2 ? 8 : 0, i & 4 ? 15 : -15}));
    // A metre to the right is as many pixels as a metre up.
    glm::vec2 scale(0);
    for (const glm::vec3& axis : {glm::vec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}})
      scale += glm::abs(glm::vec2(projected(views[size_t(view)], axis) - projected(views[size_t(view)], glm::vec3(0))));
    EXPECT_NEAR(scale.x * scene.aspect, scale.y, 1e-4f);
  }
}

}  // namespace
}  // namespace app
