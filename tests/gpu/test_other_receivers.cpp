// Points that no depth buffer saw (fog, glass, particles) are answered by the whole maps of the lights: against rays cast at
// every triangle.
#include <algorithm>
#include <cmath>
#include <random>

#include "map_rig.hpp"
#include "pair_rig.hpp"
#include "ray_answers.hpp"

namespace umbrage::test {
namespace {

class OtherReceivers : public GpuTest {};

constexpr uint32_t kEvaluate[] =
#include "shaders/evaluate_visibility.comp.inc"
    ;
constexpr double kWholeTexels = 128;

struct Point {
  glm::vec3 position, normal;
  uint32_t light;  // host_index
};

/// Width of a texel of a light's whole map at a point; suns: everywhere.
double whole_texel_m(const LightDesc& light, const glm::dvec3& p, double sun_side_m) {
  if (light.type == LightType::directional) return sun_side_m / kWholeTexels;
  const bool one_view = light.type == LightType::spot && light.outer_cone_rad < shared::OneViewMaxOuterRad;
  return 2 * (one_view ? 1.2 * std::tan(light.outer_cone_rad) : 1) *
         glm::distance(p, glm::dvec3(to_glm(light.position))) / kWholeTexels;
}

/// Opaque casters in the air, a ground, lights of every kind above.
SeenScene fog_scene() {
  SeenScene out = balls_scene(0, 0, 1, 64, 48);
  TestScene& scene = out.scene;
  scene.meshes = {sphere_mesh(6, 8), box_mesh(), plane_mesh(2)};
  std::mt19937 engine(51);
  std::uniform_real_distribution<float> place(-9, 9), height(1.5f, 4), size(0.8f, 1.6f);
  for (uint32_t i = 0; i < 14; ++i) {
    const glm::vec3 at(place(engine), height(engine), place(engine));
    scene.instances.push_back({.mesh = i % 2, .world_from_mesh = affine(glm::mat3(size(engine)), at)});
  }
  scene.instances.push_back({.mesh = 2, .world_from_mesh = affine(glm::mat3(12), {0, -0.5f, 0})});
  scene.lights = {{.position = {0, 7, 0}, .range_m = 14},
                  {.position = {-10, 3, 10}, .range_m = 25},
                  {.type = LightType::spot,
                   .position = {6, 8, 6},
                   .direction = {-0.6f, -1, -0.5f},
                   .range_m = 20,
                   .outer_cone_rad = 0.7f},
                  {.type = LightType::spot,
                   .position = {-6, 7, -6},
                   .direction = {0.1f, -1, 0.2f},
                   .range_m = 16,
                   .outer_cone_rad = 1.4f},
                  {.type = LightType::directional, .direction = {0.4f, -1, 0.2f}}};
  // Small ones in the air: no surface in sight is near enough for the lists of its cluster to name them.
  for (uint32_t i = 0; i < 15; ++i)
    scene.lights.push_back({.position = {place(engine), 4.5f, place(engine)}, .range_m = 1.5f});
  for (uint32_t i = 0; i < scene.lights.size(); ++i) scene.lights[i].host_index = i;
  out.camera.other_receivers = true;
  return out;
}

/// Points in the air that a light reaches, each seen from the light's side.
std::vector<Point> fog_points(const TestScene& scene, uint32_t count) {
  std::mt19937 engine(52);
  std::uniform_real_distribution<float> place(-10, 10), height(0, 5);
  std::vector<Point> points;
  while (points.size() < count) {
    const auto index = static_cast<uint32_t>(points.size() % scene.lights.size());
    const LightDesc& light = scene.lights[index];
    glm::vec3 p(place(engine), height(engine), place(engine));
    if (light.range_m < 2) p = to_glm(light.position) + p * (light.range_m / 10);
    const glm::vec3 direction = glm::normalize(to_glm(light.direction));
    const glm::vec3 to_light = light.type == LightType::directional ? -direction : to_glm(light.position) - p;
    if (light.type != LightType::directional && glm::length(to_light) > light.range_m) continue;
    if (light.type == LightType::spot &&
        glm::dot(glm::normalize(-to_light), direction) < std::cos(light.outer_cone_rad))
      continue;
    points.push_back({p, glm::normalize(to_light), index});
  }
  return points;
}

std::vector<float> visibility_at(SystemRig& rig, const FrameSettings& settings, const std::vector<Point>& points) {
  struct Push {
    VkDeviceAddress shadows, samples, answers;
    uint32_t count;
  };
  Gpu& gpu = rig.gpu();
  const gpu::Buffer input = gpu.upload(points),
                    output = gpu.buffer(points.size() * sizeof(float), gpu::MemoryKind::device, "visibility");
  const VkDescriptorSetLayout layout = rig.system().descriptor_set_layout();
  const Program program(gpu, kEvaluate, {&layout, 1});
  rig.frame(settings, [&](VkCommandBuffer commands) {
    const ShaderInterface shadows = rig.system().shader_interface(rig.camera().id);
    const auto count = static_cast<uint32_t>(points.size());
    program.dispatch(commands, shadows.set, Push{shadows.frame, input.address(), output.address(), count},
                     (count + 63) / 64);
  });
  return gpu.download<float>(output, points.size());
}

TEST_F(OtherReceivers, AreAnsweredAsByRaysWhateverTheDepthBufferSaw) {
  SeenScene scene = fog_scene();
  const std::vector<Point> points = fog_points(scene.scene, 6000);
  const std::vector<Triangle> triangles = triangles_of(scene.scene);
  const Receivers nothing = picture(scene.camera, [](const glm::vec3&, const glm::vec3&) { return std::nullopt; });
  PairRig rig(gpu(), {}, scene);
  rig.settle();
  std::vector<Answer> answers;
  for (const Point& point : points) {
    const LightDesc& light = scene.scene.lights[point.light];
    const double sun_side_m = rig.views()[rig.lights()[slot_of(rig.light_ids[point.light])].first_view].side_m;
    answers.push_back(answer_of(triangles, light, point.position, whole_texel_m(light, point.position, sun_side_m)));
  }
  for (const bool blank : {false, true}) {
    if (blank) rig.show(scene.camera, nothing);
    for (const FrameSettings& settings :
         {FrameSettings{}, FrameSettings{.cluster_bounds = ClusterBounds::implicit_cell, .layout = MapLayout::exact}}) {
      const std::vector<float> visibility = visibility_at(rig, settings, points);
      uint32_t lit = 0, dark = 0, wrong = 0, lost = 0;
      for (size_t i = 0; i < points.size(); ++i) {
        lost += visibility[i] < 0;
        if (answers[i] == Answer::open) continue;
        (answers[i] == Answer::lit ? lit : dark)++;
        wrong += (visibility[i] >= 0.5f) != (answers[i] == Answer::lit);
      }
      const Statistics& statistics = rig.system().statistics();
      EXPECT_EQ(lost, 0u) << "of " << points.size() << " points lack a light that reaches them";
      EXPECT_EQ(wrong, 0u) << "of " << lit << " lit and " << dark << " dark points";
      EXPECT_GT(lit, 500u);
      EXPECT_GT(dark, 100u);
      EXPECT_EQ(statistics.unbacked_taps, 0u);
      EXPECT_EQ(statistics.overflows, 0u);
      if (blank) {
        EXPECT_EQ(statistics.unmarked_taps, 9 * points.size());
      } else {
        EXPECT_GT(statistics.unmarked_taps, 0u);
      }
    }
  }
}

TEST_F(OtherReceivers, HaveAWholeMapOfEveryLight) {
  const SeenScene scene = fog_scene();
  PairRig rig(gpu(), {}, scene);
  rig.settle();
  const DeviceMaps maps(rig);
  for (uint32_t slot = 0; slot < maps.light_maps.size(); ++slot) {
    const shared::LightMaps& own = maps.light_maps[slot];
    ASSERT_NE(own.whole, shared::NoIndex);
    const shared::MapRecord& map = maps.maps[own.whole];
    EXPECT_EQ(own.whole, own.first + own.count - 1);
    EXPECT_EQ(map.resolution, kWholeTexels);
    EXPECT_EQ(map.faces, (1u << map.view_count) - 1);
    for (uint32_t word = 0; word < map.view_count * map.words; ++word)
      EXPECT_EQ(maps.page_bits[map.first_word + word], 0xffffu) << "sixteen pages a view";
  }
}

/// As many points as there are, a pool that is too small: coarser, and still backed.
TEST_F(OtherReceivers, StayBackedWhenThePoolIsShort) {
  SeenScene scene = balls_scene(10, 300, 53, 48, 32);
  scene.camera.other_receivers = true;
  PairRig rig(gpu(), {.budget_mib = 4}, scene);
  rig.settle();
  std::vector<Point> points;
  std::mt19937 engine(54);
  std::uniform_real_distribution<float> place(-10, 10);
  for (uint32_t i = 0; i < 3000; ++i) points.push_back({{place(engine), 2, place(engine)}, {0, 1, 0}, i % 300});
  const std::vector<float> visibility = visibility_at(rig, {}, points);
  EXPECT_EQ(rig.system().statistics().unbacked_taps, 0u);
  EXPECT_GT(rig.system().statistics().unmarked_taps, 0u);
  EXPECT_FALSE(rig.system().degraded_lights().empty());
  const DeviceMaps maps(rig);
  for (const shared::LightMaps& own : maps.light_maps)
    if (own.whole != shared::NoIndex) { EXPECT_LE(maps.maps[own.whole].resolution, std::max(128u >> own.shift, 4u)); }
  EXPECT_EQ(visibility, visibility_at(rig, {}, points));
}

}  // namespace
}  // namespace umbrage::test
