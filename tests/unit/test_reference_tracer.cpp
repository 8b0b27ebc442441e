// The ray tracer against scenes whose shadows are known on paper.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "reference/camera_rays.hpp"
#include "reference/reference_loader.hpp"
#include "reference_scene.hpp"

namespace {

using app::AlphaMode;
using app::LightKind;
using reference::blocked;
using reference::not_evaluated;
using reference::visible;
using test::quad;
using test::QuadScene;

constexpr glm::vec3 X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);

std::unique_ptr<reference::RayTracer> trace(const QuadScene& scene) {
  auto tracer = reference::load_ray_tracer(scene.scene, scene.pose, UMBRAGE_REFERENCE_MODULE);
  if (!tracer) {
    ADD_FAILURE() << tracer.error().message;
    std::abort();
  }
  return std::move(tracer).value();
}

/// Visibility at points with a normal each the same, as one row of pixels.
std::vector<uint8_t> visibility(const QuadScene& scene, const reference::Light& light,
                                const std::vector<glm::vec3>& points, glm::vec3 normal = Y) {
  std::vector<float> positions, normals;
  for (const glm::vec3 p : points) {
    positions.insert(positions.end(), {p.x, p.y, p.z});
    normals.insert(normals.end(), {normal.x, normal.y, normal.z});
  }
  std::vector<uint8_t> evaluated(points.size(), 0), result(points.size(), 77);
  trace(scene)->visibility(light, {uint32_t(points.size()), 1, positions, normals}, evaluated, result);
  return result;
}

uint8_t visibility_at(const QuadScene& scene, const reference::Light& light, glm::vec3 point) {
  return visibility(scene, light, {point}).front();
}

/// Floor at y = 0, 20 m wide, and an occluder 2 m wide around (0, height, 0). Material 1 is the occluder's.
QuadScene floor_and_occluder(float height = 1) {
  QuadScene scene;
  scene.scene.materials.resize(2);
  scene.add(quad({0, 0, 0}, 10.0f * Z, 10.0f * X));
  scene.add(quad({0, height, 0}, X, -Z, 1));
  return scene;
}

reference::Light point_light(glm::vec3 position, float near = 0.01f) {
  reference::Light light;
  light.position = position;
  light.range = 100;
  light.near = near;
  return light;
}

/// Holds the visibility of a grid of floor points against a rule. No point of the grid is nearer than 1 cm to a border of it.
void expect_on_floor(const QuadScene& scene, const reference::Light& light,
                     const std::function<bool(glm::vec2)>& is_blocked) {
  std::vector<glm::vec3> points;
  for (int z = -39; z <= 39; ++z) {
    for (int x = -39; x <= 39; ++x) points.emplace_back(0.1f * float(x) + 0.03f, 0, 0.1f * float(z) + 0.04f);
  }
  const std::vector<uint8_t> result = visibility(scene, light, points);
  size_t wrong = 0, blocked_points = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool expected = is_blocked({points[i].x, points[i].z});
    wrong += result[i] != (expected ? blocked : visible);
    blocked_points += expected;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(blocked_points, 0u) << "the rule blocks nothing: the test would show nothing";
  EXPECT_LT(blocked_points, points.size());
}

bool inside(glm::vec2 p, float half) { return std::abs(p.x) < half && std::abs(p.y) < half; }

TEST(ReferenceTracer, PointLightCastsTheQuadTwiceAsLarge) {
  expect_on_floor(floor_and_occluder(), point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2); });
}

TEST(ReferenceTracer, BothSidesBlock) {
  QuadScene scene = floor_and_occluder();
  std::swap(scene.scene.meshes[1].primitives[0].indices[1], scene.scene.meshes[1].primitives[0].indices[2]);
  std::swap(scene.scene.meshes[1].primitives[0].indices[4], scene.scene.meshes[1].primitives[0].indices[5]);
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2); });
}

TEST(ReferenceTracer, DirectionalLightCastsItAsLargeAsItIs) {
  reference::Light light;
  light.kind = LightKind::directional;
  light.direction = glm::normalize(glm::vec3(1, -1, 0));
  expect_on_floor(floor_and_occluder(), light, [](glm::vec2 p) { return inside(p - glm::vec2(1, 0), 1); });
}

TEST(ReferenceTracer, OccluderBehindTheLightCastsNothing) {
  const QuadScene scene = floor_and_occluder(3);
  EXPECT_EQ(visibility_at(scene, point_light({0, 2, 0}), {0, 0, 0}), visible);
}

TEST(ReferenceTracer, BlendedSurfacesDoNotBlockAndAreNotHit) {
  QuadScene scene = floor_and_occluder();
  scene.scene.materials[1].alpha_mode = AlphaMode::blend;
  EXPECT_EQ(visibility_at(scene, point_light({0, 2, 0}), {0, 0, 0}), visible);
  const std::vector<reference::Ray> rays{{{0.1f, 5, 0.2f}, -Y}};
  std::vector<reference::Hit> hits(1);
  trace(scene)->closest_hits(rays, reference::Faces::both, hits);
  EXPECT_EQ(hits[0].instance, 0u);
  EXPECT_FLOAT_EQ(hits[0].distance, 5);
}

/// The occluder masked by two texels, transparent and opaque, along +x.
QuadScene masked_scene() {
  QuadScene scene = floor_and_occluder();
  scene.scene.images.push_back({"two texels", 2, 1, {9, 9, 9, 0, 9, 9, 9, 255}});
  app::Material& material = scene.scene.materials[1];
  material.alpha_mode = AlphaMode::mask;
  material.base_color_texture.image = 0;
  material.base_color_texture.wrap_u = material.base_color_texture.wrap_v = app::Wrap::clamp;
  return scene;
}

// On the floor, twice as large: the texture's u = (x + 2) / 4.
TEST(ReferenceTracer, MaskIsFilteredLinearly) {
  QuadScene scene = masked_scene();
  scene.scene.materials[1].alpha_cutoff = 0.25f;  // alpha = 2 u − 0.5 between the texels' centres
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2) && p.x > 4 * 0.375f - 2; });
}

TEST(ReferenceTracer, NearestMaskHasOnlyWholeTexels) {
  QuadScene scene = masked_scene();
  scene.scene.materials[1].alpha_cutoff = 0.25f;
  scene.scene.materials[1].base_color_texture.nearest = true;
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2) && p.x > 0; });
}

TEST(ReferenceTracer, BaseColourAndVertexColourScaleTheMask) {
  QuadScene scene = masked_scene();
  scene.scene.materials[1].alpha_cutoff = 0.25f;
  scene.scene.materials[1].base_color.a = 0.5f;
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2) && p.x > 0; });
  scene.scene.materials[1].base_color.a = 1;
  scene.scene.meshes[1].primitives[0].colors.assign(4, {1, 1, 1, 0.5f});
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2) && p.x > 0; });
}

TEST(ReferenceTracer, MaskWithoutTextureUsesItsColour) {
  QuadScene scene = masked_scene();
  scene.scene.materials[1].base_color_texture.image = -1;
  scene.scene.materials[1].base_color.a = 0.6f;
  EXPECT_EQ(visibility_at(scene, point_light({0, 2, 0}), {0.1f, 0, 0.2f}), blocked);
  scene.scene.materials[1].base_color.a = 0.4f;
  EXPECT_EQ(visibility_at(scene, point_light({0, 2, 0}), {0.1f, 0, 0.2f}), visible);
}

TEST(ReferenceTracer, TextureTransformAndRepeatMoveTheMask) {
  QuadScene scene = masked_scene();
  app::Texture& texture = scene.scene.materials[1].base_color_texture;
  texture.nearest = true;
  texture.wrap_u = app::Wrap::repeat;
  texture.uv_transform = glm::mat3x2(2, 0, 0, 1, 1.5f, 0);  // u' = 2 u + 1.5: opaque where fract(u') ≥ 0.5
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) {
    const float u = 2 * ((p.x + 2) / 4) + 1.5f;
    return inside(p, 2) && u - std::floor(u) >= 0.5f;
  });
}

TEST(ReferenceTracer, MirrorWrapTurnsEveryOtherRepetition) {
  QuadScene scene = masked_scene();
  app::Texture& texture = scene.scene.materials[1].base_color_texture;
  texture.nearest = true;
  texture.wrap_u = app::Wrap::mirror;
  texture.uv_transform = glm::mat3x2(2, 0, 0, 1, -2, 0);  // u' from −2 to 0: texels 0 1 1 0
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2) && std::abs(p.x) < 1; });
}

/// A floor and two instances of a triangle that covers (0…1, 0…1) below its diagonal, at height 1, the second mirrored in x.
QuadScene mirrored_scene() {
  QuadScene scene;
  scene.add(quad({0, 0, 0}, 10.0f * Z, 10.0f * X));
  app::Primitive triangle;
  triangle.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};  // faces +y
  triangle.normals.assign(3, Y);
  triangle.indices = {0, 1, 2};
  scene.add(triangle, glm::translate(glm::mat4(1), Y));
  scene.add_instance(1, glm::scale(glm::translate(glm::mat4(1), Y), glm::vec3(-1, 1, 1)));
  return scene;
}

TEST(ReferenceTracer, MirroredInstanceCastsMirrored) {
  expect_on_floor(mirrored_scene(), point_light({0, 2, 0}), [](glm::vec2 p) {
    return p.y > 0 && std::abs(p.x) + p.y < 2;  // both triangles together, twice as large
  });
}

TEST(ReferenceTracer, MirroringKeepsTheFrontTheFront) {
  const QuadScene scene = mirrored_scene();
  const std::vector<reference::Ray> rays{{{0.2f, 5, 0.2f}, -Y}, {{-0.2f, 5, 0.2f}, -Y}, {{-0.2f, 0.5f, 0.2f}, Y}};
  std::vector<reference::Hit> hits(3);
  const auto tracer = trace(scene);
  tracer->closest_hits(rays, reference::Faces::as_drawn, hits);
  EXPECT_EQ(hits[0].instance, 1u);
  EXPECT_EQ(hits[1].instance, 2u);
  EXPECT_FALSE(std::isfinite(hits[2].distance)) << "its back is not drawn";
  tracer->closest_hits(rays, reference::Faces::both, hits);
  EXPECT_EQ(hits[2].instance, 2u);
  EXPECT_NEAR(glm::distance(hits[2].normal, -Y), 0, 1e-6f) << "towards the ray's origin";
}

TEST(ReferenceTracer, FlattenedInstanceStillBlocks) {
  QuadScene scene;
  scene.add(quad({0, 0, 0}, 10.0f * Z, 10.0f * X));
  app::Primitive tilted = quad({0, 5, 0}, X + Y, -Z);
  scene.add(tilted, glm::scale(glm::translate(glm::mat4(1), Y), glm::vec3(1, 0, 1)));
  expect_on_floor(scene, point_light({0, 2, 0}), [](glm::vec2 p) { return inside(p, 2); });
}

TEST(ReferenceTracer, MorphedInstanceBlocksWhereItIsNow) {
  QuadScene scene = floor_and_occluder();
  scene.scene.meshes[1].primitives[0].targets.push_back({std::vector<glm::vec3>(4, glm::vec3(4, 0, 0)), {}});
  scene.add_instance(1, glm::mat4(1));
  scene.pose.instances[1].weights = {0.5f};
  scene.pose.instances[2].weights = {-0.5f};
  const std::vector<uint8_t> result = visibility(scene, point_light({0, 2, 0}), {{4, 0, 0}, {0.1f, 0, 0}, {-4, 0, 0}});
  EXPECT_EQ(result, (std::vector<uint8_t>{blocked, visible, blocked}));
}

/// Visibility from `receiver` to a light at the origin with near = 1 m past a small quad around `occluder`.
uint8_t past_occluder(reference::Light light, glm::vec3 occluder, float scale_to_receiver) {
  QuadScene scene;
  const glm::vec3 side = glm::normalize(glm::cross(occluder, glm::vec3(0.3f, 0.2f, 0.9f)));
  scene.add(quad(occluder, 0.05f * side, 0.05f * glm::normalize(glm::cross(occluder, side))));
  scene.add(quad({0, -20, 0}, Z, X));  // gives the scene a size
  light.near = 1;
  return visibility(scene, light, {scale_to_receiver * occluder}, -glm::normalize(occluder)).front();
}

TEST(ReferenceTracer, NothingInsideTheNearCubeBlocks) {
  const reference::Light light = point_light({0, 0, 0});
  EXPECT_EQ(past_occluder(light, {0, -0.98f, 0}, 4), visible);
  EXPECT_EQ(past_occluder(light, {0, -1.02f, 0}, 4), blocked);
  EXPECT_EQ(past_occluder(light, {0.9f, -0.9f, 0.1f}, 4), visible) << "1.28 m away, but inside the cube of 1 m";
  EXPECT_EQ(past_occluder(light, {1.1f, -1.1f, 0.1f}, 4), blocked);
}

TEST(ReferenceTracer, NearPlaneOfANarrowSpotIsFlat) {
  reference::Light light = point_light({0, 0, 0});
  light.kind = LightKind::spot;
  light.direction = -Y;
  light.outer_cone = glm::radians(60.0f);
  const glm::vec3 aside(1.3f, -0.85f, 0), deeper(1.3f, -1.15f, 0);
  EXPECT_EQ(past_occluder(light, aside, 4), visible) << "0.85 m deep";
  EXPECT_EQ(past_occluder(light, deeper, 4), blocked) << "1.15 m deep";
  light.outer_cone = glm::radians(70.0f);
  EXPECT_EQ(past_occluder(light, aside, 4), blocked) << "drawn as a cube: 1.3 m counts";
}

TEST(ReferenceTracer, ReceiverInsideTheNearCubeIsVisible) {
  EXPECT_EQ(past_occluder(point_light({0, 0, 0}), {0, -0.5f, 0}, 1.5f), visible);
}

TEST(ReferenceTracer, OnlyEvaluatedPixelsAreTraced) {
  const QuadScene scene = floor_and_occluder();
  const float nan = std::nanf("");
  const std::vector<float> positions{0.1f, 0, 0, 0.1f, 0, 0, nan, nan, nan, 3, 0, 0};
  const std::vector<float> normals{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
  const std::vector<uint8_t> evaluated{254, not_evaluated, 0, 0};
  std::vector<uint8_t> result(4, 77);
  trace(scene)->visibility(point_light({0, 2, 0}), {2, 2, positions, normals}, evaluated, result);
  EXPECT_EQ(result, (std::vector<uint8_t>{blocked, not_evaluated, not_evaluated, visible}));
}

TEST(ReferenceTracer, GbufferShowsPositionsAndNormalsTowardsTheCamera) {
  const QuadScene scene = floor_and_occluder();
  const glm::mat4 world_from_camera = glm::inverse(glm::lookAt(glm::vec3(3, 4, 5), glm::vec3(0), Y));
  const auto gbuffer = reference::trace_gbuffer(*trace(scene), app::Camera{}, world_from_camera, 64, 48);
  size_t on_floor = 0, on_occluder = 0, nothing = 0;
  for (size_t i = 0; i < 64 * 48; ++i) {
    const glm::vec3 p(gbuffer.positions[3 * i], gbuffer.positions[3 * i + 1], gbuffer.positions[3 * i + 2]);
    const glm::vec3 n(gbuffer.normals[3 * i], gbuffer.normals[3 * i + 1], gbuffer.normals[3 * i + 2]);
    if (std::isnan(p.x)) {
      ++nothing;
      continue;
    }
    EXPECT_NEAR(glm::distance(n, Y), 0, 1e-6f);
    const bool is_floor = p.y < 0.5f;
    EXPECT_NEAR(p.y, is_floor ? 0 : 1, 1e-5f);
    ++(is_floor ? on_floor : on_occluder);
    EXPECT_LE(std::abs(p.x), 10.0001f);
  }
  EXPECT_GT(on_floor, 1000u);
  EXPECT_GT(on_occluder, 50u);
  const auto sky = reference::trace_gbuffer(
      *trace(scene), app::Camera{}, glm::inverse(glm::lookAt(glm::vec3(0, -1, 0), glm::vec3(0, -2, 0), X)), 8, 8);
  for (const float value : sky.positions) EXPECT_TRUE(std::isnan(value));
}

TEST(ReferenceTracer, CentreOfThePictureLooksAlongMinusZ) {
  app::Camera lens;
  const auto rays = reference::camera_rays(lens, glm::mat4(1), 3, 3);
  EXPECT_NEAR(glm::distance(rays[4].direction, -Z), 0, 1e-6f);
  EXPECT_GT(rays[1].direction.y, 0) << "row 0 is at the top";
  EXPECT_NEAR(rays[1].direction.y, std::tan(0.5f * lens.fov_y) * 2 / 3, 1e-6f);
  lens.orthographic = true;
  lens.half_width = 3;
  EXPECT_NEAR(reference::camera_rays(lens, glm::mat4(1), 3, 3)[5].origin.x, 2, 1e-6f);
}

TEST(ReferenceTracer, EmptySceneLightsEverything) {
  const QuadScene scene;
  EXPECT_EQ(trace(scene)->diagonal(), 0);
  EXPECT_EQ(visibility_at(scene, point_light({0, 2, 0}), {0, 0, 0}), visible);
}

TEST(ReferenceTracer, MissingModuleIsAnErrorThatNamesIt) {
  const QuadScene scene;
  const auto tracer = reference::load_ray_tracer(scene.scene, scene.pose, "/nowhere/libumbrage_reference.so");
  ASSERT_FALSE(tracer);
  EXPECT_NE(tracer.error().message.find("/nowhere/libumbrage_reference.so"), std::string::npos);
}

TEST(ReferenceTracer, IndicesThatLeadNowhereAreRefused) {
  QuadScene scene = floor_and_occluder();
  scene.scene.meshes[1].primitives[0].indices[4] = 4;
  EXPECT_FALSE(reference::load_ray_tracer(scene.scene, scene.pose, UMBRAGE_REFERENCE_MODULE));
  scene = floor_and_occluder();
  scene.scene.meshes[1].primitives[0].material = 2;
  EXPECT_FALSE(reference::load_ray_tracer(scene.scene, scene.pose, UMBRAGE_REFERENCE_MODULE));
  scene = masked_scene();
  scene.scene.images[0].rgba.pop_back();
  EXPECT_FALSE(reference::load_ray_tracer(scene.scene, scene.pose, UMBRAGE_REFERENCE_MODULE));
}

}  // namespace
