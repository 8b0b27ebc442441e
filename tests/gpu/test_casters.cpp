// Which batches go to which views: everything that a view needs, nothing outside the light's reach, each drawn once; the same
// picture however it is culled and in however many rounds; and the report when the rounds were too few.
#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "reference/caster_lists.hpp"
#include "reference/light_lists.hpp"
#include "system_rig.hpp"

namespace umbrage::test {
namespace {

class Casters : public GpuTest {};

/// The instances and draws of a frame that one round drew, read back.
struct DeviceDraws {
  shared::FrameCounters counters;
  std::vector<shared::CasterInstance> instances;
  std::vector<shared::DrawCommand> opaque, masked;
  std::vector<shared::CasterRecord> casters;
  std::vector<shared::Box> boxes;  // by caster
  std::vector<shared::BatchRecord> batches;
  std::vector<shared::LightRecord> lights;
  std::vector<shared::ShadowView> views;

  explicit DeviceDraws(SystemRig& rig) : counters(rig.counters()), lights(rig.lights()), views(rig.views()) {
    Gpu& gpu = rig.gpu();
    const culling::CasterCulling& culling = rig.stages().culling;
    const scene::GpuScene& scene = rig.stages().scene;
    const uint32_t slots = scene.caster_slots();
    instances =
        gpu.download<shared::CasterInstance>(culling.instances(), std::min(counters.caster_pairs, culling.capacity()));
    const auto counts = gpu.download<shared::DrawCounts>(culling.draw_counts(), 1)[0];
    opaque = gpu.download<shared::DrawCommand>(culling.commands(), counts.opaque);
    masked = gpu.download<shared::DrawCommand>(culling.commands(), counts.masked,
                                               culling.capacity() * sizeof(shared::DrawCommand));
    casters = gpu.download<shared::CasterRecord>(scene.caster_buffer(), slots);
    batches = gpu.download<shared::BatchRecord>(scene.batch_buffer(),
                                                scene.batch_buffer().size() / sizeof(shared::BatchRecord));
    const auto order = gpu.download<uint32_t>(scene.caster_tree().order(), slots);
    const auto leaves = gpu.download<shared::Box>(scene.caster_tree().leaves(), slots);
    boxes.resize(slots);
    for (uint32_t i = 0; i < slots; ++i) boxes[order[i]] = leaves[i];
  }
};

/// (caster, view).
using Drawn = std::set<std::pair<uint32_t, uint32_t>>;

reference::Light plain(const LightDesc& light, float more) {
  return {.kind = static_cast<app::LightKind>(light.type),
          .position = to_glm(light.position),
          .direction = glm::normalize(to_glm(light.direction)),
          .range = light.range_m * (1 + more),
          .near = light.near_m > 0 ? light.near_m : light.range_m / 256,
          .outer_cone = light.outer_cone_rad + 10 * more};
}

/// Views of a light that a box must be drawn to (more = 0), or may be (more > 0: everything a little larger).
uint32_t reference_views(const LightDesc& desc, const shared::LightRecord& record, const shared::Box& device_box,
                         CasterCulling mode, float more) {
  if (desc.type == LightType::directional) return 1;
  reference::Box box;
  const float grow = more * desc.range_m;
  box.min = device_box.lo - grow, box.max = device_box.hi + grow;
  const reference::Light light = plain(desc, more);
  if (!reference::range_meets(light, box) || !reference::cone_may_meet(light, box)) return 0;
  if (record.views != shared::ViewsCube) return 1;
  if (mode == CasterCulling::light_volume && more > 0) return 63;
  return reference::cube_face_mask(light.position, more > 0 ? 0 : light.near, box);
}

/// Every instance is drawn by exactly one command, with its own batch's triangles.
void expect_each_drawn_once(const DeviceDraws& draws) {
  std::vector<uint32_t> times(draws.instances.size());
  uint64_t triangles = 0;
  for (const auto* list : {&draws.opaque, &draws.masked}) {
    for (const shared::DrawCommand& command : *list) {
      ASSERT_LE(command.first_instance + command.instance_count, times.size());
      for (uint32_t i = 0; i < command.instance_count; ++i) {
        const shared::CasterInstance& instance = draws.instances[command.first_instance + i];
        const shared::BatchRecord& batch = draws.batches[instance.batch];
        ++times[command.first_instance + i];
        ASSERT_EQ(instance.batch, draws.casters[instance.caster].batch);
        ASSERT_EQ(command.first_index, batch.first_index);
        ASSERT_EQ(command.index_count, batch.index_count);
        ASSERT_EQ(batch.mask != shared::NoIndex, list == &draws.masked);
        triangles += batch.triangle_count;
      }
    }
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1u), std::ptrdiff_t(times.size()));
  EXPECT_EQ(draws.counters.batches_drawn_low, draws.instances.size());
  EXPECT_EQ(draws.counters.triangles_drawn_low, triangles);
  EXPECT_FALSE(draws.opaque.empty());
  EXPECT_FALSE(draws.masked.empty());
}

void expect_needed_and_no_more(SystemRig& rig, const TestScene& scene, const DeviceDraws& draws, CasterCulling mode) {
  Drawn drawn;
  for (const shared::CasterInstance& instance : draws.instances)
    ASSERT_TRUE(drawn.insert({instance.caster, instance.view}).second) << "drawn twice";
  std::map<uint32_t, const TestInstance*> instance_of_slot;
  for (uint32_t i = 0; i < scene.instances.size(); ++i)
    instance_of_slot[slot_of(rig.instance_ids[i])] = &scene.instances[i];
  uint64_t needed = 0;
  for (uint32_t l = 0; l < scene.lights.size(); ++l) {
    const shared::LightRecord& record = draws.lights[slot_of(rig.light_ids[l])];
    for (uint32_t c = 0; c < draws.casters.size(); ++c) {
      const TestInstance& instance = *instance_of_slot.at(draws.casters[c].instance);
      const bool lit = (instance.light_mask & scene.lights[l].light_mask) != 0;
      const uint32_t must = lit ? reference_views(scene.lights[l], record, draws.boxes[c], mode, 0) : 0;
      const uint32_t may = lit ? reference_views(scene.lights[l], record, draws.boxes[c], mode, 1e-3f) : 0;
      for (uint32_t v = 0; v < record.view_count; ++v) {
        const bool is_drawn = drawn.count({c, record.first_view + v}) != 0;
        ASSERT_TRUE(is_drawn || !(must >> v & 1))
            << "light " << l << ", caster " << c << ", view " << v << " is missing";
        ASSERT_TRUE(!is_drawn || (may >> v & 1))
            << "light " << l << ", caster " << c << ", view " << v << " is not needed";
        needed += must >> v & 1;
      }
    }
  }
  EXPECT_GT(needed, 500u);
}

TEST_F(Casters, AreThoseThatTheViewsNeed) {
  const TestScene scene = mixed_scene(240, 40, 21);
  SystemRig rig(gpu(), {.budget_mib = 16});
  rig.add(scene);
  rig.show_nothing();
  std::vector<Atlas> atlases;
  std::vector<uint64_t> drawn;
  for (const CasterCulling mode : {CasterCulling::light_volume, CasterCulling::view_mask}) {
    rig.frame({.caster_culling = mode, .max_resolution = 64});
    const DeviceDraws draws(rig);
    ASSERT_EQ(draws.instances.size(), draws.counters.caster_pairs) << "one round";
    expect_each_drawn_once(draws);
    expect_needed_and_no_more(rig, scene, draws, mode);
    EXPECT_EQ(rig.system().statistics().caster_pairs, draws.instances.size());
    drawn.push_back(draws.instances.size());
    atlases.push_back(rig.atlas());
  }
  EXPECT_LT(drawn[1], drawn[0]);
  EXPECT_EQ(std::memcmp(atlases[0].depth.data(), atlases[1].depth.data(), atlases[0].depth.size() * sizeof(float)), 0);
}

TEST_F(Casters, OfUnusedLightsAreNotDrawn) {
  TestScene scene = mixed_scene(60, 12, 2);
  for (LightDesc& light : scene.lights) light.type = LightType::point, light.position.y = 30, light.range_m = 4;
  scene.lights[2].position = {0, 1, 2};
  scene.lights[2].casts_shadow = true;
  const CameraDesc camera = perspective_camera({0, 5, 16}, {0, 1, 0}, 96, 64);
  SystemRig rig(gpu(), {.budget_mib = 16});
  rig.add(scene);
  rig.show(camera, picture(camera, balls_on_ground));
  for (const Writer writer : {Writer::multi_draw, Writer::traditional}) {
    rig.frame({.writer = writer, .max_resolution = 64});
    EXPECT_EQ(rig.system().statistics().lights_visible, 1u);
    const Atlas atlas = rig.atlas();
    const auto lights = rig.lights();
    std::vector<uint32_t> texels(lights.size());
    for (uint32_t slot = 0; slot < lights.size(); ++slot) {
      for (uint32_t v = 0; v < lights[slot].view_count; ++v) {
        const glm::uvec2 tile =
            shared::atlas_tile(lights[slot].first_view + v, rig.stages().store.layout().columns, 64);
        for (uint32_t i = 0; i < 64 * 64; ++i) texels[slot] += atlas.at(tile.x + i % 64, tile.y + i / 64) != 0;
      }
      EXPECT_EQ(texels[slot] > 0, slot == slot_of(rig.light_ids[2])) << "slot " << slot;
    }
  }
}

TEST_F(Casters, InManyRoundsMakeTheSameDepth) {
  const TestScene scene = mixed_scene(240, 40, 21);
  std::vector<Atlas> atlases;
  for (const uint32_t at_once : {1u << 19, 1024u}) {
    SystemRig rig(gpu(), {.budget_mib = 16, .max_caster_pairs = at_once});
    rig.add(scene);
    rig.show_nothing();
    for (int frame = 0; frame < 2;
         ++frame) {  // the second knows how many pairs there are and has room for them in one round
      rig.frame({.max_resolution = 64});
      if (at_once == 1024 && frame == 0) {
        EXPECT_GT(rig.counters().caster_pairs, 2 * rig.stages().culling.capacity());
        EXPECT_GE(rig.state().plan.caster_rounds, 3u);
      } else {
        EXPECT_EQ(rig.state().plan.caster_rounds, 1u);
      }
      EXPECT_EQ(rig.counters().caster_pairs, rig.counters().batches_drawn_low);
      EXPECT_EQ(rig.system().statistics().overflows, 0u);
      EXPECT_TRUE(rig.system().degraded_lights().empty());
      atlases.push_back(rig.atlas());
    }
  }
  for (const Atlas& atlas : atlases)
    EXPECT_EQ(std::memcmp(atlases[0].depth.data(), atlas.depth.data(), atlas.depth.size() * sizeof(float)), 0);
}

/// Casters that are beyond all lights, and where they go all at once.
struct Arrival {
  TestScene scene = mixed_scene(240, 40, 33);
  std::vector<Affine> near;
  Arrival() {
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
      scene.lights[i] = {.position = scene.lights[i].position, .range_m = 7, .host_index = i};
    scene.lights[7].position = {0, 500, 0};  // reaches nothing, ever
    scene.lights[39].position = {0, -500, 0};
    for (TestInstance& instance : scene.instances) {
      near.push_back(instance.world_from_mesh);
      instance.mobility = Mobility::movable;
      instance.world_from_mesh.m[11] += 1000;
    }
  }
  /// The frame in which they arrive, and whose rounds are too few.
  void record(SystemRig& rig, const FrameSettings& settings) const {
    rig.add(scene);
    rig.show_nothing();
    rig.frame(settings);
    rig.frame(settings);
    ASSERT_EQ(rig.counters().caster_pairs, 0u);
    ASSERT_EQ(rig.state().plan.caster_rounds, 1u);
    take(rig.system().set_transforms(rig.instance_ids, near));
    rig.frame(settings);
    ASSERT_GT(rig.counters().caster_pairs, rig.counters().pair_limit);
  }
};

TEST_F(Casters, BeyondTheRoundsAreReportedInTheirFrame) {
  Arrival arrival;
  SystemRig rig(gpu(), {.budget_mib = 16, .max_caster_pairs = 1024});
  const FrameSettings settings{.max_resolution = 64};
  ASSERT_NO_FATAL_FAILURE(arrival.record(rig, settings));
  const shared::FrameCounters counters = rig.counters();
  EXPECT_EQ(counters.batches_drawn_low, counters.pair_limit);
  EXPECT_EQ(rig.system().statistics().serial, 3u);
  EXPECT_EQ(rig.system().statistics().overflows, 1u);
  const auto degraded = rig.system().degraded_lights();
  EXPECT_EQ(rig.system().statistics().lights_degraded, degraded.size());
  EXPECT_GT(degraded.size(), 0u);
  std::set<uint32_t> reported;
  for (const LightStatus& status : degraded) {
    EXPECT_EQ(status.reason, Degradation::casters_missing);
    EXPECT_EQ(status.missing_bytes, (counters.caster_pairs - counters.pair_limit) * 152ull);  // as max_caster_pairs says
    EXPECT_TRUE(reported.insert(status.light.value).second) << "reported twice";
  }
  // Instances are numbered by light: those of the last lights are missing, except where there are none.
  EXPECT_FALSE(reported.count(rig.light_ids[7].value));
  EXPECT_FALSE(reported.count(rig.light_ids[39].value)) << "a light without casters lacks none";
  EXPECT_TRUE(reported.count(rig.light_ids[38].value));
  EXPECT_FALSE(reported.count(rig.light_ids[0].value));

  rig.frame(settings);
  EXPECT_EQ(rig.system().statistics().overflows, 0u);
  EXPECT_TRUE(rig.system().degraded_lights().empty());
  const Atlas cured = rig.atlas();
  SystemRig fresh(gpu(), {.budget_mib = 16});
  for (size_t i = 0; i < arrival.near.size(); ++i) arrival.scene.instances[i].world_from_mesh = arrival.near[i];
  fresh.add(arrival.scene);
  fresh.show_nothing();
  fresh.frame(settings);
  EXPECT_EQ(std::memcmp(fresh.atlas().depth.data(), cured.depth.data(), cured.depth.size() * sizeof(float)), 0);
}

TEST_F(Casters, OfVirtualMapsBeyondTheRoundsAreReportedInTheirFrame) {
  for (const Store store : {Store::page_pool, Store::physical_pool}) {
    SCOPED_TRACE("store " + std::to_string(static_cast<int>(store)));
    SystemRig rig(gpu(), {.budget_mib = 64, .max_caster_pairs = 1024}, store);
    ASSERT_NO_FATAL_FAILURE(Arrival().record(rig, {}));
    const shared::FrameCounters counters = rig.counters();
    EXPECT_EQ(rig.system().statistics().overflows, 1u);
    EXPECT_GT(rig.system().degraded_lights().size(), 0u);
    for (const LightStatus& status : rig.system().degraded_lights()) {
      EXPECT_EQ(status.reason, Degradation::casters_missing);
      EXPECT_EQ(status.missing_bytes, (counters.caster_pairs - counters.pair_limit) * 24ull);  // as max_caster_pairs says
    }
    rig.frame();
    EXPECT_EQ(rig.system().statistics().overflows, 0u);
    EXPECT_TRUE(rig.system().degraded_lights().empty());
  }
}

}  // namespace
}  // namespace umbrage::test
