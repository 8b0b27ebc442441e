// Random lights: over surfaces that the cameras see, in the open, bright enough, the same for the same seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "commands/camera_source.hpp"
#include "commands/random_lights.hpp"
#include "commands/visibility_buffer.hpp"

namespace {

using namespace app;

/// A quad with corners a, a + u, a + u + v, a + v as a mesh of its own.
void add_quad(Scene& scene, glm::vec3 a, glm::vec3 u, glm::vec3 v, uint32_t material = 0) {
  Primitive quad;
  quad.positions = {a, a + u, a + u + v, a + v};
  quad.normals.assign(4, glm::normalize(glm::cross(u, v)));
  quad.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  quad.material = material;
  scene.meshes.push_back({.primitives = {quad}});
  Node node;
  node.mesh = static_cast<int>(scene.meshes.size()) - 1;
  scene.nodes.push_back(node);
}

Pose pose_of(const Scene& scene, const std::vector<glm::mat4>& cameras, const Camera& lens = {}) {
  Pose pose;
  for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
    PosedInstance instance;
    instance.node = i;
    instance.mesh = static_cast<uint32_t>(scene.nodes[i].mesh);
    pose.instances.push_back(instance);
  }
  for (const glm::mat4& camera : cameras)
    pose.cameras.push_back({.name = "c", .lens = lens, .world_from_camera = camera});
  return pose;
}

/// A floor of 20 × 20 and a wall at x = 0 that hides the half with x < 0 from cameras at x > 0.
Scene floor_and_wall() {
  Scene scene;
  scene.materials.emplace_back();
  add_quad(scene, {-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
  add_quad(scene, {0, 0, -10}, {0, 0, 20}, {0, 10, 0});
  return scene;
}

TEST(VisibilityBuffer, SeesThePlaneWhereItIs) {
  for (const bool orthographic : {false, true}) {
    Scene scene;
    scene.materials.emplace_back();
    add_quad(scene, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
    const Pose pose = pose_of(scene, {look_at({1, 9, 5}, {0, 0, 0})},
                              {.orthographic = orthographic, .half_width = 4, .half_height = 2.25f});
    VisibilityBuffer buffer(pose.cameras[0]);
    for_each_primitive(scene, pose, [&](const PosedPrimitive& posed) { buffer.draw(scene, posed); });
    for (uint32_t y = 0; y < VisibilityBuffer::kHeight; y += 20) {
      for (uint32_t x = 0; x < VisibilityBuffer::kWidth; x += 20) {
        const auto point = buffer.at(x, y);
        ASSERT_TRUE(point) << x << ' ' << y;
        EXPECT_NEAR(point->position.y, 0, 1e-3f);
        EXPECT_NEAR(point->normal.y, 1, 1e-5f);
        EXPECT_GT(point->area, 0);
        EXPECT_TRUE(buffer.sees(point->position + glm::vec3(0, 0.01f, 0)));
        EXPECT_FALSE(buffer.sees(point->position - glm::vec3(0, 0.01f, 0)));
      }
    }
  }
}

TEST(VisibilityBuffer, LooksThroughMaskedTexelsAndGlass) {
  Scene scene;
  scene.materials.resize(3);
  scene.images.push_back({.width = 2, .height = 1, .rgba = {255, 255, 255, 0, 255, 255, 255, 255}});
  scene.materials[1].alpha_mode = AlphaMode::mask;
  scene.materials[1].base_color_texture.image = 0;
  scene.materials[2].alpha_mode = AlphaMode::blend;
  add_quad(scene, {-9, -9, -2}, {18, 0, 0}, {0, 18, 0});
  add_quad(scene, {-9, -9, -1}, {18, 0, 0}, {0, 18, 0}, 1);
  add_quad(scene, {-9, -9, -0.5f}, {18, 0, 0}, {0, 18, 0}, 2);
  const Pose pose = pose_of(scene, {glm::mat4(1)});
  VisibilityBuffer buffer(pose.cameras[0]);
  for_each_primitive(scene, pose, [&](const PosedPrimitive& posed) { buffer.draw(scene, posed); });
  const uint32_t middle = VisibilityBuffer::kHeight / 2;
  EXPECT_NEAR(buffer.at(VisibilityBuffer::kWidth / 2 - 5, middle)->position.z, -2, 1e-4f);
  EXPECT_NEAR(buffer.at(VisibilityBuffer::kWidth / 2 + 5, middle)->position.z, -1, 1e-4f);
}

TEST(RandomLights, StandInTheOpenOverSeenSurfaces) {
  const Scene scene = floor_and_wall();
  const Pose pose = pose_of(scene, {look_at({9, 4, 9}, {3, 0, 0}), look_at({9, 4, -9}, {3, 0, 0})});
  const auto lights = random_lights(scene, pose, scene_bounds(scene, pose), 300, 7);
  ASSERT_TRUE(lights) << lights.error().message;
  ASSERT_EQ(lights->size(), 300u);
  for (const PosedLight& light : *lights) {
    EXPECT_EQ(light.kind, LightKind::point);
    // Before the wall, above the floor, no farther than its range allows.
    EXPECT_GT(light.position.x, 0);
    EXPECT_GT(light.position.y, 0);
    const float distance = std::min(light.position.x, light.position.y);
    EXPECT_LT(distance, 0.5f * light.range);
    const float window = 1 - std::pow(distance / light.range, 4.0f);
    EXPECT_GE(light.intensity * window / (distance * distance), 0.5f);
    EXPECT_EQ(std::max({light.color.r, light.color.g, light.color.b}), 1);
  }
}

TEST(RandomLights, CoverWhatIsSeenEvenly) {
  const Scene scene = floor_and_wall();
  const Pose pose = pose_of(scene, {look_at({9, 30, 0.1f}, {5, 0, 0})});
  const auto lights = random_lights(scene, pose, scene_bounds(scene, pose), 400, 1);
  ASSERT_TRUE(lights);
  size_t quarter[4] = {};
  for (const PosedLight& light : *lights) ++quarter[(light.position.x > 5 ? 1 : 0) + (light.position.z > 0 ? 2 : 0)];
  for (const size_t count : quarter) EXPECT_GT(count, 40u);
  const auto [least, most] = std::minmax_element(lights->begin(), lights->end(),
                                                 [](const auto& a, const auto& b) { return a.range < b.range; });
  EXPECT_GT(most->range, 2 * least->range);
}

TEST(RandomLights, SameSeedSameLights) {
  const Scene scene = floor_and_wall();
  for (const bool has_camera : {true, false}) {
    const Pose pose = has_camera ? pose_of(scene, {look_at({9, 4, 9}, {3, 0, 0})}) : pose_of(scene, {});
    const Box bounds = scene_bounds(scene, pose);
    const auto a = random_lights(scene, pose, bounds, 50, 3), b = random_lights(scene, pose, bounds, 50, 3);
    const auto other = random_lights(scene, pose, bounds, 50, 4);
    ASSERT_TRUE(a && b && other);
    size_t moved = 0;
    for (size_t i = 0; i < a->size(); ++i) {
      EXPECT_EQ((*a)[i].position, (*b)[i].position);
      EXPECT_EQ((*a)[i].color, (*b)[i].color);
      EXPECT_EQ((*a)[i].range, (*b)[i].range);
      moved += (*a)[i].position != (*other)[i].position;
    }
    EXPECT_GT(moved, 45u);
  }
}

TEST(RandomLights, WithoutCamerasAreOverAllSurfaces) {
  const Scene scene = floor_and_wall();
  const Pose pose = pose_of(scene, {});
  const auto lights = random_lights(scene, pose, scene_bounds(scene, pose), 600, 1);
  ASSERT_TRUE(lights);
  ASSERT_EQ(lights->size(), 600u);
  size_t behind = 0;
  for (const PosedLight& light : *lights) behind += light.position.x < 0;
  EXPECT_GT(behind, 150u);
}

TEST(RandomLights, AnEmptySceneIsRefused) {
  const Scene scene;
  EXPECT_FALSE(random_lights(scene, {}, {}, 1, 1));
  EXPECT_TRUE(random_lights(scene, {}, {}, 0, 1));
}

}  // namespace
