// Which batches go to which views of which maps: those of the reference in every variant and of its level of detail, fewer from
// variant to variant, never fewer than what shadows a receiver, the same in however many rounds; and the report when the rounds
// were too few.
#include <algorithm>
#include <random>

#include "gpu/hazards.hpp"
#include "map_rig.hpp"
#include "reference/light_lists.hpp"

namespace umbrage::test {
namespace {

/// Pipelines are made once: each is a shader to compile.
class MapCasters : public GpuTest {
 protected:
  static culling::MapCulling& culling(uint32_t node_test = shared::NodesByView) {
    auto& made = culling_[node_test];
    if (!made)
      made = std::make_unique<culling::MapCulling>(take(culling::MapCulling::create(gpu().factory(), node_test)));
    return *made;
  }
  static void TearDownTestSuite() {
    culling_.clear();
    GpuTest::TearDownTestSuite();
  }

 private:
  inline static std::map<uint32_t, std::unique_ptr<culling::MapCulling>> culling_;
};

constexpr CasterCulling kModes[] = {CasterCulling::light_volume, CasterCulling::view_mask,
                                    CasterCulling::projection_map, CasterCulling::projection_map_depth,
                                    CasterCulling::receiver_grid};

/// mixed_scene and what is awkward about boxes and lights.
TestScene awkward_scene() {
  TestScene scene = mixed_scene(240, 40, 21);
  const auto add = [&](uint32_t mesh, const glm::vec3& at, const glm::vec3& half) {
    scene.instances.push_back(
        {.mesh = mesh, .world_from_mesh = affine(glm::mat3(half.x, 0, 0, 0, half.y, 0, 0, 0, half.z), at)});
  };
  const glm::vec3 light = to_glm(scene.lights[2].position), other = to_glm(scene.lights[9].position),
                  spot = to_glm(scene.lights[3].position);
  add(1, light, glm::vec3(0.3f));                                  // the light inside
  add(1, other + glm::vec3(0.5f), glm::vec3(0.2f));                // over three faces
  add(1, other - glm::vec3(0.25f), glm::vec3(0.25f));              // the light on a corner
  add(1, other + glm::vec3(0, 0.5f, 0), {0.5f, 0.1f, 0.5f});       // its edges on the borders between faces
  add(0, glm::vec3(0), glm::vec3(300));                            // huge
  add(1, spot, glm::vec3(1e-3f));                                  // tiny, at the tip of a cone
  add(2, light - glm::vec3(0, 0.4f, 0), glm::vec3(2));             // flat
  add(1, {200, 200, 200}, glm::vec3(1));                           // far from everything
  add(1, light + glm::vec3(0.1f, 0.2f, 0.3f), glm::vec3(1e-20f));  // a point
  return scene;
}

/// Up to three maps a light, one of them whole for some, with receivers in clumps: some views have many, some have none.
MapTables random_maps(SystemRig& rig, const CasterTables& casters, uint32_t grid, uint32_t seed,
                      uint32_t resolution = 256) {
  MapTables tables(grid);
  std::mt19937 engine(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit(0, 1);
  const std::vector<shared::LightRecord> lights = rig.lights();
  for (uint32_t slot = 0; slot < lights.size(); ++slot) {
    const shared::LightRecord& light = lights[slot];
    if (light.type == shared::NoIndex || light.view_count == 0) continue;
    for (uint32_t i = 0; i < slot % 4; ++i) {
      tables.add(light, slot, i == 2, casters.all, resolution);
      for (uint32_t clump = 0; clump < slot % 5; ++clump) {
        const glm::vec3 centre =
            light.views == shared::ViewsOrtho
                ? glm::vec3(10 * normal(engine), 2 * unit(engine), 10 * normal(engine))
                : light.position_ws + glm::normalize(glm::vec3(normal(engine), normal(engine), normal(engine))) *
                                          light.range_m * unit(engine);
        for (int point = 0; point < 40; ++point)
          tables.see(centre + 0.4f * glm::vec3(normal(engine), normal(engine), normal(engine)));
      }
    }
  }
  return tables;
}

bool is_lit(const CasterTables& casters, uint32_t caster, uint32_t light_mask) {
  const uint32_t instance = casters.casters[caster].instance;
  return instance != shared::NoIndex && (casters.instances[instance].light_mask & light_mask) != 0;
}

enum class Allow : uint8_t { nothing, rounding };

/// Views that the reference has a batch drawn to; or that it may be drawn to, when everything is a little larger.
uint32_t reference_views(const shared::LightRecord& light, const reference::CasterMap& map, const shared::Box& box,
                         CasterCulling mode, Allow allow) {
  const float more = allow == Allow::rounding ? 2e-4f : 0;
  const reference::Box plain{.min = box.lo, .max = box.hi};
  const reference::Light volume{.kind = static_cast<app::LightKind>(light.type),
                                .position = light.position_ws,
                                .direction = light.direction_ws,
                                .range = light.range_m * (1 + more),
                                .outer_cone = light.outer_cone_rad + 10 * more};
  if (plain.empty() || !reference::range_meets(volume, plain) || !reference::cone_may_meet(volume, plain)) return 0;
  return reference::views_to_draw(map, plain, static_cast<reference::CasterTest>(mode),
                                  allow == Allow::rounding ? 2e-5 : 0);
}

/// What the reference knows of an instance.
struct PlainInstance {
  reference::Box box;            // world space
  double stretch = 1;            // of world_from_mesh, whose axes stay at right angles
  std::vector<double> errors_m;  // mesh space, of its levels of detail
};

/// By slot.
std::vector<PlainInstance> plain_instances(const SystemRig& rig, const TestScene& scene) {
  std::vector<PlainInstance> all(scene.instances.size());
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const TestMesh& mesh = scene.meshes[scene.instances[i].mesh];
    const Affine& world_from_mesh = scene.instances[i].world_from_mesh;
    PlainInstance& plain = all[slot_of(rig.instance_ids[i])];
    reference::Box box;
    for (const uint32_t index : mesh.indices) box.grow(to_glm(mesh.positions[index]));
    for (int corner = 0; corner < 8; ++corner)
      plain.box.grow(transform(world_from_mesh, {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                                 corner & 4 ? box.max.z : box.min.z}));
    const float* m = world_from_mesh.m;
    plain.stretch = std::max({glm::length(glm::dvec3(m[0], m[4], m[8])), glm::length(glm::dvec3(m[1], m[5], m[9])),
                              glm::length(glm::dvec3(m[2], m[6], m[10]))});
    plain.errors_m.assign(mesh.level_errors_m.begin(), mesh.level_errors_m.end());
    if (plain.errors_m.empty()) plain.errors_m = {0};
  }
  return all;
}

/// Whether a batch is of the level of detail that the map gets of its instance; of those on either side when rounding decides.
bool is_of_level(const shared::BatchRecord& batch, const PlainInstance& instance, const reference::CasterMap& map,
                 double texels, Allow allow) {
  const auto at = [&](float more) {
    const float by = more * glm::length(glm::max(glm::abs(instance.box.min), glm::abs(instance.box.max)));
    const reference::Box box{.min = instance.box.min + by, .max = instance.box.max - by};
    const double error_m = reference::caster_error_m(map, box, texels * (1 + more)) / instance.stretch;
    const double error = instance.errors_m[reference::detail_level(instance.errors_m, error_m)];
    return error >= double(batch.least_error_m) && error < double(batch.end_error_m);
  };
  constexpr float kRounding = 5e-6f;
  return allow == Allow::rounding ? at(kRounding) || at(-kRounding) : at(kRounding) && at(-kRounding);
}

/// The device's items are those of the reference but for pairs that rounding decides. Returns how many of these there are.
size_t expect_as_reference(SystemRig& rig, const TestScene& scene, const CasterTables& casters, const MapTables& maps,
                           const MapItems& found, const MapRounds& rounds) {
  const std::vector<PlainInstance> instances = plain_instances(rig, scene);
  const auto views_of = [&](const shared::LightRecord& light, uint32_t m, uint32_t c, Allow allow) {
    const PlainInstance& instance = instances[casters.casters[c].instance];
    const shared::BatchRecord& batch = casters.batches[casters.casters[c].batch];
    return is_of_level(batch, instance, maps.plain[m], rounds.caster_error, allow)
               ? reference_views(light, maps.plain[m], casters.boxes[c], rounds.mode, allow)
               : 0;
  };
  const std::vector<shared::LightRecord> lights = rig.lights();
  size_t open = 0;
  for (uint32_t m = 0; m < maps.maps.size(); ++m) {
    const shared::LightRecord& light = lights[maps.maps[m].light];
    for (uint32_t c = 0; c < casters.casters.size(); ++c) {
      const bool lit = is_lit(casters, c, light.light_mask);
      const uint32_t may = lit ? views_of(light, m, c, Allow::rounding) : 0;
      const uint32_t must = may ? views_of(light, m, c, Allow::nothing) : 0;
      const auto item = found.views.find({c, m});
      const uint32_t drawn = item == found.views.end() ? 0 : item->second;
      EXPECT_EQ(must & ~drawn, 0u) << "map " << m << " of light " << maps.maps[m].light << " lacks caster " << c
                                   << " in views";
      EXPECT_EQ(drawn & ~may, 0u) << "map " << m << " of light " << maps.maps[m].light << " does not need caster " << c
                                  << " in views";
      open += static_cast<size_t>(std::popcount(may & ~must));
    }
  }
  return open;
}

TEST_F(MapCasters, AreThoseOfTheReference) {
  SystemRig rig(gpu(), {.budget_mib = 16});
  const TestScene scene = awkward_scene();
  rig.add(scene);
  rig.show_nothing();
  rig.frame({.max_resolution = 64});
  const CasterTables casters(rig);
  for (const uint32_t grid : {1u, 8u, 32u}) {
    const MapTables maps = random_maps(rig, casters, grid, grid);
    std::vector<MapItems> found;
    for (const CasterCulling mode : kModes) {
      SCOPED_TRACE("mode " + std::to_string(static_cast<int>(mode)) + ", grid " + std::to_string(grid));
      found.push_back(find_items(rig, culling(), casters, maps, {.mode = mode}));
      const size_t open = expect_as_reference(rig, scene, casters, maps, found.back(), {.mode = mode});
      EXPECT_LT(open, found.back().pairs() / 100) << "the reference decides";
    }
    for (size_t i = 1; i < found.size(); ++i) {
      // On a grid of one cell the last two are the same.
      if (i == 4 && grid == 1)
        EXPECT_EQ(found[i].pairs(), found[i - 1].pairs());
      else
        EXPECT_LT(found[i].pairs(), found[i - 1].pairs()) << "mode " << i << ", grid " << grid;
      for (const auto& [item, views] : found[i].views) {
        const auto before = found[i - 1].views.find(item);
        ASSERT_TRUE(before != found[i - 1].views.end() && (views & ~before->second) == 0);
      }
    }
    EXPECT_GT(found.back().pairs(), 300u);
  }
}

/// Meshes in levels: of one kind each, masked, with a part that all levels have, with parts that two levels have; and without.
/// Near, far, small, large, mirrored and around lights of all kinds.
TestScene scene_in_levels() {
  TestScene scene = mixed_scene(0, 40, 23);
  const TestMesh sphere = sphere_in_levels(), box = box_mesh();
  TestMesh masked[3] = {plane_mesh(8), masked_mesh(), plane_mesh(2)};
  for (TestMesh& part : masked) {
    part.uvs.clear();
    for (const Vec3& p : part.positions) part.uvs.push_back({p.x, p.z});
  }
  const LevelRange each[] = {{0, 0}, {1, 1}, {2, MaxMeshLevels - 1}};
  const TestMesh boxed[] = {sphere_mesh(16, 24), sphere_mesh(6, 8), box};
  const LevelRange with_all[] = {{0, 0}, {1, 1}, {}};
  const TestMesh halves[] = {sphere_mesh(20, 20), sphere_mesh(5, 6)};
  const LevelRange two_each[] = {{0, 1}, {2, 3}};
  scene.meshes = {sphere, mesh_of_levels(masked, each, std::array{0.0f, 0.01f, 0.2f}),
                  mesh_of_levels(boxed, with_all, std::array{0.0f, 0.1f}),
                  mesh_of_levels(halves, two_each, std::array{0.0f, 0.005f, 0.07f, 0.3f}), box};
  std::mt19937 engine(24);
  std::uniform_real_distribution<float> place(-12, 12), height(0, 4), size(-2, 2);
  for (uint32_t i = 0; i < 100; ++i) {
    Affine world_from_mesh = random_affine(i, {place(engine), height(engine), place(engine)});
    const float scale = std::exp(size(engine));
    for (int entry = 0; entry < 12; ++entry)
      if (entry % 4 != 3) world_from_mesh.m[entry] *= scale;
    scene.instances.push_back({.mesh = i % 5, .world_from_mesh = world_from_mesh});
  }
  const glm::vec3 within = to_glm(scene.lights[2].position) + glm::vec3(0.13f, 0.07f, -0.11f);
  for (uint32_t mesh = 0; mesh < 4; ++mesh)
    scene.instances.push_back({.mesh = mesh, .world_from_mesh = affine(glm::mat3(0.5f), within)});
  return scene;
}

/// What is drawn of an instance in a map is of one level. Returns how many instances are drawn as each.
std::map<float, size_t> drawn_as(const CasterTables& casters, const MapItems& found) {
  std::map<std::pair<uint32_t, uint32_t>, std::pair<float, float>> errors;  // (instance, map) → of its batches
  for (const shared::CasterItem& item : found.order) {
    const shared::CasterRecord& caster = casters.casters[item.caster];
    const shared::BatchRecord& batch = casters.batches[caster.batch];
    auto& [least, end] = errors.try_emplace({caster.instance, item.map}, 0.0f, INFINITY).first->second;
    least = std::max(least, batch.least_error_m), end = std::min(end, batch.end_error_m);
    EXPECT_LT(least, end) << "instance " << caster.instance << " in map " << item.map << " is of two levels";
  }
  std::map<float, size_t> counts;
  for (const auto& [place, range] : errors) ++counts[range.first];
  return counts;
}

TEST_F(MapCasters, AreOfTheLevelThatSuitsTheMap) {
  SystemRig rig(gpu(), {.budget_mib = 16, .batch_triangles = 64});
  const TestScene scene = scene_in_levels();
  rig.add(scene);
  rig.show_nothing();
  rig.frame({.max_resolution = 64});
  const CasterTables casters(rig);
  std::map<float, size_t> drawn;  // by the error that a level begins with
  for (const uint32_t resolution : {16u, 128u, 1024u}) {
    const MapTables maps = random_maps(rig, casters, 8, 80, resolution);
    for (const float texels : {0.0f, 0.3f, 1.0f, 4.0f}) {
      for (const CasterCulling mode : {CasterCulling::light_volume, CasterCulling::receiver_grid}) {
        SCOPED_TRACE("mode " + std::to_string(static_cast<int>(mode)) + ", " + std::to_string(resolution) +
                     " texels a side, off by " + std::to_string(texels));
        const MapRounds rounds{.mode = mode, .caster_error = texels};
        const MapItems found = find_items(rig, culling(), casters, maps, rounds);
        const size_t open = expect_as_reference(rig, scene, casters, maps, found, rounds);
        EXPECT_LT(open, found.pairs() / 100) << "the reference decides";
        const std::map<float, size_t> now = drawn_as(casters, found);
        if (texels == 0) { EXPECT_EQ(now.size(), 1u) << "the finest alone"; }
        for (const auto& [error, count] : now) drawn[error] += count;
      }
    }
  }
  for (const TestMesh& mesh : scene.meshes)
    for (const Submesh& submesh : mesh.submeshes)
      EXPECT_GT(drawn[mesh.level_errors_m[submesh.first_level]], 100u) << mesh.level_errors_m[submesh.first_level];
}

bool reaches(const shared::LightRecord& light, const glm::vec3& receiver) {
  if (light.type == shared::LightDirectional) return true;
  const glm::vec3 way = receiver - light.position_ws;
  return glm::length(way) <= light.range_m &&
         (light.type != shared::LightSpot || glm::dot(way, light.direction_ws) >= light.cos_outer * glm::length(way));
}

TEST_F(MapCasters, NeverLackWhatShadowsAReceiver) {
  SystemRig rig(gpu(), {.budget_mib = 16});
  rig.add(awkward_scene());
  rig.show_nothing();
  rig.frame({.max_resolution = 64});
  const CasterTables casters(rig);
  const std::vector<shared::LightRecord> lights = rig.lights();
  for (const uint32_t grid : {1u, 32u}) {
    const MapTables maps = random_maps(rig, casters, grid, 50 + grid);
    for (const CasterCulling mode : kModes) {
      const MapItems found = find_items(rig, culling(), casters, maps, {.mode = mode});
      size_t between = 0;
      for (uint32_t m = 0; m < maps.maps.size(); ++m) {
        const shared::LightRecord& light = lights[maps.maps[m].light];
        for (const glm::vec3& receiver : maps.receivers[m]) {
          if (!reaches(light, receiver)) continue;
          for (int step = 1; step < 12; ++step) {
            const glm::vec3 towards =
                light.type == shared::LightDirectional ? -light.direction_ws * 30.0f : light.position_ws - receiver;
            const glm::vec3 at = receiver + towards * (float(step) / 12.5f);
            for (uint32_t c = 0; c < casters.boxes.size(); ++c) {
              const shared::Box& box = casters.boxes[c];
              const bool inside = glm::all(glm::lessThanEqual(box.lo, at)) && glm::all(glm::lessThanEqual(at, box.hi));
              if (!inside || !is_lit(casters, c, light.light_mask)) continue;
              ++between;
              const auto item = found.views.find({c, m});
              ASSERT_TRUE(item != found.views.end()) << "mode " << int(mode) << ", map " << m << ", caster " << c;
              const uint32_t view =
                  maps.maps[m].kind == shared::ViewsCube ? shared::face_of_direction(receiver - light.position_ws) : 0;
              ASSERT_TRUE(item->second >> view & 1)
                  << "mode " << int(mode) << ", map " << m << ", caster " << c << ", view " << view;
            }
          }
        }
      }
      EXPECT_GT(between, 1000u);
    }
  }
}

TEST_F(MapCasters, AreTheSameWhateverNodesAreTestedAgainst) {
  SystemRig rig(gpu(), {.budget_mib = 16});
  rig.add(awkward_scene());
  rig.show_nothing();
  rig.frame({.max_resolution = 64});
  const CasterTables casters(rig);
  const MapTables maps = random_maps(rig, casters, 8, 5);
  const auto words = [](const MapItems& items) {
    std::vector<std::array<uint32_t, 3>> out;
    for (const shared::CasterItem& item : items.order) out.push_back({item.caster, item.map, item.faces});
    return out;
  };
  for (const CasterCulling mode : kModes) {
    const auto plain = words(find_items(rig, culling(shared::NodesByLight), casters, maps, {.mode = mode}));
    for (const uint32_t test : {shared::NodesByLight, shared::NodesByView, shared::NodesByReceivers})
      EXPECT_EQ(words(find_items(rig, culling(test), casters, maps, {.mode = mode})), plain)
          << "mode " << int(mode) << ", test " << test;
    // In rounds, too, they come in the same order.
    const auto count = static_cast<uint32_t>(plain.size());
    for (const uint32_t capacity : {97u, count / 2, count - 1, count})
      EXPECT_EQ(words(find_items(rig, culling(), casters, maps,
                                 {.mode = mode, .capacity = capacity, .rounds = (count + capacity - 1) / capacity})),
                plain)
          << "mode " << int(mode) << ", " << capacity << " items a round";
  }
}

TEST_F(MapCasters, BeyondTheRoundsAreReported) {
  SystemRig rig(gpu(), {.budget_mib = 16});
  rig.add(awkward_scene());
  rig.show_nothing();
  rig.frame({.max_resolution = 64});
  const CasterTables casters(rig);
  const MapTables maps = random_maps(rig, casters, 8, 6);
  const MapItems all = find_items(rig, culling(), casters, maps, {.mode = CasterCulling::view_mask});
  EXPECT_EQ(std::count(all.lights.begin(), all.lights.end(), shared::LightIsUsed), std::ptrdiff_t(all.lights.size()));
  const auto count = static_cast<uint32_t>(all.order.size());
  for (const uint32_t capacity : {count / 7, count / 3, count - 1}) {
    const MapItems some =
        find_items(rig, culling(), casters, maps, {.mode = CasterCulling::view_mask, .capacity = capacity});
    EXPECT_EQ(some.counters.caster_pairs, count);
    std::set<uint32_t> lacking;
    for (const shared::CasterItem& item : all.order)
      if (!some.views.count({item.caster, item.map})) lacking.insert(maps.maps[item.map].light);
    for (uint32_t slot = 0; slot < some.lights.size(); ++slot)
      EXPECT_EQ(some.lights[slot], shared::LightIsUsed | (lacking.count(slot) ? shared::LightLacksCasters : 0))
          << "light " << slot;
    EXPECT_FALSE(lacking.empty());
  }
}

TEST_F(MapCasters, OfNothingAreNone) {
  const TestScene full = awkward_scene();
  for (const bool casts : {false, true}) {
    SystemRig rig(gpu(), {.budget_mib = 16});
    TestScene scene = full;
    if (!casts) scene.instances.clear();
    if (casts) scene.lights.clear();
    rig.add(scene);
    rig.show_nothing();
    rig.frame({.max_resolution = 64});
    const CasterTables casters(rig);
    const MapTables none(4), some = random_maps(rig, casters, 4, 7);
    EXPECT_EQ(some.maps.empty(), casts);
    for (const CasterCulling mode : kModes) {
      EXPECT_TRUE(find_items(rig, culling(), casters, none, {.mode = mode}).order.empty());
      EXPECT_TRUE(find_items(rig, culling(), casters, some, {.mode = mode}).order.empty());
    }
  }
}

}  // namespace
}  // namespace umbrage::test
