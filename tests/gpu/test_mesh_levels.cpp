// Meshes with levels of detail in whole frames: what is refused, when exactly the finest level is drawn, and that coarser ones are
// fewer triangles for the same shadows.
#include <algorithm>
#include <cmath>
#include <random>

#include "map_rig.hpp"
#include "pair_rig.hpp"

namespace umbrage::test {
namespace {

class MeshLevels : public GpuTest {};

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInfinite = std::numeric_limits<float>::infinity();

/// Instances of spheres in levels, some with a box that is of all levels; all lights but what `keep` leaves out.
SeenScene scene_in_levels(uint32_t lights, const std::function<bool(const LightDesc&)>& keep = {}) {
  SeenScene seen = balls_scene(0, lights, 91, 64, 48);
  if (keep) std::erase_if(seen.scene.lights, [&](const LightDesc& light) { return !keep(light); });
  for (uint32_t i = 0; i < seen.scene.lights.size(); ++i) seen.scene.lights[i].host_index = i;
  const TestMesh parts[] = {sphere_mesh(24, 32), sphere_mesh(8, 12), box_mesh()};
  const LevelRange ranges[] = {{0, 0}, {1, 1}, {}};
  seen.scene.meshes = {sphere_in_levels(), mesh_of_levels(parts, ranges, std::array{0.0f, 0.05f})};
  std::mt19937 engine(92);
  std::uniform_real_distribution<float> place(-9, 9), height(0.3f, 3);
  for (uint32_t i = 0; i < 60; ++i)
    seen.scene.instances.push_back(
        {.mesh = i % 2, .world_from_mesh = random_affine(i, {place(engine), height(engine), place(engine)})});
  return seen;
}

/// Nothing but the finest levels.
SeenScene finest_of(SeenScene seen) {
  for (TestMesh& mesh : seen.scene.meshes) mesh = finest_of(mesh);
  return seen;
}

FrameSettings off_by(uint32_t percent, CascadeMode cascades = CascadeMode::none) {
  FrameSettings settings;
  settings.caster_error_percent = percent;
  settings.cascades = cascades;
  return settings;
}

void expect_the_same(const Pairs& a, const Pairs& b) {
  EXPECT_GT(a.asked(), 1000u);
  EXPECT_GT(a.statistics.triangles_drawn, 0u);
  EXPECT_EQ(differences(a, b), 0u);
  EXPECT_EQ(a.statistics.triangles_drawn, b.statistics.triangles_drawn);
  EXPECT_EQ(a.statistics.batches_drawn, b.statistics.batches_drawn);
  EXPECT_EQ(a.statistics.caster_pairs, b.statistics.caster_pairs);
}

/// (pixel, light) whose visibility differs by more than a quarter.
double share_of_different(const Pairs& a, const Pairs& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.visibility.size(); ++i) count += std::abs(a.visibility[i] - b.visibility[i]) > 0.25f;
  return double(count) / double(a.asked());
}

TEST_F(MeshLevels, ThatAreWrongAreRefusedAndChangeNothing) {
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.add(mixed_scene(12, 6, 5));
  rig.show_nothing();
  rig.frame({.max_resolution = 32});
  const Atlas before = rig.atlas();
  const TestMesh mesh = box_mesh();
  const auto refused = [&](const std::vector<float>& errors_m, const std::vector<Submesh>& submeshes,
                           const std::string& place) {
    const auto added = rig.system().add_mesh(
        {.positions = mesh.positions, .indices = mesh.indices, .submeshes = submeshes, .level_errors_m = errors_m});
    ASSERT_FALSE(added.ok()) << place;
    EXPECT_EQ(added.error().code, ErrorCode::invalid_argument) << place;
    EXPECT_NE(added.error().message.find(place), std::string::npos) << added.error().message << " lacks " << place;
  };
  const auto half = [](uint32_t i, uint32_t first, uint32_t last) {
    return Submesh{.first_index = 18 * i, .index_count = 18, .first_level = first, .last_level = last};
  };
  refused({1e-3f}, {}, "level_errors_m: level 0");
  refused({-1, 0}, {}, "level_errors_m: level 0");
  refused({kNaN, 1}, {}, "level_errors_m: level 0");
  refused({0, 0}, {}, "level_errors_m: level 1");
  refused({0, -1}, {}, "level_errors_m: level 1");
  refused({0, 1, 1}, {}, "level_errors_m: level 2");
  refused({0, 1, 3, 2}, {}, "level_errors_m: level 3");
  refused({0, kNaN}, {}, "level_errors_m: level 1");
  refused({0, 1, kInfinite}, {}, "level_errors_m: level 2");
  std::vector<float> many(MaxMeshLevels + 1);
  for (uint32_t i = 0; i < many.size(); ++i) many[i] = float(i);
  refused(many, {}, "level_errors_m: 17 levels");
  refused({0, 1, 2}, {half(0, 0, 2), half(1, 2, 1)}, "submesh 1");
  refused({0, 1, 2}, {half(0, 3, 3), half(1, 0, 2)}, "submesh 0");
  refused({}, {half(0, 0, 0), half(1, 1, 1)}, "submesh 1");

  // As many levels as there may be, and submeshes that end beyond the last one.
  many.pop_back();
  for (const std::vector<float>& errors_m : {many, {0, 1e-30f}, {0}, {}}) {
    const std::vector<Submesh> submeshes = {half(0, 0, 0xffffffffu), half(1, 0, MaxMeshLevels - 1)};
    const auto added = rig.system().add_mesh(
        {.positions = mesh.positions, .indices = mesh.indices, .submeshes = submeshes, .level_errors_m = errors_m});
    ASSERT_TRUE(added.ok()) << added.error().message;
    take(rig.system().remove(*added));
  }
  rig.frame({.max_resolution = 32});
  const Atlas after = rig.atlas();
  EXPECT_TRUE(before.depth == after.depth);
}

TEST_F(MeshLevels, AreTheFinestWhenCastersMayNotBeOff) {
  const SeenScene levels = scene_in_levels(24), finest = finest_of(levels);
  for (const Store store : {Store::page_pool, Store::physical_pool, Store::hardware_sparse}) {
    SCOPED_TRACE("store " + std::to_string(static_cast<int>(store)));
    PairRig rig(gpu(), {.store = store}, levels);
    const Pairs as_given = PairRig(gpu(), {.store = store}, finest).settle(off_by(100));
    expect_the_same(rig.settle(off_by(0)), as_given);
    uint64_t before = as_given.statistics.triangles_drawn;
    for (const uint32_t percent : {25u, 100u, 400u}) {
      const Pairs now = rig.settle(off_by(percent));
      EXPECT_LT(now.statistics.triangles_drawn, before) << percent;
      EXPECT_GT(now.statistics.triangles_drawn, 0u);
      EXPECT_LT(share_of_different(now, as_given), percent * 1e-4) << percent;
      before = now.statistics.triangles_drawn;
    }
    EXPECT_LT(before, as_given.statistics.triangles_drawn / 3);
  }
}

TEST_F(MeshLevels, AreTheFinestInFixedCubesAndCascades) {
  const SeenScene levels = scene_in_levels(24), finest = finest_of(levels);
  const Pairs cubes = PairRig(gpu(), {.store = Store::fixed_cubes}, finest).settle();
  for (const uint32_t percent : {0u, 400u})
    expect_the_same(PairRig(gpu(), {.store = Store::fixed_cubes}, levels).settle(off_by(percent)), cubes);

  const auto is_sun = [](const LightDesc& light) { return light.type == LightType::directional; };
  const SeenScene suns = scene_in_levels(24, is_sun), finest_suns = finest_of(suns);
  ASSERT_EQ(suns.scene.lights.size(), 2u);
  for (const CascadeMode mode : {CascadeMode::redraw, CascadeMode::guard_band}) {
    SCOPED_TRACE("cascades " + std::to_string(static_cast<int>(mode)));
    PairRig rig(gpu(), {}, suns), plain(gpu(), {}, finest_suns);
    for (const uint32_t percent : {0u, 400u})
      expect_the_same(rig.evaluate(off_by(percent, mode)), plain.evaluate(off_by(0, mode)));
  }
}

TEST_F(MeshLevels, AreTheFinestOfDeformedInstances) {
  SeenScene levels = scene_in_levels(24);
  const std::vector<TestInstance> instances = std::exchange(levels.scene.instances, {});
  const SeenScene finest = finest_of(levels);
  const auto add = [&](PairRig& rig, const SeenScene& seen, bool deformed) {
    std::vector<gpu::Buffer> streams;
    for (const TestMesh& mesh : seen.scene.meshes) streams.push_back(gpu().upload(mesh.positions));
    for (const TestInstance& instance : instances) {
      InstanceDesc desc{.mesh = rig.mesh_ids[instance.mesh],
                        .world_from_mesh = instance.world_from_mesh,
                        .mobility = Mobility::movable};
      if (deformed) desc.deformed = {streams[instance.mesh].address(), sizeof(Vec3)};
      take(rig.system().add_instance(desc));
    }
    return streams;
  };
  PairRig plain(gpu(), {}, finest), deformed(gpu(), {}, levels), rigid(gpu(), {}, levels);
  const auto a = add(plain, finest, true), b = add(deformed, levels, true), c = add(rigid, levels, false);
  const Pairs as_given = plain.settle(off_by(400));
  for (const uint32_t percent : {0u, 400u}) expect_the_same(deformed.settle(off_by(percent)), as_given);
  EXPECT_LT(rigid.settle(off_by(400)).statistics.triangles_drawn, as_given.statistics.triangles_drawn / 2);
}

TEST_F(MeshLevels, MeanNothingToSubmeshesThatAreOfAll) {
  SeenScene levels = scene_in_levels(24);
  for (const uint32_t last : {3u, MaxMeshLevels - 1, 0xffffffffu}) {
    for (TestMesh& mesh : levels.scene.meshes) {
      mesh = finest_of(sphere_in_levels());
      mesh.level_errors_m = {0, 0.01f, 0.1f, 0.3f};
      mesh.submeshes[0].last_level = last;
    }
    SeenScene plain = levels;
    for (TestMesh& mesh : plain.scene.meshes) mesh.level_errors_m.clear();
    expect_the_same(PairRig(gpu(), {}, levels).settle(off_by(400)), PairRig(gpu(), {}, plain).settle(off_by(400)));
  }
}

TEST_F(MeshLevels, MayBeMissing) {
  // Only the coarser one of two: seen where it suits, and its instances have a place all the same.
  SeenScene seen = scene_in_levels(24);
  const TestMesh part = sphere_mesh(8, 12);
  const LevelRange coarse{1, 1};
  for (TestMesh& mesh : seen.scene.meshes) mesh = mesh_of_levels({&part, 1}, {&coarse, 1}, std::array{0.0f, 0.03f});
  PairRig rig(gpu(), {}, seen);
  EXPECT_EQ(rig.settle(off_by(0)).statistics.triangles_drawn, 0u);
  const uint64_t some = rig.settle(off_by(100)).statistics.triangles_drawn;
  EXPECT_GT(some, 0u);
  EXPECT_GT(rig.settle(off_by(400)).statistics.triangles_drawn, some);
  const CasterTables tables(rig);
  ASSERT_FALSE(tables.casters.empty());
  for (size_t i = 0; i < tables.casters.size(); ++i) {
    if (tables.casters[i].instance == shared::NoIndex) continue;
    const shared::Box &box = tables.instances[tables.casters[i].instance].box, &batch = tables.boxes[i];
    const glm::vec3 slack(1e-4f);
    EXPECT_TRUE(glm::all(glm::lessThanEqual(box.lo, batch.lo + slack)) &&
                glm::all(glm::lessThanEqual(batch.hi - slack, box.hi)))
        << "caster " << i;
  }
}

TEST_F(MeshLevels, KnowHowMuchTransformsStretch) {
  SystemRig rig(gpu(), {.budget_mib = 4});
  TestScene scene;
  scene.meshes = {sphere_in_levels()};
  std::mt19937 engine(6);
  std::normal_distribution<float> normal;
  const auto random = [&] { return glm::vec3(normal(engine), normal(engine), normal(engine)); };
  for (uint32_t i = 0; i < 50; ++i) {
    const glm::mat3 sheared(random(), random(), random());
    const glm::vec3 at = 10.0f * random();
    scene.instances.push_back({.world_from_mesh = i % 2 ? random_affine(i, at) : affine(sheared, at)});
  }
  rig.add(scene);
  rig.show_nothing();
  rig.frame({.max_resolution = 32});
  const CasterTables tables(rig);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const shared::InstanceRecord& record = tables.instances[slot_of(rig.instance_ids[i])];
    const Affine& m = scene.instances[i].world_from_mesh;
    const glm::vec3 origin = transform(m, {0, 0, 0});
    float longest = 0;
    glm::vec3 lo(kInfinite), hi(-kInfinite);
    for (int sample = 0; sample < 4000; ++sample) {
      const glm::vec3 way = transform(m, to_vec3(glm::normalize(random())));
      longest = std::max(longest, glm::length(way - origin));
      lo = glm::min(lo, way), hi = glm::max(hi, way);
    }
    EXPECT_GE(record.stretch, longest);
    EXPECT_LE(record.stretch, longest * (i % 2 ? 1.01f : 1.5f)) << "exact unless the axes are sheared";
    EXPECT_TRUE(glm::all(glm::lessThanEqual(record.box.lo, lo)) && glm::all(glm::lessThanEqual(hi, record.box.hi)));
    EXPECT_LE(glm::length(record.box.hi - record.box.lo), 2 * std::sqrt(3.0f) * std::sqrt(3.0f) * longest * 1.01f);
  }
}

}  // namespace
}  // namespace umbrage::test
