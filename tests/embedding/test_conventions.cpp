// One scene under every way a host may set up its camera and its normals: the visibility is the same.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "stub_host.hpp"

namespace embedding {
namespace {

constexpr float near_m = 0.1f, far_m = 60.0f;
constexpr float aspect = float(picture_width) / float(picture_height);
constexpr float focal = 1.2f;  // 1 / tan(half of the vertical field of view)

const glm::vec3 eye{1.5f, 4.5f, 8.0f}, target{0, 0.5f, 0};

/// Right-handed as Vulkan likes it least and OpenGL most: x right, y up, looks along -z.
glm::mat4 look(glm::vec3 from, glm::vec3 to) {
  const glm::vec3 back = glm::normalize(from - to), right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  const glm::vec3 up = glm::cross(back, right);
  const glm::mat3 rotation = glm::transpose(glm::mat3(right, up, back));
  glm::mat4 view{rotation};
  view[3] = glm::vec4(-(rotation * from), 1);
  return view;
}

glm::mat4 flip(int axis) {
  glm::mat4 result{1};
  result[axis][axis] = -1;
  return result;
}

/// Clip z = a * view z + b; clip y points up in the picture.
glm::mat4 perspective(float a, float b) {
  glm::mat4 clip{0};
  clip[0][0] = focal / aspect;
  clip[1][1] = -focal;
  clip[2][2] = a;
  clip[3][2] = b;
  clip[2][3] = -1;
  return clip;
}

/// Depth from `at_near` at the near plane to `at_far` at the far plane.
glm::mat4 orthographic(float at_near, float at_far) {
  const float height_m = 5;
  glm::mat4 clip{1};
  clip[0][0] = 1 / (height_m * aspect);
  clip[1][1] = -1 / height_m;
  clip[2][2] = (at_near - at_far) / (far_m - near_m);
  clip[3][2] = at_near + clip[2][2] * near_m;
  return clip;
}

Convention reversed_infinite() {
  return {.view_from_world = look(eye, target), .clip_from_view = perspective(0, near_m)};
}

std::vector<Convention> perspective_conventions() {
  const float range = far_m - near_m;
  std::vector<Convention> all;
  auto add = [&](const char* name, auto change) {
    all.push_back(reversed_infinite());
    all.back().name = name;
    change(all.back());
  };
  add("reversed, far plane",
      [&](Convention& c) { c.clip_from_view = perspective(near_m / range, near_m * far_m / range); });
  add("forward, far plane", [&](Convention& c) {
    c.clip_from_view = perspective(-far_m / range, -near_m * far_m / range);
    c.near_is_one = false;
  });
  add("forward, infinite", [&](Convention& c) {
    c.clip_from_view = perspective(-1, -near_m);
    c.near_is_one = false;
  });
  add("OpenGL depth", [&](Convention& c) {
    c.clip_from_view = perspective(-(far_m + near_m) / range, -2 * near_m * far_m / range);
    c.opengl_depth = true;
    c.near_is_one = false;
  });
  add("flipped y", [&](Convention& c) {
    c.clip_from_view = flip(1) * c.clip_from_view;
    c.flipped = true;
  });
  add("left-handed", [&](Convention& c) {
    c.view_from_world = flip(2) * c.view_from_world;
    c.clip_from_view = c.clip_from_view * flip(2);
  });
  add("no normals", [&](Convention& c) { c.encoding = umbrage::NormalEncoding::none; });
  add("octahedral normals", [&](Convention& c) { c.encoding = umbrage::NormalEncoding::octahedral_snorm; });
  add("unsigned normals", [&](Convention& c) { c.encoding = umbrage::NormalEncoding::xyz_unorm; });
  return all;
}

/// At most one pixel×light pair in a thousand differs: positions come from depth buffers of different precision.
void expect_same(const Visibility& expected, const Visibility& found, const std::string& name) {
  ASSERT_EQ(expected.of.size(), found.of.size()) << name;
  size_t evaluated = 0, shadowed = 0, different = 0;
  for (size_t i = 0; i < expected.of.size(); i++) {
    if (expected.of[i] < 0 && found.of[i] < 0) continue;
    evaluated++;
    shadowed += expected.of[i] >= 0 && expected.of[i] < 0.5f;
    different += std::abs(expected.of[i] - found.of[i]) > 0.05f;
  }
  EXPECT_GT(evaluated, expected.of.size() / 20) << name;
  EXPECT_GT(shadowed, evaluated / 50) << name;
  EXPECT_LE(different, evaluated / 1000) << name << ": of " << evaluated;
}

/// Every cluster's cone holds the normals of its pixels; without normals it holds all.
void expect_cones(const Visibility& found, umbrage::NormalEncoding encoding, const std::string& name) {
  size_t wrong = 0, narrow = 0;
  for (const float cosine : found.cone_cosines) {
    wrong += cosine < -1.5f;
    narrow += cosine > 0.5f;
  }
  EXPECT_EQ(wrong, 0u) << name << ": of " << found.cone_cosines.size();
  if (encoding == umbrage::NormalEncoding::none)
    EXPECT_EQ(narrow, 0u) << name;
  else
    EXPECT_GT(narrow, found.cone_cosines.size() / 4) << name;
}

class Conventions : public testing::Test {
 protected:
  Conventions() : device_(take(umbrage::HeadlessDevice::create({.get_instance_proc_addr = vkGetInstanceProcAddr}))) {}

  Visibility render(const Scene& scene, const Convention& convention) {
    auto system = take(umbrage::ShadowSystem::create(device_.desc(), {.budget_mib = 32}));
    scene.add_to(system);
    StubHost host(device_.desc(), device_.queue(), system.descriptor_set_layout());
    return host.render(system, scene, convention);
  }

  template <class T>
  static T take(umbrage::Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(result).value();
  }

  umbrage::HeadlessDevice device_;
};

TEST_F(Conventions, PerspectiveCamerasAndNormalsAgree) {
  const Scene scene = Scene::room();
  const Visibility expected = render(scene, reversed_infinite());
  expect_cones(expected, umbrage::NormalEncoding::xyz_signed, "reversed infinite");
  for (const Convention& convention : perspective_conventions()) {
    const Visibility found = render(scene, convention);
    expect_same(expected, found, convention.name);
    expect_cones(found, convention.encoding, convention.name);
  }
}

TEST_F(Conventions, OrthographicCamerasAgree) {
  const Scene scene = Scene::room();
  Convention reversed = reversed_infinite(), forward = reversed;
  reversed.clip_from_view = orthographic(1, 0);
  forward.clip_from_view = orthographic(0, 1);
  forward.near_is_one = false;
  expect_same(render(scene, reversed), render(scene, forward), "orthographic");
}

TEST_F(Conventions, MirroredInstancesCastTheSameShadows) {
  Scene scene = Scene::room();
  const Visibility expected = render(scene, reversed_infinite());
  scene.mirrored = true;
  expect_same(expected, render(scene, reversed_infinite()), "mirrored instances");
}

TEST_F(Conventions, ShadowsDoNotDependOnTheOrigin) {
  const Visibility expected = render(Scene::room(), reversed_infinite());
  const glm::vec3 offset{500, 60, -300};
  Convention moved = reversed_infinite();
  moved.view_from_world = look(eye + offset, target + offset);
  expect_same(expected, render(Scene::room(offset), moved), "moved origin");
}

}  // namespace
}  // namespace embedding
