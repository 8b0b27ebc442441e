// The lights of each cluster: the same through the tree and by trying all, none missing from any sample, few too many; what
// umbrage.glsl makes of them; and what happens when the lists outgrow their room.
#include <algorithm>
#include <array>
#include <cmath>

#include "cluster_reader.hpp"
#include "reference/light_lists.hpp"

namespace umbrage::test {
namespace {

class LightLists : public GpuTest {};

constexpr uint32_t kListLights[] =
#include "shaders/list_lights_of_pixels.comp.inc"
    ;

reference::Light plain(const LightDesc& light) {
  static_assert(uint32_t(app::LightKind::point) == uint32_t(LightType::point) &&
                uint32_t(app::LightKind::spot) == uint32_t(LightType::spot) &&
                uint32_t(app::LightKind::directional) == uint32_t(LightType::directional));
  return {.kind = static_cast<app::LightKind>(light.type),
          .position = to_glm(light.position),
          .direction = glm::normalize(to_glm(light.direction)),
          .range = light.range_m,
          .outer_cone = light.outer_cone_rad};
}

reference::Box plain(const shared::Box& box) {
  reference::Box out;
  out.min = box.lo, out.max = box.hi;
  return out;
}

bool reaches(const LightDesc& light, const glm::vec3& position) {
  if (light.type == LightType::directional) return true;
  const glm::vec3 offset = position - to_glm(light.position);
  const float distance = glm::length(offset);
  if (distance > light.range_m) return false;
  return light.type == LightType::point ||
         glm::dot(offset, glm::normalize(to_glm(light.direction))) >= std::cos(light.outer_cone_rad) * distance;
}

struct LitPicture {
  TestScene scene;
  CameraDesc camera = perspective_camera({0, 5, 16}, {0, 1, 0}, 200, 137);
  Receivers seen = picture(camera, balls_on_ground);
  explicit LitPicture(uint32_t lights, uint32_t seed) : scene(mixed_scene(12, lights, seed)) {}
};

/// No sample lacks a light that reaches it, whichever of the clusters at a slice's border it belongs to.
void expect_nothing_lost(SystemRig& rig, const DeviceClusters& clusters, const LitPicture& lit) {
  const shared::CameraRecord& camera = clusters.record.camera;
  std::vector<std::vector<bool>> listed(clusters.cells.size() + 1, std::vector<bool>(rig.light_ids.size()));
  std::vector<uint32_t> index_of(rig.stages().scene.light_slots());
  for (uint32_t i = 0; i < rig.light_ids.size(); ++i) index_of[slot_of(rig.light_ids[i])] = i;
  for (uint32_t c = 0; c < listed.size(); ++c)
    for (const uint32_t slot : clusters.lights_of(c < clusters.cells.size() ? c : shared::NoIndex))
      listed[c][index_of[slot]] = true;
  uint64_t pairs = 0;
  for (uint32_t i = 0; i < lit.seen.depth.size(); ++i) {
    if (shared::is_background(lit.seen.depth[i])) continue;
    const uint32_t tile =
        i / lit.seen.width / shared::TileSide * camera.tiles.x + i % lit.seen.width / shared::TileSide;
    const glm::uvec2 slices = slices_of(camera, lit.seen.t[i]);
    const bool border = slices.x != slices.y;
    for (uint32_t light = 0; light < lit.scene.lights.size(); ++light) {
      if (!reaches(lit.scene.lights[light], lit.seen.positions[i])) continue;
      ++pairs;
      const uint32_t first = std::min<uint32_t>(clusters.cluster_of(tile, slices.x), uint32_t(clusters.cells.size()));
      const uint32_t second = std::min<uint32_t>(clusters.cluster_of(tile, slices.y), uint32_t(clusters.cells.size()));
      ASSERT_TRUE(listed[first][light] || (border && listed[second][light])) << "pixel " << i << ", light " << light;
    }
  }
  EXPECT_GT(pairs, 1000u);
}

/// A light is marked as used exactly when a cluster lists it.
void expect_used(SystemRig& rig, const DeviceClusters& clusters) {
  std::vector<bool> listed(rig.stages().scene.light_slots());
  for (uint32_t c = 0; c < clusters.cells.size(); ++c)
    for (const uint32_t slot : clusters.lights_of(c)) listed[slot] = true;
  const std::vector<uint32_t> used = rig.used_lights();
  for (uint32_t slot = 0; slot < used.size(); ++slot)
    EXPECT_EQ(used[slot], listed[slot] ? shared::LightIsUsed : 0u) << "slot " << slot;
  EXPECT_EQ(clusters.counters.lights_visible, std::count(listed.begin(), listed.end(), true));
  const auto lights = rig.lights();
  uint32_t views = 0;
  for (const shared::ShadowView& view : rig.views()) views += view.light != shared::NoIndex;
  EXPECT_EQ(clusters.counters.views_drawn, views);
  for (uint32_t slot = 0; slot < used.size(); ++slot)
    if (lights[slot].view_count) {
      EXPECT_EQ(rig.views()[lights[slot].first_view].light, listed[slot] ? slot : shared::NoIndex);
    }
}

TEST_F(LightLists, HoldWhatReachesAndLittleElse) {
  for (const uint32_t count : {0u, 1u, 31u, 170u}) {
    const LitPicture lit(count, 40 + count);
    SystemRig rig(gpu(), {.budget_mib = 16});
    rig.add(lit.scene);
    rig.show(lit.camera, lit.seen);
    rig.frame({.light_assignment = LightAssignment::hierarchy});
    const DeviceClusters clusters(rig);
    rig.frame({.light_assignment = LightAssignment::brute_force});
    const DeviceClusters tried(rig);
    ASSERT_EQ(tried.cells, clusters.cells);
    uint64_t pairs = 0;
    std::vector<reference::Light> lights(count);
    for (uint32_t i = 0; i < count; ++i) lights[i] = plain(lit.scene.lights[i]);
    for (uint32_t c = 0; c < clusters.cells.size(); ++c) {
      ASSERT_NE(clusters.lists[c].first, shared::NoIndex);
      ASSERT_EQ(clusters.lists[c].first, pairs) << "lists lie one behind the other";
      const std::vector<uint32_t> listed = clusters.lights_of(c);
      ASSERT_EQ(listed, tried.lights_of(c)) << "cluster " << c;
      pairs += listed.size();
      for (uint32_t i = 0; i < count; ++i) {
        const bool found = std::count(listed.begin(), listed.end(), slot_of(rig.light_ids[i])) == 1;
        const reference::Box box = plain(clusters.boxes[c]);
        reference::Light wider = lights[i];
        wider.range *= 1.001f, wider.outer_cone += 0.01f;
        reference::Box larger = box;
        larger.min -= 1e-3f * wider.range, larger.max += 1e-3f * wider.range;
        if (reference::range_meets(lights[i], box) && reference::cone_may_meet(lights[i], box)) {
          ASSERT_TRUE(found) << "cluster " << c << " lacks light " << i;
        }
        if (found) {
          ASSERT_TRUE(reference::range_meets(wider, larger) && reference::cone_may_meet(wider, larger))
              << "cluster " << c << " has light " << i;
        }
      }
    }
    EXPECT_EQ(clusters.counters.pairs_found, pairs);
    EXPECT_EQ(rig.system().statistics().cluster_light_pairs, pairs);
    EXPECT_EQ(rig.system().statistics().overflows, 0u);
    expect_used(rig, tried);
    if (count > 30) expect_nothing_lost(rig, clusters, lit);
  }
}

TEST_F(LightLists, TooLongForTheirRoomFallBackToAllLights) {
  const LitPicture lit(200, 9);
  SystemRig rig(gpu(), {.budget_mib = 16, .max_cluster_light_pairs = 1024});
  rig.add(lit.scene);
  rig.show(lit.camera, lit.seen);
  rig.frame();
  const DeviceClusters crowded(rig);
  ASSERT_EQ(crowded.record.pair_capacity, 1024u);
  ASSERT_GT(crowded.counters.pairs_found, 1024u);
  EXPECT_EQ(crowded.counters.all_lights_used, 1u);
  EXPECT_EQ(rig.system().statistics().overflows, 1u);
  EXPECT_EQ(rig.system().statistics().lights_visible, 200u);
  EXPECT_GT(std::count_if(crowded.lists.begin(), crowded.lists.end(),
                          [](const auto& list) { return list.first != shared::NoIndex; }),
            0);
  for (uint32_t c = 0; c < crowded.cells.size(); ++c) {
    if (crowded.lists[c].first == shared::NoIndex) { EXPECT_EQ(crowded.lists[c].count, 200u); }
  }
  expect_nothing_lost(rig, crowded, lit);
  for (const shared::ShadowView& view : rig.views()) EXPECT_NE(view.light, shared::NoIndex);

  rig.frame();  // knows how long they were
  const DeviceClusters grown(rig);
  EXPECT_GE(grown.record.pair_capacity, grown.counters.pairs_found);
  EXPECT_EQ(grown.counters.all_lights_used, 0u);
  EXPECT_EQ(rig.system().statistics().overflows, 0u);
  expect_nothing_lost(rig, grown, lit);
  expect_used(rig, grown);
}

TEST_F(LightLists, ReadTheSameThroughTheInclude) {
  struct Sample {
    glm::vec3 position;
    float depth;
  };
  struct Answer {
    uint32_t cluster, cluster_at, cell, inside_box;
    std::array<uint32_t, 8> lights, lights_at;
  };
  struct Push {
    VkDeviceAddress shadows, samples, answers;
    uint32_t width, height;
  };
  const LitPicture lit(170, 4);
  SystemRig rig(gpu(), {.budget_mib = 16});
  rig.add(lit.scene);
  rig.show(lit.camera, lit.seen);
  std::vector<Sample> samples;
  for (size_t i = 0; i < lit.seen.depth.size(); ++i) samples.push_back({lit.seen.positions[i], lit.seen.depth[i]});
  const gpu::Buffer input = gpu().upload(samples),
                    output = gpu().buffer(samples.size() * sizeof(Answer), gpu::MemoryKind::device, "answers");
  const VkDescriptorSetLayout layout = rig.system().descriptor_set_layout();
  const Program program(gpu(), kListLights, {&layout, 1});
  rig.frame({}, [&](VkCommandBuffer commands) {
    const ShaderInterface shadows = rig.system().shader_interface(rig.camera().id);
    program.dispatch(commands, shadows.set,
                     Push{shadows.frame, input.address(), output.address(), lit.seen.width, lit.seen.height},
                     (lit.seen.width + 7) / 8, (lit.seen.height + 7) / 8);
  });
  const auto answers = gpu().download<Answer>(output, samples.size());
  const DeviceClusters clusters(rig);
  const auto bits = [&](uint32_t cluster) {
    std::array<uint32_t, 8> out{};
    for (const uint32_t slot : clusters.lights_of(cluster)) {
      const auto light = static_cast<uint32_t>(
          std::find_if(rig.light_ids.begin(), rig.light_ids.end(), [&](LightId id) { return slot_of(id) == slot; }) -
          rig.light_ids.begin());
      out[light / 32] |= 1u << light % 32;
    }
    return out;
  };
  std::vector<std::array<uint32_t, 8>> expected;
  for (uint32_t c = 0; c < clusters.cells.size(); ++c) expected.push_back(bits(c));
  uint32_t elsewhere = 0;
  for (size_t i = 0; i < answers.size(); ++i) {
    const Answer& answer = answers[i];
    if (shared::is_background(samples[i].depth)) {
      ASSERT_EQ(answer.cluster, shared::NoIndex);
      ASSERT_EQ(answer.lights, (std::array<uint32_t, 8>{}));
      continue;
    }
    ASSERT_LT(answer.cluster, clusters.cells.size()) << "the device finds the cluster that it marked itself";
    ASSERT_EQ(answer.cell, clusters.cells[answer.cluster]);
    ASSERT_EQ(answer.lights, expected[answer.cluster]);
    ASSERT_EQ(answer.inside_box, 1u) << "pixel " << i;
    // By position, rounding may cross into a neighbour, which has all lights where nothing was seen in it.
    ASSERT_EQ(answer.lights_at,
              answer.cluster_at == shared::NoIndex ? bits(shared::NoIndex) : expected[answer.cluster_at]);
    elsewhere += answer.cluster_at != answer.cluster;
  }
  EXPECT_LE(elsewhere, answers.size() / 1000);
}

}  // namespace
}  // namespace umbrage::test
