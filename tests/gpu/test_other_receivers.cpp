// Points that no depth buffer saw (fog, glass, particles) are answered by the whole maps of the lights: against rays cast at
// every triangle.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <set>

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

const std::vector<Aabb> kBoxes{{{-8, 0.5f, -7}, {-3, 2, -1}},
                               {{2, 1, 1}, {2.5f, 4, 8}},
                               {{-1, 2.5f, 4}, {1, 2.5f, 6}},
                               {{4, 3, -6}, {7, 4.8f, -4}}};

/// Is a point within reach of a light and its cone?
bool reaches(const LightDesc& light, const glm::vec3& p) {
  if (light.type == LightType::directional) return true;
  const glm::vec3 to_light = to_glm(light.position) - p;
  if (glm::length(to_light) > light.range_m) return false;
  return light.type == LightType::point ||
         glm::dot(glm::normalize(-to_light), glm::normalize(to_glm(light.direction))) >= std::cos(light.outer_cone_rad);
}

/// Points in boxes, seen from the side of the lights that reach them.
std::vector<Point> points_in(std::span<const Aabb> boxes, const TestScene& scene, uint32_t count) {
  std::mt19937 engine(55);
  std::uniform_real_distribution<float> part(0, 1);
  std::vector<Point> points;
  for (uint32_t tried = 0; tried < count; ++tried) {
    const Aabb& box = boxes[tried % boxes.size()];
    const glm::vec3 p = glm::mix(to_glm(box.min), to_glm(box.max), glm::vec3(part(engine), part(engine), part(engine)));
    for (uint32_t light = 0; light < scene.lights.size(); ++light) {
      const LightDesc& desc = scene.lights[light];
      if (!reaches(desc, p)) continue;
      const bool sun = desc.type == LightType::directional;
      points.push_back({p, glm::normalize(sun ? -to_glm(desc.direction) : to_glm(desc.position) - p), light});
    }
  }
  return points;
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
    if (!reaches(light, p)) continue;
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

/// Lights that only such points need have maps, but no cluster.
void expect_visible_in_clusters(PairRig& rig) {
  const DeviceClusters clusters(rig);
  std::set<uint32_t> held;
  for (uint32_t c = 0; c < clusters.cells.size(); ++c)
    for (const uint32_t slot : clusters.lights_of(c)) held.insert(slot);
  EXPECT_EQ(rig.system().statistics().lights_visible, held.size());
  EXPECT_GT(held.size(), 0u);
  EXPECT_LT(held.size(), rig.light_ids.size());
}

TEST_F(OtherReceivers, HaveAWholeMapOfEveryLight) {
  const SeenScene scene = fog_scene();
  PairRig rig(gpu(), {}, scene);
  rig.settle();
  expect_visible_in_clusters(rig);
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

/// What lights say of points is the same to the last bit as with whole maps, whatever the store; what the depth buffer shows
/// likewise; and there is less to draw.
TEST_F(OtherReceivers, InBoxesAreAnsweredAsAnywhere) {
  const SeenScene scene = fog_scene();
  const std::vector<Point> points = points_in(kBoxes, scene.scene, 800);
  ASSERT_GT(points.size(), 2000u);
  for (const Store store : {Store::page_pool, Store::physical_pool, Store::hardware_sparse, Store::fixed_cubes}) {
    for (const FrameSettings& settings :
         {FrameSettings{},
          FrameSettings{.layout = MapLayout::exact, .caster_culling = CasterCulling::projection_map_depth},
          FrameSettings{.receiver_boxes = ReceiverBoxes::clusters}}) {
      if (store == Store::fixed_cubes && settings.layout == MapLayout::exact) continue;
      SCOPED_TRACE("store " + std::to_string(static_cast<int>(store)));
      PairRig rig(gpu(), {.store = store}, scene);
      const Pairs seen = rig.settle(settings);
      const std::vector<float> anywhere = visibility_at(rig, settings, points);
      const Statistics all = rig.system().statistics();
      rig.camera().other_receivers_ws = kBoxes;
      const Pairs seen_beside = rig.settle(settings);
      const std::vector<float> in_boxes = visibility_at(rig, settings, points);
      const Statistics some = rig.system().statistics();
      EXPECT_EQ(differences(seen, seen_beside), 0u);
      size_t different = 0, dark = 0;
      for (size_t i = 0; i < points.size(); ++i) different += anywhere[i] != in_boxes[i], dark += in_boxes[i] < 0.5f;
      EXPECT_EQ(different, 0u) << "of " << points.size();
      EXPECT_GT(dark, points.size() / 50);
      EXPECT_LT(dark, points.size() - points.size() / 50);
      if (store == Store::fixed_cubes) continue;
      EXPECT_EQ(some.unbacked_taps, 0u);
      EXPECT_EQ(some.unmarked_taps, all.unmarked_taps);
      EXPECT_LT(some.triangles_drawn, all.triangles_drawn * 19 / 20);
      EXPECT_LT(some.shadow_maps, all.shadow_maps);
      if (store == Store::page_pool) { EXPECT_LT(some.texels_allocated, all.texels_allocated); }
    }
  }
}

TEST_F(OtherReceivers, InBoxesHaveMapsOfTheLightsThatReachThem) {
  const SeenScene scene = fog_scene();
  PairRig rig(gpu(), {}, scene);
  rig.camera().other_receivers_ws = kBoxes;
  rig.settle();
  std::vector<bool> reached(scene.scene.lights.size());
  for (const Point& point : points_in(kBoxes, scene.scene, 4000)) reached[point.light] = true;
  expect_visible_in_clusters(rig);
  const DeviceMaps maps(rig);
  uint32_t with = 0, without = 0, marked = 0, all = 0;
  for (uint32_t i = 0; i < scene.scene.lights.size(); ++i) {
    const LightDesc& light = scene.scene.lights[i];
    const shared::LightMaps& own = maps.light_maps[slot_of(rig.light_ids[i])];
    if (reached[i]) { EXPECT_NE(own.whole, shared::NoIndex) << "light " << i; }
    const bool far = std::none_of(kBoxes.begin(), kBoxes.end(), [&](const Aabb& box) {
      const glm::vec3 p = to_glm(light.position), nearest = glm::clamp(p, to_glm(box.min), to_glm(box.max));
      return light.type == LightType::directional || glm::distance(p, nearest) < light.range_m * 1.001f;
    });
    if (far) { EXPECT_EQ(own.whole, shared::NoIndex) << "light " << i; }
    ++(own.whole == shared::NoIndex ? without : with);
    if (own.whole == shared::NoIndex) continue;
    const shared::MapRecord& map = maps.maps[own.whole];
    EXPECT_EQ(map.receivers, shared::ReceiversInBoxes);
    EXPECT_EQ(own.whole, own.first + own.count - 1);
    for (uint32_t view = 0; view < map.view_count; ++view) {
      uint32_t pages = 0;
      for (uint32_t word = 0; word < map.words; ++word)
        pages += static_cast<uint32_t>(std::popcount(maps.page_bits[map.first_word + view * map.words + word]));
      EXPECT_EQ(pages != 0, (map.faces >> view & 1) != 0) << "light " << i << ", view " << view;
      marked += pages, all += map.pages * map.pages;
    }
  }
  EXPECT_GT(with, 3u);
  EXPECT_GT(without, 3u);
  EXPECT_GT(marked, 0u);
  EXPECT_LT(marked, all * 3 / 4);
}

/// Nothing in sight, so that lights which reach no box have no map at all.
TEST_F(OtherReceivers, BesideTheBoxesAreLit) {
  SeenScene scene = fog_scene();
  scene.seen = picture(scene.camera, [](const glm::vec3&, const glm::vec3&) { return std::nullopt; });
  PairRig rig(gpu(), {}, scene);
  rig.camera().other_receivers_ws = kBoxes;
  rig.settle();
  const DeviceMaps maps(rig);
  std::vector<Point> points;
  for (const Point& point : fog_points(scene.scene, 3000))
    if (maps.light_maps[slot_of(rig.light_ids[point.light])].count == 0) points.push_back(point);
  ASSERT_GT(points.size(), 100u);
  const std::vector<float> visibility = visibility_at(rig, {}, points);
  EXPECT_EQ(static_cast<size_t>(std::count(visibility.begin(), visibility.end(), 1.0f)), points.size());
}

/// A wall through a box, with lights behind it: that side faces away from them, and beside the box no map holds it.
TEST_F(OtherReceivers, BesideTheBoxesLeaveDarkWhatFacesAway) {
  SeenScene scene = fog_scene();
  scene.scene.lights = {{.type = LightType::directional, .direction = {0.4f, -1, 1.5f}, .host_index = 0},
                        {.position = {0, 6, -40}, .range_m = 80, .host_index = 1}};
  scene.seen = picture(scene.camera, [](const glm::vec3& origin, const glm::vec3& direction) -> std::optional<Surface> {
    if (direction.z >= 0) return std::nullopt;
    return Surface{(-2 - origin.z) / direction.z, {0, 0, 1}};
  });
  PairRig rig(gpu(), {}, scene);
  rig.camera().other_receivers_ws = kBoxes;
  rig.settle();
  const DeviceMaps maps(rig);
  for (const uint32_t map : maps.pair_maps) ASSERT_EQ(map, shared::NoIndex);
  Receivers behind = scene.seen;
  for (glm::vec4& normal : behind.normals) normal = -normal;
  const Pairs in_boxes = rig.evaluate({}, rig.camera().id, behind);  // none of what it counts is unbacked
  EXPECT_GT(in_boxes.statistics.unmarked_taps, 0u);
  rig.camera().other_receivers_ws = {};
  rig.settle();
  const Pairs anywhere = rig.evaluate({}, rig.camera().id, behind);
  size_t beside = 0;
  for (size_t i = 0; i < in_boxes.visibility.size(); ++i)
    beside += in_boxes.visibility[i] == 0 && anywhere.visibility[i] == 1;
  EXPECT_GT(beside, 100u);
}

TEST_F(OtherReceivers, InBoxesStayBackedWhenThePoolIsShort) {
  SeenScene scene = balls_scene(10, 300, 53, 48, 32);
  const std::vector<Aabb> boxes{{{-10, 1.9f, -10}, {10, 2.1f, 10}}};
  scene.camera.other_receivers = true, scene.camera.other_receivers_ws = boxes;
  PairRig rig(gpu(), {.budget_mib = 4}, scene);
  rig.settle();
  const std::vector<Point> points = points_in(boxes, scene.scene, 300);
  const std::vector<float> visibility = visibility_at(rig, {}, points);
  EXPECT_EQ(rig.system().statistics().unbacked_taps, 0u);
  EXPECT_GT(rig.system().statistics().unmarked_taps, 0u);
  EXPECT_FALSE(rig.system().degraded_lights().empty());
  EXPECT_EQ(visibility, visibility_at(rig, {}, points));
}

/// Many boxes do not fit what few took; those of a frame are forgotten in the next.
TEST_F(OtherReceivers, InBoxesComeAndGo) {
  const SeenScene scene = fog_scene();
  PairRig rig(gpu(), {}, scene);
  std::vector<Aabb> many;
  for (int i = 0; i < 3000; ++i) {
    const float at = static_cast<float>(i) * 0.005f - 8;
    many.push_back({{at, 1, -at}, {at + 0.01f, 1.5f, 0.01f - at}});
  }
  const std::vector<Point> points = points_in(many, scene.scene, 500);
  rig.settle();
  const std::vector<float> anywhere = visibility_at(rig, {}, points);
  for (const std::span<const Aabb> boxes : {std::span<const Aabb>(kBoxes), std::span<const Aabb>(many)}) {
    rig.camera().other_receivers_ws = boxes;
    rig.settle();
    visibility_at(rig, {}, points);
    EXPECT_EQ(rig.system().statistics().unbacked_taps == 0, boxes.size() == many.size());
  }
  EXPECT_EQ(visibility_at(rig, {}, points), anywhere);
  rig.camera().other_receivers = false;
  rig.frame();
  for (const shared::LightMaps& own : DeviceMaps(rig).light_maps) EXPECT_EQ(own.whole, shared::NoIndex);
}

TEST_F(OtherReceivers, OfSeveralCamerasAreTakenTogether) {
  const SeenScene scene = fog_scene();
  const std::vector<Point> points = points_in(kBoxes, scene.scene, 300);
  PairRig rig(gpu(), {}, scene);
  rig.settle();
  const std::vector<float> anywhere = visibility_at(rig, {}, points);
  rig.camera().other_receivers_ws = std::span(kBoxes).first(1);
  CameraDesc other = perspective_camera({9, 4, 8}, {0, 1, 0}, 64, 48);
  other.id = CameraId{2};
  other.other_receivers = true;
  other.other_receivers_ws = std::span(kBoxes).subspan(1);
  rig.show_also(other, picture(other, balls_on_ground));
  rig.settle();
  EXPECT_EQ(visibility_at(rig, {}, points), anywhere);
  EXPECT_EQ(rig.system().statistics().unbacked_taps, 0u);
  for (const shared::MapRecord& map : DeviceMaps(rig).maps) EXPECT_NE(map.receivers, shared::ReceiversAnywhere);
  // One that does not say where.
  other.id = CameraId{3};
  other.other_receivers_ws = {};
  rig.show_also(other, picture(other, balls_on_ground));
  rig.settle();
  const DeviceMaps maps(rig);
  for (const LightId id : rig.light_ids) {
    const shared::LightMaps& own = maps.light_maps[slot_of(id)];
    ASSERT_NE(own.whole, shared::NoIndex);
    EXPECT_EQ(maps.maps[own.whole].receivers, shared::ReceiversAnywhere);
  }
}

TEST_F(OtherReceivers, InUnsoundBoxesAreRefused) {
  const SeenScene scene = fog_scene();
  PairRig rig(gpu(), {}, scene);
  const Pairs before = rig.settle();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const Aabb& bad :
       {Aabb{{0, 1, 0}, {1, 0.5f, 1}}, Aabb{{kNan, 0, 0}, {1, 1, 1}}, Aabb{{0, 0, 0}, {1, 1, kInf}}}) {
    const std::vector<Aabb> boxes{kBoxes[0], bad};
    FrameDesc frame = rig.describe({});
    CameraDesc camera = frame.cameras[0];
    camera.other_receivers_ws = boxes;
    frame.cameras = {&camera, 1};
    const Result<void> begun = rig.system().begin_frame(frame);
    ASSERT_FALSE(begun.ok());
    EXPECT_EQ(begun.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(begun.error().message.find("CameraDesc::other_receivers_ws: box 1"), std::string::npos);
  }
  EXPECT_EQ(differences(before, rig.evaluate()), 0u);
}

}  // namespace
}  // namespace umbrage::test
