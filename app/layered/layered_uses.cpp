// Matrices of the uses: Vulkan's clip space, y down, depth 0 near and 1 far.
#include "layered/layered_uses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace app {

namespace {

constexpr uint32_t kCascades = 4;
constexpr std::array<glm::vec3, 3> kSuns{kSunDirection, glm::vec3(0.7f, -0.6f, 0.2f), glm::vec3(0.1f, -0.9f, 0.6f)};

/// glm's clip space has y up.
glm::mat4 y_down(const glm::mat4& clip) {
  glm::mat4 flip(1);
  flip[1][1] = -1;
  return flip * clip;
}

glm::mat4 perspective(const UseScene& scene) {
  return y_down(glm::perspectiveRH_ZO(scene.fov_y, scene.aspect, scene.near, scene.far));
}

std::array<glm::vec3, 8> corners_of(const glm::vec3& lowest, const glm::vec3& highest) {
  std::array<glm::vec3, 8> corners;
  for (size_t i = 0; i < 8; ++i)
    corners[i] = {i & 1 ? highest.x : lowest.x, i & 2 ? highest.y : lowest.y, i & 4 ? highest.z : lowest.z};
  return corners;
}

/// Of the camera's view between two depths, in the world.
std::array<glm::vec3, 8> slice_corners(const UseScene& scene, float near, float far) {
  const glm::mat4 world_from_view = glm::inverse(scene.view_from_world);
  const float tangent = std::tan(0.5f * scene.fov_y);
  std::array<glm::vec3, 8> corners;
  for (size_t i = 0; i < 8; ++i) {
    const float depth = i & 4 ? far : near;
    const float x = (i & 1 ? 1.0f : -1.0f) * tangent * scene.aspect * depth,
                y = (i & 2 ? 1.0f : -1.0f) * tangent * depth;
    corners[i] = glm::vec3(world_from_view * glm::vec4(x, y, -depth, 1));
  }
  return corners;
}

/// Looks along the direction; the second axis lies towards `up` where that is possible.
glm::mat4 light_frame(const glm::vec3& direction, const glm::vec3& up) {
  const glm::vec3 unit = glm::normalize(direction);
  const bool is_along = std::abs(glm::dot(unit, glm::normalize(up))) > 0.99f;
  return glm::lookAtRH(glm::vec3(0), unit, is_along ? glm::vec3(unit.y, unit.z, unit.x) : up);
}

struct Bounds {
  glm::vec3 lo{std::numeric_limits<float>::max()}, hi{std::numeric_limits<float>::lowest()};
  void extend(const glm::vec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
};

template <class Points>
Bounds bounds_in(const glm::mat4& frame, const Points& points) {
  Bounds bounds;
  for (const glm::vec3& point : points) bounds.extend(glm::vec3(frame * glm::vec4(point, 1)));
  return bounds;
}

/// Around xy of one box and the depths of another, both in the frame that looks along -z.
glm::mat4 ortho_around(const glm::mat4& frame, const Bounds& area, const Bounds& depth) {
  const float margin = 1e-3f * std::max(depth.hi.z - depth.lo.z, 1e-3f);
  return y_down(
             glm::orthoRH_ZO(area.lo.x, area.hi.x, area.lo.y, area.hi.y, -depth.hi.z - margin, -depth.lo.z + margin)) *
         frame;
}

std::vector<glm::mat4> cascades_of(const UseScene& scene, const glm::vec3& direction) {
  std::vector<glm::mat4> matrices;
  float begin = scene.near;
  for (const float end : cascade_ends(scene.near, scene.far, kCascades)) {
    matrices.push_back(cascade_matrix(scene, direction, begin, end));
    begin = end;
  }
  return matrices;
}

std::vector<glm::mat4> cad_views(const UseScene& scene) {
  const glm::vec3 center = 0.5f * (scene.lowest + scene.highest);
  std::vector<glm::mat4> matrices;
  for (const auto& [direction, up] : {std::pair{glm::vec3(0, -1, 0), glm::vec3(0, 0, -1)},
                                      {glm::vec3(0, 0, -1), glm::vec3(0, 1, 0)},
                                      {glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0)}}) {
    const glm::mat4 frame = glm::lookAtRH(center - direction, center, up);
    Bounds box = bounds_in(frame, corners_of(scene.lowest, scene.highest));
    // The picture's shape, so that nothing is stretched.
    const glm::vec3 middle = 0.5f * (box.lo + box.hi);
    glm::vec2 half(0.52f * (box.hi.x - box.lo.x), 0.52f * (box.hi.y - box.lo.y));
    if (half.x < half.y * scene.aspect)
      half.x = half.y * scene.aspect;
    else
      half.y = half.x / scene.aspect;
    const Bounds area{{middle.x - half.x, middle.y - half.y, 0}, {middle.x + half.x, middle.y + half.y, 0}};
    matrices.push_back(ortho_around(frame, area, box));
  }
  matrices.push_back(perspective(scene) * scene.view_from_world);
  return matrices;
}

}  // namespace

std::span<const LayeredUseInfo> layered_uses() {
  static constexpr std::array<LayeredUseInfo, 9> kUses{{
      {LayeredUse::cube, "cube", "a point light's shadow cube map", false, 3},
      {LayeredUse::cube_array, "cube-array", "four shadow cube maps in one array", false, 6},
      {LayeredUse::cascades, "cascades", "four cascades of a directional light", false, 4},
      {LayeredUse::cascade_sets, "cascade-sets", "four cascades of each of three lights, in one pass", false, 4},
      {LayeredUse::warped, "warped", "a light-space perspective map beside the plain one", false, 2},
      {LayeredUse::reflection, "reflection", "a camera, and what it sees in a mirror on the ground", true, 2},
      {LayeredUse::reflection_cube, "reflection-cube", "a reflection cube map, and the mirror ball it is for", true, 1},
      {LayeredUse::stereo, "stereo", "two eyes", true, 2},
      {LayeredUse::cad, "cad", "top, front, side and a camera", true, 2},
  }};
  return kUses;
}

std::array<glm::mat4, 6> cube_matrices(const glm::vec3& from, float near, float far) {
  constexpr std::array<glm::vec3, 6> kAxes{glm::vec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0},
                                           {0, -1, 0},         {0, 0, 1},  {0, 0, -1}};
  constexpr std::array<glm::vec3, 6> kUps{glm::vec3(0, -1, 0), {0, -1, 0}, {0, 0, 1},
                                          {0, 0, -1},          {0, -1, 0}, {0, -1, 0}};
  std::array<glm::mat4, 6> faces;
  for (size_t i = 0; i < 6; ++i)
    // The faces' t runs down where glm's y runs up: these ups make both the same.
    faces[i] =
        glm::perspectiveRH_ZO(glm::half_pi<float>(), 1.0f, near, far) * glm::lookAtRH(from, from + kAxes[i], kUps[i]);
  return faces;
}

std::vector<float> cascade_ends(float near, float far, uint32_t cascades) {
  std::vector<float> ends;
  for (uint32_t i = 1; i <= cascades; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(cascades);
    ends.push_back(0.5f * (near * std::pow(far / near, t) + near + (far - near) * t));
  }
  ends.back() = far;
  return ends;
}

glm::mat4 cascade_matrix(const UseScene& scene, const glm::vec3& direction, float near, float far) {
  const glm::mat4 frame = light_frame(direction, glm::vec3(0, 1, 0));
  Bounds depth = bounds_in(frame, corners_of(scene.lowest, scene.highest));
  const Bounds area = bounds_in(frame, slice_corners(scene, near, far));
  depth.lo.z = std::min(depth.lo.z, area.lo.z), depth.hi.z = std::max(depth.hi.z, area.hi.z);
  return ortho_around(frame, area, depth);
}

glm::mat4 sun_matrix(const UseScene& scene, const glm::vec3& direction) {
  const glm::mat4 frame = light_frame(direction, glm::vec3(0, 1, 0));
  const Bounds box = bounds_in(frame, corners_of(scene.lowest, scene.highest));
  return ortho_around(frame, box, box);
}

glm::mat4 warped_matrix(const UseScene& scene, const glm::vec3& direction) {
  // y along the camera's line of sight as the light sees it, z against the light.
  const glm::vec3 forward = -glm::vec3(glm::inverse(scene.view_from_world)[2]);
  const glm::mat4 frame = light_frame(direction, forward);
  const auto slice = slice_corners(scene, scene.near, scene.far);
  const auto box = corners_of(scene.lowest, scene.highest);
  Bounds all = bounds_in(frame, box);
  for (const glm::vec3& corner : slice) all.extend(glm::vec3(frame * glm::vec4(corner, 1)));
  // A perspective along y from a point behind everything; parallel light stays parallel, because w is the same along z.
  const float length = all.hi.y - all.lo.y, behind = 0.35f * length;
  glm::mat4 warp(0);
  warp[0][0] = 1;
  warp[2][2] = 1;
  warp[1][1] = (2 * behind + length) / length;
  warp[3][1] = -2 * behind * (behind + length) / length - warp[1][1] * (all.lo.y - behind);
  warp[1][3] = 1;
  warp[3][3] = behind - all.lo.y;
  const glm::mat4 warped = warp * frame;
  Bounds area, depth;
  const auto extend = [&](Bounds& bounds, const glm::vec3& corner) {
    const glm::vec4 p = warped * glm::vec4(corner, 1);
    bounds.extend(glm::vec3(p) / p.w);
  };
  for (const glm::vec3& corner : slice) extend(area, corner), extend(depth, corner);
  for (const glm::vec3& corner : box) extend(depth, corner);
  return ortho_around(glm::mat4(1), area, depth) * warped;
}

glm::mat4 mirrored_matrix(const UseScene& scene, float height) {
  glm::mat4 mirror(1);
  mirror[1][1] = -1;
  mirror[3][1] = 2 * height;
  const glm::mat4 view = scene.view_from_world * mirror;
  glm::mat4 clip = perspective(scene);
  // Lengyel's oblique near plane, for depth 0…1: z = 0 on the mirror, z = w at the far corner opposite to it.
  const glm::vec4 plane = glm::transpose(glm::inverse(view)) * glm::vec4(0, 1, 0, -height);
  const auto sign = [](float x) { return x < 0 ? -1.0f : 1.0f; };
  const glm::vec4 side = glm::transpose(glm::inverse(clip)) * plane;
  const glm::vec4 corner = glm::inverse(clip) * glm::vec4(sign(side.x), sign(side.y), 1, 1);
  const glm::vec4 row = plane / glm::dot(plane, corner);
  for (int column = 0; column < 4; ++column) clip[column][2] = row[column];
  return clip * view;
}

glm::vec4 mirror_ball(const UseScene& scene) {
  const glm::mat4 world_from_view = glm::inverse(scene.view_from_world);
  const glm::vec3 eye(world_from_view[3]), forward = -glm::vec3(world_from_view[2]);
  // As far off as the ground below the camera allows.
  float distance = 0.12f * glm::length(scene.highest - scene.lowest);
  const auto reach = [&] { return eye.y + distance * forward.y - 1.3f * 0.3f * distance; };
  for (int i = 0; i < 20 && reach() < scene.mirror_height; ++i) distance *= 0.8f;
  return glm::vec4(eye + distance * forward, 0.3f * distance);
}

std::vector<glm::mat4> use_matrices(LayeredUse use, const UseScene& scene) {
  const glm::vec3 center = 0.5f * (scene.lowest + scene.highest), size = scene.highest - scene.lowest;
  const glm::mat4 camera = perspective(scene) * scene.view_from_world;
  std::vector<glm::mat4> matrices;
  const auto add_cube = [&](const glm::vec3& from, float near) {
    for (const glm::mat4& face : cube_matrices(from, near, 2 * glm::length(size))) matrices.push_back(face);
  };
  const float near = 2e-3f * glm::length(size);
  switch (use) {
    case LayeredUse::cube:
      add_cube(center, near);
      break;
    case LayeredUse::cube_array:
      for (const glm::vec2 offset : {glm::vec2(-0.25f, -0.2f), {0.25f, -0.2f}, {-0.25f, 0.2f}, {0.25f, 0.2f}})
        add_cube(center + size * glm::vec3(offset.x, 0, offset.y), near);
      break;
    case LayeredUse::cascades:
      return cascades_of(scene, kSunDirection);
    case LayeredUse::cascade_sets:
      for (const glm::vec3& sun : kSuns)
        for (const glm::mat4& cascade : cascades_of(scene, sun)) matrices.push_back(cascade);
      break;
    case LayeredUse::warped:
      return {cascade_matrix(scene, kSunDirection, scene.near, scene.far), warped_matrix(scene, kSunDirection)};
    case LayeredUse::reflection:
      return {camera, mirrored_matrix(scene, scene.mirror_height)};
    case LayeredUse::reflection_cube: {
      const glm::vec4 ball = mirror_ball(scene);
      add_cube(glm::vec3(ball), 1.02f * ball.w);  // the ball itself is nearer than the near planes
      break;
    }
    case LayeredUse::stereo:
      for (const float side : {-0.032f, 0.032f}) {  // metres from the middle
        const glm::mat4 to_eye = glm::translate(glm::mat4(1), glm::vec3(-side, 0, 0));
        matrices.push_back(perspective(scene) * to_eye * scene.view_from_world);
      }
      break;
    case LayeredUse::cad:
      return cad_views(scene);
  }
  return matrices;
}

}  // namespace app
