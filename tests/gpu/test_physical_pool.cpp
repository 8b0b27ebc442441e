// The pool of whole cube maps (O14): who gets which image, what is drawn into it, and what lookups make of 16 bits.
#include <algorithm>
#include <cmath>

#include "pair_rig.hpp"

namespace umbrage::test {
namespace {

class PhysicalPool : public GpuTest {};

constexpr uint32_t kReadLayers[] =
#include "shaders/read_layers.comp.inc"
    ;

/// The layers of a map.
std::vector<float> texels_of(SystemRig& rig, const shared::MapRecord& map) {
  struct Push {
    VkDeviceAddress target;
    uint32_t image, first_layer, side;
  };
  const size_t count = size_t(map.resolution) * map.resolution * map.view_count;
  const gpu::Buffer target = rig.gpu().buffer(count * sizeof(float), gpu::MemoryKind::device, "texels of layers");
  const VkDescriptorSetLayout layout = rig.system().descriptor_set_layout();
  const Program program(rig.gpu(), kReadLayers, {&layout, 1});
  rig.gpu().run([&](VkCommandBuffer commands) {
    const Push push{target.address(), map.image, map.layer, map.resolution};
    const VkDescriptorSet set = rig.system().shader_interface(rig.camera().id).set;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout(), 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, program.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
    vkCmdDispatch(commands, (map.resolution + 15) / 16, (map.resolution + 15) / 16, map.view_count);
  });
  return rig.gpu().download<float>(target, count);
}

// --- Who gets what ----------------------------------------------------------------------------------------------------------

struct Placed {
  uint32_t image = shared::NoIndex, layer = 0;
};

/// The rule, one map after the other: the next free layers of the closest image, else of a coarser one; a second turn for those
/// that found none takes any image, coarse ones first. An image that had too little for one map is closed.
struct Placement {
  std::vector<Placed> of;
  std::vector<uint32_t> used;
  std::vector<bool> closed;
  const std::vector<shared::MapImage>& images;

  bool take(uint32_t map, uint32_t views, uint32_t image) {
    if (closed[image]) return false;
    if (used[image] + views > images[image].layers) return closed[image] = true, false;
    of[map] = {image, used[image]};
    used[image] += views;
    return true;
  }
  Placement(const DeviceMaps& maps, const std::vector<shared::MapImage>& all, const std::vector<uint32_t>& order)
      : of(maps.maps.size()), used(all.size()), closed(all.size()), images(all) {
    for (const uint32_t slot : order)
      for (uint32_t m = maps.light_maps[slot].first; m < maps.light_maps[slot].first + maps.light_maps[slot].count; ++m)
        for (uint32_t i = 0; i < images.size(); ++i)
          if (images[i].side <= std::max(maps.maps[m].asked, images.back().side) && take(m, maps.maps[m].view_count, i))
            break;
    std::fill(closed.begin(), closed.end(), false);
    for (const uint32_t slot : order)
      for (uint32_t m = maps.light_maps[slot].first; m < maps.light_maps[slot].first + maps.light_maps[slot].count; ++m)
        for (uint32_t i = static_cast<uint32_t>(images.size()); of[m].image == shared::NoIndex && i > 0; --i)
          take(m, maps.maps[m].view_count, i - 1);
  }
};

void expect_placed(PairRig& rig) {
  const DeviceMaps maps(rig);
  const std::vector<shared::MapImage>& images = rig.stages().images.layout().images;
  const auto order =
      rig.gpu().download<uint32_t>(rig.stages().scene.light_order_buffer(), rig.stages().scene.light_count());
  const Placement expected(maps, images, order);
  std::vector<bool> coarser(maps.light_maps.size());
  for (uint32_t m = 0; m < maps.maps.size(); ++m) {
    const shared::MapRecord& map = maps.maps[m];
    ASSERT_LT(map.image, images.size()) << "map " << m;
    ASSERT_EQ(map.image, expected.of[m].image) << "map " << m;
    ASSERT_EQ(map.layer, expected.of[m].layer) << "map " << m;
    EXPECT_EQ(map.resolution, images[map.image].side);
    if (map.resolution < map.asked) coarser[map.light] = true;
  }
  // Nearest in ratio: half and twice as fine are equally far from sqrt(2) times.
  for (size_t pair = 0; pair < maps.pair_maps.size(); ++pair) {
    if (maps.pair_maps[pair] == shared::NoIndex) continue;
    const shared::MapRecord& map = maps.maps[maps.pair_maps[pair]];
    if (map.receivers == shared::ReceiversInSight) { EXPECT_LT(maps.pair_requests[pair], float(map.asked) * 1.4143f); }
  }
  std::vector<bool> reported(maps.light_maps.size());
  for (const LightStatus& status : rig.system().degraded_lights())
    if (status.reason == Degradation::coarser) reported[slot_of(status.light)] = true;
  EXPECT_EQ(reported, coarser);
}

const FrameSettings kPaper{
    .layout = MapLayout::exact, .resolution = ResolutionForm::paper, .maps_per_light = 4, .min_resolution = 4};

TEST_F(PhysicalPool, GivesEachMapTheNextFreeImageOfTheClosestSize) {
  for (const uint32_t budget_mib : {4u, 16u, 256u}) {
    for (const FrameSettings& settings : {FrameSettings{}, kPaper, FrameSettings{.min_resolution = 512}}) {
      SCOPED_TRACE(std::to_string(budget_mib) + " MiB, least " + std::to_string(settings.min_resolution));
      PairRig rig(gpu(), {.store = Store::physical_pool, .budget_mib = budget_mib}, balls_scene(30, 60, 71));
      const Pairs answers = rig.settle(settings);
      EXPECT_EQ(differences(answers, rig.evaluate(settings)), 0u) << "a still picture flickers";
      EXPECT_LE(answers.statistics.shadow_memory_bytes, uint64_t(budget_mib) << 20);
      EXPECT_LE(answers.statistics.texels_allocated * 2, answers.statistics.shadow_memory_bytes);
      expect_placed(rig);
      if (budget_mib == 4 && settings.min_resolution == 512) { EXPECT_FALSE(rig.system().degraded_lights().empty()); }
    }
  }
}

TEST_F(PhysicalPool, HasAPlaceForThousandsOfLights) {
  PairRig rig(gpu(), {.store = Store::physical_pool, .budget_mib = 4}, balls_scene(20, 1000, 72, 32, 32));
  const FrameSettings settings{.undersampling = 4, .merge_below = 16};
  const Pairs answers = rig.settle(settings);
  EXPECT_EQ(differences(answers, rig.evaluate(settings)), 0u);
  expect_placed(rig);
  for (const LightStatus& status : rig.system().degraded_lights()) EXPECT_NE(status.reason, Degradation::no_map);
}

// --- What is drawn ------------------------------------------------------------------------------------------------------------

/// At the same resolution the hardware's 16 bits are the page pool's 32, rounded.
TEST_F(PhysicalPool, HoldsThePagePoolsDepthsIn16Bits) {
  const SeenScene scene = balls_scene(40, 12, 73);
  const FrameSettings frozen{.layout = MapLayout::exact,
                             .maps_per_light = 1,
                             .caster_culling = CasterCulling::view_mask,
                             .min_resolution = 256,
                             .max_resolution = 256};
  PairRig pages(gpu(), {}, scene), cubes(gpu(), {.store = Store::physical_pool}, scene);
  FrameSettings by_hardware = frozen;
  by_hardware.writer = Writer::fragments;
  pages.settle(by_hardware);
  cubes.settle(frozen);
  const DeviceMaps in_pages(pages), in_cubes(cubes);
  ASSERT_EQ(in_pages.maps.size(), in_cubes.maps.size());
  const auto pool =
      gpu().download<float>(pages.stages().pool.pool(), size_t(in_pages.counters.pool_units) * shared::PoolUnit);
  size_t texels = 0, drawn = 0, wrong = 0;
  for (size_t m = 0; m < in_pages.maps.size(); ++m) {
    const shared::MapRecord& map = in_pages.maps[m];
    ASSERT_EQ(map.resolution, in_cubes.maps[m].resolution);
    const std::vector<float> depths = texels_of(cubes, in_cubes.maps[m]);
    for (uint32_t view = 0; view < map.view_count; ++view)
      for (uint32_t y = 0; y < map.resolution; ++y)
        for (uint32_t x = 0; x < map.resolution; ++x) {
          const shared::PagePlace place = shared::page_place(map, view, {x, y});
          const uint32_t bits = in_pages.page_bits[place.word];
          if ((bits >> place.bit & 1) == 0) continue;
          const float exact =
              pool[shared::page_texel(bits, in_pages.page_first[place.word], place.bit, map.resolution) +
                   shared::texel_in_page({x, y}, map.resolution)];
          const float stored = depths[(size_t(view) * map.resolution + y) * map.resolution + x];
          ++texels, drawn += exact > 0;
          wrong += std::abs(stored - exact) > 0.51f / 65535;
        }
  }
  EXPECT_GT(texels, 500000u);
  EXPECT_GT(drawn, texels / 20);
  EXPECT_EQ(wrong, 0u) << "of " << texels;
}

TEST_F(PhysicalPool, AnswersTheSameWhateverIsCulled) {
  const SeenScene scene = balls_scene(60, 40, 74);
  PairRig rig(gpu(), {.store = Store::physical_pool}, scene);
  FrameSettings settings{.caster_culling = CasterCulling::light_volume};
  const Pairs all = rig.settle(settings);
  for (const CasterCulling culling : {CasterCulling::view_mask, CasterCulling::projection_map,
                                      CasterCulling::projection_map_depth, CasterCulling::receiver_grid}) {
    settings.caster_culling = culling;
    EXPECT_EQ(differences(all, rig.settle(settings)), 0u) << "culling " << int(culling);
  }
}

/// 16 bits may light what lies within a step of its caster, and nothing else changes.
TEST_F(PhysicalPool, AnswersAsThePagePoolBut16Bits) {
  const SeenScene scene = balls_scene(60, 40, 75);
  const FrameSettings frozen{
      .layout = MapLayout::exact, .maps_per_light = 1, .min_resolution = 256, .max_resolution = 256};
  const Pairs pages = PairRig(gpu(), {}, scene).settle(frozen),
              cubes = PairRig(gpu(), {.store = Store::physical_pool}, scene).settle(frozen);
  ASSERT_EQ(pages.visibility.size(), cubes.visibility.size());
  size_t darker = 0, other_side = 0, shadows = 0;
  for (size_t i = 0; i < pages.visibility.size(); ++i) {
    if (pages.visibility[i] < 0) continue;
    shadows += pages.visibility[i] < 0.5f;
    darker += cubes.visibility[i] < pages.visibility[i] - 0.01f;
    other_side += (pages.visibility[i] < 0.5f) != (cubes.visibility[i] < 0.5f);
  }
  EXPECT_GT(shadows, 500u);
  EXPECT_LE(darker, shadows / 1000);
  EXPECT_LE(other_side, shadows / 50);
}

TEST_F(PhysicalPool, FollowsEdits) {
  const SeenScene first = balls_scene(30, 20, 76), second = balls_scene(50, 90, 77);
  PairRig rig(gpu(), {.store = Store::physical_pool, .budget_mib = 32}, first);
  rig.settle();
  rig.replace(second);
  const Pairs after = rig.settle();
  EXPECT_EQ(differences(after, PairRig(gpu(), {.store = Store::physical_pool, .budget_mib = 32}, second).settle()), 0u);
}

TEST_F(PhysicalPool, IsRefusedWhereShadersCannotChooseTheLayer) {
  DeviceDesc desc = gpu().desc();
  desc.enabled.vertex_layer = false;
  const auto refused = ShadowSystem::create(desc, {.store = Store::physical_pool});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
  EXPECT_NE(refused.error().message.find("shaderOutputLayer"), std::string::npos);
  EXPECT_NE(refused.error().message.find(gpu().device().name()), std::string::npos);
}

}  // namespace
}  // namespace umbrage::test
