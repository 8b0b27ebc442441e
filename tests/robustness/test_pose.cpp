// Poses against values worked out by hand, or with another program from the file's numbers.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "import_test_files.hpp"

namespace import_test {
namespace {

using app::AnimatedPath;
using app::Interpolation;

void expect_near(const glm::vec3& value, const glm::vec3& expected, float tolerance = 1e-5f) {
  EXPECT_NEAR(value.x, expected.x, tolerance);
  EXPECT_NEAR(value.y, expected.y, tolerance);
  EXPECT_NEAR(value.z, expected.z, tolerance);
}

app::Channel channel(AnimatedPath path, Interpolation interpolation, std::vector<float> times,
                     std::vector<float> values) {
  return {
      .node = 0, .path = path, .interpolation = interpolation, .times = std::move(times), .values = std::move(values)};
}

/// A node with a light, moved by one channel.
app::Scene animated_light(const app::Channel& channel) {
  app::Scene scene;
  scene.lights.emplace_back();
  scene.nodes.push_back({.light = 0});
  scene.animations.push_back({.channels = {channel}, .duration = channel.times.back()});
  return scene;
}

glm::vec3 position_at(const app::Scene& scene, double time) { return app::pose(scene, time).lights.at(0).position; }

TEST(Pose, StepKeepsTheLastKey) {
  const auto scene =
      animated_light(channel(AnimatedPath::translation, Interpolation::step, {1, 2, 4}, {1, 0, 0, 2, 0, 0, 3, 0, 0}));
  expect_near(position_at(scene, 0), {1, 0, 0});  // before the first key
  expect_near(position_at(scene, 1.999), {1, 0, 0});
  expect_near(position_at(scene, 2), {2, 0, 0});
  expect_near(position_at(scene, 3.999), {2, 0, 0});
}

TEST(Pose, LinearAndLooping) {
  const auto scene =
      animated_light(channel(AnimatedPath::translation, Interpolation::linear, {0, 1, 4}, {0, 0, 0, 2, 4, 6, 8, 4, 0}));
  expect_near(position_at(scene, 0.25), {0.5f, 1, 1.5f});
  expect_near(position_at(scene, 2.5), {5, 4, 3});
  expect_near(position_at(scene, 4), {0, 0, 0});
  expect_near(position_at(scene, 400.25), {0.5f, 1, 1.5f});
  expect_near(position_at(scene, -1.5), {5, 4, 3});
}

TEST(Pose, CubicSplineScalesTangentsByTheKeyDistance) {
  // In-tangent, value, out-tangent of two keys, 2 s apart. At the middle: (v0 + v1) / 2 + 2 (b0 - a1) / 8.
  const auto scene = animated_light(channel(AnimatedPath::translation, Interpolation::cubic_spline, {0, 2},
                                            {9, 9, 9, 0, 0, 0, 4, 0, 1, 0, 2, -1, 1, 1, 1, 9, 9, 9}));
  expect_near(position_at(scene, 0), {0, 0, 0});
  expect_near(position_at(scene, 1), {0.5f + 1, 0.5f - 0.5f, 0.5f + 0.5f});
  // u = 1/4: h00 = 27/32, h10 = 9/64, h01 = 5/32, h11 = -3/64; tangents times 2.
  expect_near(position_at(scene, 0.5),
              {5.f / 32 + 2 * 4 * 9.f / 64, 5.f / 32 - 2 * 2 * 3.f / 64, 5.f / 32 + 2 * 9.f / 64 + 2 * 3.f / 64});
}

TEST(Pose, RotationTakesTheShortWayAtEvenSpeed) {
  const float half = std::sqrt(0.5f);
  // Identity to a quarter turn about y, the latter with its sign flipped: the same rotation.
  const auto scene =
      animated_light(channel(AnimatedPath::rotation, Interpolation::linear, {0, 3}, {0, 0, 0, 1, 0, -half, 0, -half}));
  const glm::vec3 direction = app::pose(scene, 1).lights[0].direction;  // 30 degrees
  expect_near(direction, {-0.5f, 0, -std::sqrt(0.75f)});
}

TEST(Pose, HierarchyAndRigidCameras) {
  app::Scene scene;
  scene.cameras.push_back({.fov_y = 1});
  scene.lights.emplace_back();
  const float half = std::sqrt(0.5f);
  scene.nodes.push_back({.translation = {1, 2, 3}, .rotation = {half, 0, half, 0}, .scale = {2, 3, 4}});
  scene.nodes.push_back({.name = "eye", .parent = 0, .translation = {0, 0, 1}, .camera = 0, .light = 0});
  const app::Pose pose = app::pose(scene, 0);
  ASSERT_EQ(pose.cameras.size(), 1u);
  // z is scaled by 4 and turned onto x; the camera looks along its -z, the world's -x.
  const glm::mat4& camera = pose.cameras[0].world_from_camera;
  expect_near(glm::vec3(camera[3]), {5, 2, 3});
  expect_near(glm::vec3(camera[2]), {1, 0, 0});
  expect_near(glm::vec3(camera[1]), {0, 1, 0});
  expect_near(glm::vec3(camera[0]), {0, 0, -1});
  EXPECT_EQ(pose.cameras[0].name, "eye");
  expect_near(pose.lights[0].position, {5, 2, 3});
  expect_near(pose.lights[0].direction, {-1, 0, 0});
}

TEST(Pose, MorphTargetsAddUp) {
  app::Primitive primitive{.positions = {{0, 0, 0}, {1, 0, 0}}, .indices = {0, 1, 0}};
  primitive.targets = {{.positions = {{0, 1, 0}, {0, 2, 0}}},
                       {.normals = {{0, 0, 1}, {0, 0, 1}}},
                       {.positions = {{4, 0, 0}, {8, 0, 0}}}};
  const app::PosedInstance instance{.weights = {0.5f, 1, -0.25f}};
  const auto positions = app::deformed_positions(primitive, instance, {});
  expect_near(positions[0], {-1, 0.5f, 0});
  expect_near(positions[1], {-1, 1, 0});
}

TEST(Pose, WeightsComeFromAnimationNodeOrMesh) {
  app::Scene scene;
  scene.meshes.push_back({.weights = {0.1f, 0.2f}});
  scene.nodes.push_back({.mesh = 0});
  scene.nodes.push_back({.mesh = 0, .weights = {0.3f, 0.4f}});
  scene.nodes.push_back({.mesh = 0});
  app::Channel weights = channel(AnimatedPath::weights, Interpolation::linear, {0, 1}, {0, 1, 1, 3});
  weights.node = 2;
  scene.animations.push_back({.channels = {weights}, .duration = 1});
  const app::Pose pose = app::pose(scene, 0.5);
  EXPECT_EQ(pose.instances[0].weights, (std::vector<float>{0.1f, 0.2f}));
  EXPECT_EQ(pose.instances[1].weights, (std::vector<float>{0.3f, 0.4f}));
  EXPECT_EQ(pose.instances[2].weights, (std::vector<float>{0.5f, 2.0f}));
}

TEST(MovingNodes, AncestorsJointsAndWeights) {
  app::Scene scene;
  scene.meshes.emplace_back();
  scene.skins.push_back({.joints = {2}, .inverse_bind = {glm::mat4(1)}});
  scene.skins.push_back({.joints = {3}, .inverse_bind = {glm::mat4(1)}});
  scene.nodes = {{.mesh = 0},
                 {},
                 {.parent = 1, .mesh = 0},
                 {.mesh = 0},
                 {.mesh = 0, .skin = 0},
                 {.parent = 1, .mesh = 0, .skin = 1},
                 {.mesh = 0}};
  app::Channel move = channel(AnimatedPath::translation, Interpolation::linear, {0, 1}, {0, 0, 0, 1, 0, 0});
  move.node = 1;
  app::Channel still = channel(AnimatedPath::translation, Interpolation::linear, {0, 1}, {1, 0, 0, 1, 0, 0});
  still.node = 3;
  app::Channel weights = channel(AnimatedPath::weights, Interpolation::step, {0, 1}, {0, 1});
  weights.node = 6;
  scene.animations.push_back({.channels = {move, still, weights}, .duration = 1});
  EXPECT_EQ(app::moving_nodes(scene), (std::vector<bool>{false, true, true, false, true, false, true}));
}

TEST(Pose, SimpleSkin) {
  const auto file = scene_file("animated/SimpleSkin.gltf");
  if (file.empty()) GTEST_SKIP() << "no animated/SimpleSkin.gltf in UMBRAGE_SCENES_DIR";
  const auto scene = app::import_gltf(file);
  ASSERT_LOADS(scene);
  // At 1 s the second joint, at (0, 1, 0), is turned a quarter about z; both inverse bind matrices move by (-0.5, -1,
  // 0).
  const app::Pose pose = app::pose(scene.value(), 1);
  ASSERT_EQ(pose.instances.size(), 1u);
  EXPECT_EQ(pose.instances[0].world_from_mesh, glm::mat4(1));
  const app::Primitive& primitive = scene.value().meshes[0].primitives[0];
  const auto deformed = app::deformed_positions(primitive, pose.instances[0], pose);
  struct Pair {
    glm::vec3 rest, posed;
  };
  const Pair pairs[] = {
      {{0, 0, 0}, {-0.5f, 0, 0}},  // first joint only
      {{1, 2, 0}, {-1, 1.5f, 0}},  // second joint only
      {{0, 2, 0}, {-1, 0.5f, 0}},
      {{0, 1, 0}, {-0.25f, 0.75f, 0}},  // half of each: (-0.5, 1, 0) and (0, 0.5, 0)
  };
  size_t found = 0;
  for (size_t v = 0; v < deformed.size(); ++v) {
    for (const Pair& pair : pairs) {
      if (primitive.positions[v] != pair.rest) continue;
      expect_near(deformed[v], pair.posed, 1e-3f);
      ++found;
    }
  }
  EXPECT_GE(found, 4u);
  EXPECT_EQ(app::moving_nodes(scene.value()), (std::vector<bool>{true, false, true}));
}

TEST(Pose, LightsOnAnAnimatedParent) {
  const auto file = scene_file("lights_and_masks/multiple_animated_lights.gltf");
  if (file.empty()) GTEST_SKIP() << "no lights_and_masks/multiple_animated_lights.gltf in UMBRAGE_SCENES_DIR";
  const auto scene = app::import_gltf(file);
  ASSERT_LOADS(scene);
  const auto check = [&](double time, const char* name, const glm::vec3& position, const glm::vec3& direction) {
    const app::Pose pose = app::pose(scene.value(), time);
    size_t found = 0;
    for (const app::PosedLight& light : pose.lights) {
      if (light.name != name) continue;
      ++found;
      expect_near(light.position, position, 2e-5f);
      expect_near(light.direction, direction, 2e-5f);
    }
    EXPECT_EQ(found, 1u) << name;
  };
  check(0, "Spot.001_Orientation", {-0.21158f, 0.04015f, -1.2278f}, {-1, 0, 0});
  check(0, "Spot.017_Orientation", {-1.01487f, 0.04015f, -0.7115f}, {-0.70711f, 0, 0.70711f});
  check(1.3, "Spot.001_Orientation", {-0.6196f, 0.04015f, 1.0809f}, {0.77051f, 0, 0.63742f});
  check(1.3, "Spot.017_Orientation", {0.32844f, 0.04015f, 1.19512f}, {0.99556f, 0, -0.09411f});
  check(1.3, "Point_Orientation", {0.01f, 3.10352f, 0}, {0, -1, 0});
}

TEST(Pose, MorphStressTest) {
  const auto file = scene_file("animated/MorphStressTest.gltf");
  if (file.empty()) GTEST_SKIP() << "no animated/MorphStressTest.gltf in UMBRAGE_SCENES_DIR";
  const auto scene = app::import_gltf(file);
  ASSERT_LOADS(scene);
  ASSERT_EQ(scene.value().animations.size(), 3u);
  // Halfway between the fourth and the fifth key. All three animations set the weights; the last one stays.
  const app::Pose pose = app::pose(scene.value(), 0.1458333358168602);
  ASSERT_EQ(pose.instances[0].weights.size(), 8u);
  EXPECT_NEAR(pose.instances[0].weights[0], 0.1327778f, 1e-5f);
  const app::Primitive& primitive = scene.value().meshes[0].primitives[1];
  const auto deformed = app::deformed_positions(primitive, pose.instances[0], pose);
  ASSERT_EQ(deformed.size(), 1504u);
  expect_near(primitive.positions[27], {-1.825f, 0.45f, 0.25f});
  expect_near(deformed[27], {-1.8183612f, 0.5827778f, 0.25f});
}

TEST(Pose, IsTheSameEveryTime) {
  const auto file = scene_file("animated/Fox.glb");
  if (file.empty()) GTEST_SKIP() << "no animated/Fox.glb in UMBRAGE_SCENES_DIR";
  const auto first = app::import_gltf(file), second = app::import_gltf(file);
  ASSERT_LOADS(first);
  ASSERT_LOADS(second);
  EXPECT_EQ(app::pose(first.value(), 0.37).joint_matrices, app::pose(second.value(), 0.37).joint_matrices);
}

}  // namespace
}  // namespace import_test
