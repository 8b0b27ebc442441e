// Eye points and windings recovered from any matrix, against how they were made and against projected triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "layered/eye_point.hpp"
#include "layered/layered_types.shared.h"

namespace umbrage::layered {
namespace {

Mat4 to_mat4(const glm::mat4& m) {
  Mat4 out;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) out.m[4 * c + r] = m[c][r];
  return out;
}

glm::mat4 random_view(std::mt19937& random) {
  std::uniform_real_distribution<float> place(-20.0f, 20.0f);
  const glm::vec3 eye(place(random), place(random), place(random));
  return glm::lookAt(eye, eye + glm::vec3(place(random), place(random), place(random) + 0.1f),
                     glm::vec3(0.1f, 1, 0.2f));
}

/// What back-face culling says of a triangle must agree with how its projection winds.
void expect_winding(const glm::mat4& matrix, DepthOrder order, std::mt19937& random) {
  const EyePoint found = eye_point(to_mat4(matrix), order);
  std::uniform_real_distribution<float> place(-1.0f, 1.0f);
  const glm::mat4 world_from_clip = glm::inverse(matrix);
  int compared = 0;
  for (int i = 0; i < 50; ++i) {
    glm::vec3 world[3];
    for (glm::vec3& p : world) {
      const glm::vec4 h = world_from_clip * glm::vec4(place(random), place(random), 0.5f + 0.2f * place(random), 1);
      p = glm::vec3(h) / h.w;
    }
    glm::vec2 screen[3];
    bool is_seen = true;  // a warp may put a part of clip space behind
    for (int v = 0; v < 3; ++v) {
      const glm::vec4 clip = matrix * glm::vec4(world[v], 1);
      is_seen = is_seen && clip.w > 0;
      screen[v] = glm::vec2(clip) / clip.w;
    }
    if (!is_seen) continue;
    ++compared;
    const glm::vec2 a = screen[1] - screen[0], b = screen[2] - screen[0];
    const float area = a.x * b.y - a.y * b.x;
    if (std::abs(area) < 0.05f) continue;
    // x right, y down: positive is Vulkan's clockwise, which fronts are unless the view mirrors.
    const bool is_front = (area > 0) != found.is_mirrored;
    EXPECT_EQ(shared::is_culled_face(world[0], world[1], world[2], found.eye, 1.0f, shared::CullBack), !is_front);
    EXPECT_EQ(shared::is_culled_face(world[0], world[1], world[2], found.eye, 1.0f, shared::CullFront), is_front);
    EXPECT_EQ(shared::is_culled_face(world[0], world[1], world[2], found.eye, -1.0f, shared::CullBack), is_front);
  }
  EXPECT_GT(compared, 10);
}

TEST(EyePoint, IsThePointThatAPerspectiveLooksFrom) {
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    const glm::mat4 view = random_view(random);
    const glm::mat4 matrix = glm::perspectiveRH_ZO(1.0f, 1.5f, 0.1f, 50.0f) * view;
    const glm::vec3 expected = glm::vec3(glm::inverse(view)[3]);
    const EyePoint found = eye_point(to_mat4(matrix), DepthOrder::smaller_is_nearer);
    EXPECT_EQ(found.eye.w, 1);
    EXPECT_LT(glm::distance(glm::vec3(found.eye), expected), 1e-3f);
    expect_winding(matrix, DepthOrder::smaller_is_nearer, random);
  }
}

TEST(EyePoint, IsTheDirectionTowardsAParallelViewer) {
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) {
    const glm::mat4 view = random_view(random);
    const glm::vec3 towards = glm::vec3(glm::inverse(view)[2]);  // it looks along -z
    for (const bool reversed : {false, true}) {
      const glm::mat4 matrix = (reversed ? glm::orthoRH_ZO(-3.0f, 3.0f, -2.0f, 2.0f, 50.0f, 0.1f)
                                         : glm::orthoRH_ZO(-3.0f, 3.0f, -2.0f, 2.0f, 0.1f, 50.0f)) *
                               view;
      const DepthOrder order = reversed ? DepthOrder::larger_is_nearer : DepthOrder::smaller_is_nearer;
      const EyePoint found = eye_point(to_mat4(matrix), order);
      EXPECT_EQ(found.eye.w, 0);
      EXPECT_GT(glm::dot(glm::vec3(found.eye), towards), 0.999f);
      expect_winding(matrix, order, random);
    }
  }
}

TEST(EyePoint, KnowsMirroredReversedAndWarpedViews) {
  std::mt19937 random(3);
  glm::mat4 flip(1);
  flip[1][1] = -1;
  glm::mat4 warp(1);  // a projective map of clip space: what perspective and trapezoidal shadow maps are
  warp[0][3] = 0.3f, warp[1][3] = -0.2f;
  for (int i = 0; i < 10; ++i) {
    const glm::mat4 view = random_view(random);
    const glm::mat4 matrix = glm::perspectiveRH_ZO(1.2f, 1.0f, 0.1f, 40.0f) * view;
    const EyePoint plain = eye_point(to_mat4(matrix), DepthOrder::smaller_is_nearer);
    const EyePoint flipped = eye_point(to_mat4(flip * matrix), DepthOrder::smaller_is_nearer);
    EXPECT_NE(plain.is_mirrored, flipped.is_mirrored);
    EXPECT_LT(glm::distance(glm::vec3(plain.eye), glm::vec3(flipped.eye)), 1e-3f);
    expect_winding(flip * matrix, DepthOrder::smaller_is_nearer, random);
    expect_winding(glm::perspectiveRH_ZO(1.2f, 1.0f, 40.0f, 0.1f) * view, DepthOrder::larger_is_nearer, random);
    expect_winding(warp * matrix, DepthOrder::smaller_is_nearer, random);
    expect_winding(warp * glm::orthoRH_ZO(-3.0f, 3.0f, -3.0f, 3.0f, 0.1f, 40.0f) * view, DepthOrder::smaller_is_nearer,
                   random);
  }
}

}  // namespace
}  // namespace umbrage::layered
