// Cascades in every mode against a redraw of everything, texel by texel, whatever moves; and against the plain rasteriser.
#include <cmath>
#include <random>

#include "cascade_rig.hpp"
#include "gpu/hazards.hpp"
#include "reference/cascades.hpp"

namespace umbrage::test {
namespace {

using cascades::CascadeSettings;
using cascades::Mode;
using Eye = std::pair<glm::vec3, glm::vec3>;  // eye, target

const glm::vec3 kSun = glm::normalize(glm::vec3(0.5f, -1, 0.3f));

CascadeSettings small(Mode mode) {
  CascadeSettings settings{
      .mode = mode, .count = 3, .resolution = 128, .distance_m = 24, .reach_m = 30, .guard_texels = 16};
  settings.static_after = 200;
  return settings;
}

/// Half of what stands in mixed_scene can move; under it a slope of a few large triangles.
TestScene half_movable(uint32_t instances, uint32_t seed) {
  TestScene scene = mixed_scene(instances, 0, seed);
  const glm::mat3 slope(glm::vec3(60, 6, 0), glm::vec3(0, 1, 0), glm::vec3(0, -9, 60));
  scene.meshes.push_back(plane_mesh(2));
  scene.instances.insert(scene.instances.begin(), {.mesh = static_cast<uint32_t>(scene.meshes.size()) - 1,
                                                   .world_from_mesh = affine(slope, {0, -1, 0})});
  for (size_t i = 0; i < scene.instances.size(); ++i)
    scene.instances[i].mobility = i % 2 ? Mobility::movable : Mobility::fixed;
  return scene;
}

class Cascading : public GpuTest {
 protected:
  /// Runs frames of a motion through scrolled, cached and guard band; every finished map equals the redraw in every frame.
  static void expect_equal(const std::function<Eye(int)>& motion, int frames,
                           const std::function<void(CascadeRig&, int)>& edit = {}) {
    CascadeRig rig(gpu(), half_movable(60, 7), {small(Mode::scrolled), small(Mode::cached), small(Mode::guard_band)},
                   kSun);
    for (int i = 0; i < frames; ++i) {
      if (edit) edit(rig, i);
      const auto [eye, target] = motion(i);
      rig.frame(perspective_camera(eye, target, 64, 40));
      for (size_t mode = 0; mode < 3; ++mode)
        ASSERT_EQ(rig.wrong_texels(mode), 0u) << "mode " << mode << ", frame " << i;
    }
  }
};

Eye straight(const glm::vec3& eye) { return {eye, eye + glm::vec3(0, -0.3f, -1)}; }
float f(int i) { return static_cast<float>(i); }

TEST_F(Cascading, EqualsARedrawAlongOneAxis) {
  expect_equal([](int i) { return straight({0.35f * f(i) - 2, 2, 6}); }, 12);
}
TEST_F(Cascading, EqualsARedrawDiagonally) {
  expect_equal([](int i) { return straight(glm::vec3(-0.41f, 0.13f, 0.29f) * f(i)); }, 12);
}
TEST_F(Cascading, EqualsARedrawAlongTheLight) {
  // Away from the light, beyond what the volume's depth holds, and back.
  expect_equal([](int i) { return straight(kSun * 12.0f * (i < 8 ? f(i) : f(16 - i))); }, 17);
}
TEST_F(Cascading, EqualsARedrawAfterMovesLargerThanTheMap) {
  expect_equal([](int i) { return straight({i % 2 ? 60.0f : 0.0f, 2, 6}); }, 6);
}
TEST_F(Cascading, EqualsARedrawThereAndBackAgain) {
  expect_equal([](int i) { return straight({3 * std::sin(0.7f * f(i)), 2, 6 + 2 * std::sin(0.4f * f(i))}); }, 16);
}
TEST_F(Cascading, EqualsARedrawWhileTheCameraTurns) {
  expect_equal([](int i) { return Eye{{0, 2, 0}, {std::sin(0.12f * f(i)), 1.8f, std::cos(0.12f * f(i))}}; }, 16);
}
TEST_F(Cascading, EqualsARedrawAfterTeleports) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> place(-30, 30);
  std::vector<glm::vec3> places(10);
  for (glm::vec3& p : places) p = {place(engine), place(engine), place(engine)};
  expect_equal([&](int i) { return straight(places[static_cast<size_t>(i) / 2]); }, 20);
}

/// Moves, stops, deletes, adds; a few frames without edits let casters turn static.
void edit_at_random(CascadeRig& rig, int frame) {
  static thread_local std::mt19937 engine;
  if (frame == 0) engine.seed(11);
  std::uniform_real_distribution<float> place(-8, 8), height(0.5f, 4);
  if (frame % 12 > 5) return;
  for (int i = 0; i < 3; ++i) {
    const size_t which = engine() % rig.instances().size();
    const Affine to = random_affine(static_cast<uint32_t>(engine()), {place(engine), height(engine), place(engine)});
    const std::array ids{rig.instances()[which]};
    if (engine() % 4 == 0) {
      take(rig.scene().remove(ids[0]));
      rig.instances()[which] =
          take(rig.scene().add_instance({.mesh = rig.mesh(engine() % 2),
                                         .world_from_mesh = to,
                                         .mobility = engine() % 2 ? Mobility::movable : Mobility::fixed}));
    } else if (!rig.scene().set_transforms(ids, {&to, 1})) {
      continue;  // a fixed one
    }
  }
}

TEST_F(Cascading, EqualsARedrawWhileObjectsMoveStopComeAndGo) {
  expect_equal([](int) { return straight({0, 2, 6}); }, 36, edit_at_random);
}
TEST_F(Cascading, EqualsARedrawWhileEverythingMoves) {
  expect_equal(
      [](int i) { return straight(glm::vec3(0.21f * f(i) - 3, 2 + 0.8f * std::sin(0.5f * f(i)), 6 - 0.17f * f(i))); },
      36, edit_at_random);
}
TEST_F(Cascading, EqualsARedrawWhenTheSunTurnsAndGoesOverThePole) {
  expect_equal(
      [](int i) {
        return straight({0.1f * f(i), 2, 6});
      },
      12,
      [](CascadeRig& rig, int i) {
        if (i % 3 == 2) rig.set_sun({0.02f * (6 - f(i)), -1, 1e-7f});
      });
}

TEST_F(Cascading, StandingStillDrawsNoTriangleIntoStaticMaps) {
  CascadeRig rig(gpu(), half_movable(60, 7), {small(Mode::scrolled), small(Mode::cached), small(Mode::guard_band)},
                 kSun);
  const CameraDesc camera = perspective_camera({0, 2, 6}, {0, 1, 0}, 64, 40);
  for (int i = 0; i < 20; ++i) {
    // One caster runs about all the time.
    const Affine to = affine(glm::mat3(0.5f), {0.2f * f(i) - 2, 1, 0});
    take(rig.scene().set_transforms({&rig.instances()[1], 1}, {&to, 1}));
    rig.frame(camera);
    for (size_t mode = 0; mode < 3; ++mode) {
      ASSERT_EQ(rig.wrong_texels(mode), 0u);
      uint32_t actives = 0;
      for (const shared::CascadeState& state : rig.states(mode)) {
        EXPECT_EQ(state.action, i == 0 ? shared::MapIsCleared : shared::MapIsKept);
        // At 200 ms, the seventh frame, everything else that can move turns static; then nothing does.
        actives += state.actives;
        if (i > 8) { EXPECT_EQ(state.static_triangles, 0u); }
      }
      EXPECT_GT(actives, 0u);
    }
  }
}

TEST_F(Cascading, ScrolledDrawsFarFewerTrianglesThanARedraw) {
  CascadeRig rig(gpu(), half_movable(400, 5), {small(Mode::scrolled), small(Mode::redraw)}, kSun);
  uint64_t scrolled = 0, redrawn = 0;
  for (int i = 0; i < 24; ++i) {
    const auto [eye, target] = straight({0.05f * f(i), 2, 6});
    rig.frame(perspective_camera(eye, target, 64, 40));
    if (i < 10) continue;  // until all that can move has stood still
    for (const auto& state : rig.states(0)) scrolled += state.static_triangles + state.active_triangles;
    for (const auto& state : rig.states(1)) redrawn += state.static_triangles + state.active_triangles;
  }
  EXPECT_GT(redrawn, 5 * scrolled);
}

TEST_F(Cascading, AStationaryShadowKeepsItsTexelsUnderMotionBelowATexel) {
  CascadeRig rig(gpu(), half_movable(60, 7), {small(Mode::scrolled), small(Mode::redraw)}, kSun);
  // Absolute texel → depth in absolute units, wherever both frames have them.
  std::array<std::vector<uint32_t>, 2> former;
  std::array<glm::ivec3, 2> origin{};
  for (int i = 0; i < 30; ++i) {
    const auto [eye, target] = straight(glm::vec3(0.003f, 0.001f, 0.002f) * f(i) + glm::vec3(0, 2, 6));
    rig.frame(perspective_camera(eye, target, 64, 40));
    for (size_t mode = 0; mode < 2; ++mode) {
      const auto map = rig.finished(mode, 1);
      const shared::CascadeRecord& record = rig.record(mode, 1);
      const int side = static_cast<int>(record.side);
      size_t changed = 0;
      for (int y = 0; y < side && i; ++y)
        for (int x = 0; x < side; ++x) {
          const glm::ivec3 by = record.origin - origin[mode];
          const glm::ivec2 at(x + by.x, y + by.y);
          if (at.x < 0 || at.y < 0 || at.x >= side || at.y >= side) continue;
          const uint32_t now = map[static_cast<size_t>(y * side + x)],
                         before = former[mode][static_cast<size_t>(at.y * side + at.x)];
          // What lay beyond the far side of one of the two volumes is in neither.
          const bool is_new = now != shared::ClearDepth && static_cast<int>(now) + by.z > shared::FarDepth;
          changed += now != shared::scrolled_depth(before, by.z) && !is_new;
        }
      EXPECT_EQ(changed, 0u) << i;
      former[mode] = map;
      origin[mode] = record.origin;
    }
  }
}

TEST_F(Cascading, TheListingAsPrintedForgetsStraddlers) {  // E17
  CascadeRig rig(gpu(), half_movable(200, 7), {small(Mode::scrolled_literal), small(Mode::scrolled)}, kSun);
  rig.frame(perspective_camera({0, 2, 6}, {0, 1.7f, 5}, 64, 40));
  EXPECT_EQ(rig.wrong_texels(0), 0u);
  size_t wrong = 0;
  for (int i = 1; i < 10; ++i) {
    const auto [eye, target] = straight({0.3f * f(i), 2, 6});
    rig.frame(perspective_camera(eye, target, 64, 40));
    wrong = rig.wrong_texels(0);
    EXPECT_EQ(rig.wrong_texels(1), 0u);
  }
  EXPECT_GT(wrong, 100u);
  // Every wrong texel lacks a caster: none is nearer than in the redraw.
  for (size_t cascade = 0; cascade < 3; ++cascade) {
    const auto have = rig.finished(0, cascade), want = rig.fresh(0, cascade);
    for (size_t i = 0; i < want.size(); ++i) ASSERT_GE(have[i], want[i]);
  }
}

TEST_F(Cascading, TheListingAsPrintedLosesDepthsForGood) {  // E18
  // A plate far above the volume and one far below it, larger than every map: no straddler, depth alone. Away from the light until
  // the ground is forgotten and the plate clamped, and back.
  TestScene scene;
  scene.meshes = {plane_mesh(1)};
  scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(400.0f), {0, 0, 0}), .mobility = Mobility::fixed},
                     {.mesh = 0, .world_from_mesh = affine(glm::mat3(2.0f), {0, 20, 0}), .mobility = Mobility::fixed}};
  CascadeRig rig(gpu(), scene, {small(Mode::scrolled_literal), small(Mode::scrolled)}, {0, -1, 0});
  size_t wrong = 0;
  for (const float height : {0.0f, -30.0f, -60.0f, -30.0f, 0.0f}) {
    rig.frame(perspective_camera({0, height, 0}, {0, height, -1}, 64, 40));
    wrong = rig.wrong_texels(0);
    EXPECT_EQ(rig.wrong_texels(1), 0u) << height;
  }
  EXPECT_GT(wrong, 100u);
}

TEST_F(Cascading, MapsHoldWhatThePlainRasteriserDraws) {
  TestScene scene = half_movable(40, 21);
  std::erase_if(scene.instances,
                [&](const TestInstance& instance) { return !scene.meshes[instance.mesh].uvs.empty(); });
  CascadeRig rig(gpu(), scene, {small(Mode::scrolled)}, kSun);
  for (int i = 0; i < 3; ++i) rig.frame(perspective_camera({0.4f * f(i), 2, 6}, {0, 1, 0}, 64, 40));
  size_t covered = 0;
  for (size_t cascade = 0; cascade < 3; ++cascade) {
    const shared::CascadeRecord& record = rig.record(0, cascade);
    reference::CascadeMap map({record.origin, static_cast<int>(record.side)});
    for (const TestInstance& instance : scene.instances) {
      const TestMesh& mesh = scene.meshes[instance.mesh];
      for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::array<glm::dvec3, 3> corners;
        for (size_t k = 0; k < 3; ++k)
          corners[k] = glm::dvec3(
              grid_position(record, transform(instance.world_from_mesh, mesh.positions[mesh.indices[i + k]])));
        reference::draw_triangle(map, corners);
      }
    }
    const auto have = rig.finished(0, cascade);
    size_t wrong = 0;
    for (size_t i = 0; i < have.size(); ++i) {
      covered += map.depth[i] != shared::ClearDepth;
      wrong += std::abs(static_cast<int>(have[i]) - static_cast<int>(map.depth[i])) > 2;
    }
    EXPECT_LE(wrong, have.size() / 1000) << cascade;  // vertices are rounded otherwise: a 256th of a texel
  }
  EXPECT_GT(covered, 20000u);
}

TEST_F(Cascading, TrianglesBeyondTheGridAreCutNotLost) {
  TestScene scene;
  scene.meshes = {plane_mesh(1)};
  scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(1e7f), {0, 0, 0}), .mobility = Mobility::fixed}};
  CascadeRig rig(gpu(), scene, {small(Mode::scrolled)}, kSun);
  for (int i = 0; i < 4; ++i) {
    rig.frame(perspective_camera({0.5f * f(i), 2, 0}, {0, 1, -8}, 64, 40));
    EXPECT_EQ(rig.wrong_texels(0), 0u);
    for (size_t cascade = 0; cascade < 3; ++cascade)
      for (const uint32_t depth : rig.finished(0, cascade)) ASSERT_NE(depth, shared::ClearDepth);
  }
}

TEST_F(Cascading, WorksWithoutCastersAndAfterTheLastIsGone) {
  TestScene scene;
  scene.meshes = {box_mesh()};
  CascadeRig rig(gpu(), scene, {small(Mode::scrolled)}, kSun);
  const CameraDesc camera = perspective_camera({0, 2, 6}, {0, 1, 0}, 64, 40);
  rig.frame(camera);
  EXPECT_EQ(rig.wrong_texels(0), 0u);
  const InstanceId box = take(rig.scene().add_instance({.mesh = rig.mesh(0)}));
  rig.frame(camera);
  EXPECT_EQ(rig.wrong_texels(0), 0u);
  take(rig.scene().remove(box));
  rig.frame(camera);
  for (const uint32_t depth : rig.finished(0, 0)) ASSERT_EQ(depth, shared::ClearDepth);
}

TEST_F(Cascading, ActiveCastersBehindStaticOnesAreNotDrawn) {  // C4
  TestScene scene;
  scene.meshes = {plane_mesh(4), box_mesh()};
  scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(100.0f), {0, 10, 0}), .mobility = Mobility::fixed},
                     {.mesh = 1, .world_from_mesh = affine(glm::mat3(0.5f), {0, 2, 0})},
                     {.mesh = 1, .world_from_mesh = affine(glm::mat3(0.5f), {0, 12, 0})}};
  CascadeRig rig(gpu(), scene, {small(Mode::scrolled)}, {0, -1, 0});
  for (int i = 0; i < 3; ++i) {
    rig.frame(perspective_camera({0, 2, 4}, {0, 1, 0}, 64, 40));
    EXPECT_EQ(rig.wrong_texels(0), 0u);
    for (const shared::CascadeState& state : rig.states(0)) {
      EXPECT_EQ(state.actives, 2u);
      EXPECT_EQ(state.occluded, 1u);
      EXPECT_EQ(state.active_triangles, 12u);
    }
  }
}

TEST_F(Cascading, DeclaresEveryHazard) {
  gpu::HazardLog log;
  CascadeRig rig(gpu(), half_movable(30, 2), {small(Mode::scrolled)}, kSun);
  rig.log = &log;
  for (int i = 0; i < 3; ++i) rig.frame(perspective_camera({0.4f * f(i), 2, 6}, {0, 1, 0}, 64, 40));
  EXPECT_GT(log.size(), 50u);
  for (const gpu::Hazard& hazard : gpu::find_hazards(log)) ADD_FAILURE() << hazard.text;
}

}  // namespace
}  // namespace umbrage::test
