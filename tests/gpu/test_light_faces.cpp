// Point lights that shine through some faces of their cube only: dark beyond, elsewhere the same bits as whole ones, and less to draw.
#include <cmath>

#include "map_rig.hpp"
#include "pair_rig.hpp"

namespace umbrage::test {
namespace {

class LightFaces : public GpuTest {};

constexpr uint32_t kUp = 1u << 2, kDown = 1u << 3;

/// The face that a direction meets; false when another is within 1e-4 of it.
bool face_of(const glm::vec3& direction, uint32_t& face) {
  const glm::vec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  face = 2 * static_cast<uint32_t>(axis) + (direction[axis] < 0 ? 1 : 0);
  const float others = std::max(size[(axis + 1) % 3], size[(axis + 2) % 3]);
  return others < size[axis] * (1 - 1e-4f);
}

/// Every point light with some faces, all 63 of them in turn; lights that cast nothing are among them.
SeenScene cut(SeenScene scene) {
  for (size_t i = 0; i < scene.scene.lights.size(); ++i)
    scene.scene.lights[i].faces = 1 + static_cast<uint32_t>(i * 5) % 63;
  return scene;
}

/// No merging, so that what a pair gets does not depend on the others.
FrameSettings frozen(CasterCulling culling = CasterCulling::receiver_grid) {
  FrameSettings settings;
  settings.caster_culling = culling;
  settings.maps_per_light = 16;
  settings.merge_below = 16;
  return settings;
}

struct Seen {
  size_t lit = 0, dark = 0, cut_off = 0;
};

/// Holds the answers for cut lights against those for whole ones.
Seen hold_against(const Pairs& whole, const Pairs& some, const SeenScene& scene) {
  Seen seen;
  size_t wrong = 0, missing = 0;
  for (size_t i = 0; i < whole.visibility.size(); ++i) {
    if (whole.visibility[i] < 0) continue;
    const LightDesc& light = scene.scene.lights[i % whole.lights];
    uint32_t face = 0;
    if (!face_of(scene.seen.positions[i / whole.lights] - to_glm(light.position), face)) continue;
    if (light.type == LightType::point && (light.faces >> face & 1) == 0) {
      wrong += some.visibility[i] > 0;  // 0, or not in the cluster's list
      ++seen.cut_off;
    } else if (some.visibility[i] < 0) {
      ++missing;
    } else {
      wrong += whole.visibility[i] != some.visibility[i];
      ++(whole.visibility[i] > 0.5f ? seen.lit : seen.dark);
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(missing, 0u);
  return seen;
}

TEST_F(LightFaces, AnswerAsWholeLightsWhereTheyShine) {
  const SeenScene whole = balls_scene(60, 50, 71, 64, 48), some = cut(whole);
  for (const Store store : {Store::page_pool, Store::physical_pool, Store::hardware_sparse, Store::fixed_cubes}) {
    SCOPED_TRACE("store " + std::to_string(static_cast<int>(store)));
    const Pairs before = PairRig(gpu(), {.store = store}, whole).settle(frozen());
    const Pairs after = PairRig(gpu(), {.store = store}, some).settle(frozen());
    const Seen seen = hold_against(before, after, some);
    EXPECT_GT(seen.lit, 800u);
    EXPECT_GT(seen.dark, 200u);
    EXPECT_GT(seen.cut_off, 800u);
    EXPECT_EQ(after.statistics.unbacked_taps, 0u);
    if (store == Store::fixed_cubes) continue;
    EXPECT_LT(after.statistics.triangles_drawn, before.statistics.triangles_drawn);
    EXPECT_LT(after.statistics.cluster_light_pairs, before.statistics.cluster_light_pairs);
    if (store == Store::page_pool) { EXPECT_LT(after.statistics.texels_allocated, before.statistics.texels_allocated); }
  }
}

TEST_F(LightFaces, AreTheSameWithAnyCullingAndMarks) {
  const SeenScene some = cut(balls_scene(120, 70, 72));
  PairRig rig(gpu(), {}, some);
  const Pairs finest = rig.settle(frozen());
  for (const CasterCulling culling : {CasterCulling::light_volume, CasterCulling::view_mask,
                                      CasterCulling::projection_map, CasterCulling::projection_map_depth}) {
    const Pairs other = rig.settle(frozen(culling));
    EXPECT_EQ(differences(finest, other), 0u);
    EXPECT_EQ(other.statistics.unbacked_taps, 0u);
  }
  for (const ReceiverBoxes boxes : {ReceiverBoxes::clusters, ReceiverBoxes::blocks}) {
    FrameSettings settings = frozen();
    settings.receiver_boxes = boxes;
    EXPECT_EQ(differences(finest, rig.settle(settings)), 0u);
  }
}

TEST_F(LightFaces, FollowEdits) {
  SeenScene scene = balls_scene(80, 30, 73);
  PairRig rig(gpu(), {}, scene);
  const Pairs before = rig.settle(frozen());
  std::vector<LightDesc> lights = scene.scene.lights;
  for (LightDesc& light : lights) light.faces = kDown;
  ASSERT_TRUE(rig.system().set_lights(rig.light_ids, lights).ok());
  scene.scene.lights = lights;
  const Seen seen = hold_against(before, rig.settle(frozen()), scene);
  EXPECT_GT(seen.lit, 500u);
  EXPECT_GT(seen.cut_off, 500u);
  // Most of what is seen lies below the lamps.
  for (LightDesc& light : lights) light.faces = kUp;
  ASSERT_TRUE(rig.system().set_lights(rig.light_ids, lights).ok());
  scene.scene.lights = lights;
  const Pairs above = rig.settle(frozen());
  hold_against(before, above, scene);
  EXPECT_LT(above.statistics.triangles_drawn, before.statistics.triangles_drawn * 9 / 10);
  EXPECT_LT(above.statistics.texels_allocated, before.statistics.texels_allocated * 9 / 10);
  EXPECT_LT(above.statistics.cluster_light_pairs, before.statistics.cluster_light_pairs * 9 / 10);
  for (LightDesc& light : lights) light.faces = shared::AllCubeFaces;
  ASSERT_TRUE(rig.system().set_lights(rig.light_ids, lights).ok());
  EXPECT_EQ(differences(before, rig.settle(frozen())), 0u);
}

TEST_F(LightFaces, AreRefusedWhenThereAreNone) {
  SystemRig rig(gpu(), {});
  for (const uint32_t faces : {0u, 64u, 0xffffffffu}) {
    const auto added = rig.system().add_light({.faces = faces});
    ASSERT_FALSE(added.ok());
    EXPECT_EQ(added.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(added.error().message.find("LightDesc::faces"), std::string::npos);
  }
}

}  // namespace
}  // namespace umbrage::test
