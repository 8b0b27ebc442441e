// Barriers: enough of them, by the checker that shares no code with the recorder, and none too many: with any one taken out
// the checker must object.
#include <map>
#include <set>

#include "gpu/hazards.hpp"
#include "system_rig.hpp"

namespace umbrage::test {
namespace {

using gpu::HazardEvent;
using gpu::HazardLog;

class Hazards : public GpuTest {};

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                kVertex = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, kCopy = VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr VkAccessFlags2 kRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT, kWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

HazardEvent access(uint32_t pass, VkPipelineStageFlags2 stages, VkAccessFlags2 mask,
                   VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED) {
  return {.resource = 1,
          .resource_name = "it",
          .pass = "pass",
          .pass_number = pass,
          .writes = (mask & kWrite) != 0,
          .stages = stages,
          .access = mask,
          .layout = layout};
}
HazardEvent barrier(VkPipelineStageFlags2 from, VkAccessFlags2 made_available, VkPipelineStageFlags2 to,
                    VkAccessFlags2 made_visible) {
  return {.kind = HazardEvent::Kind::barrier,
          .resource = 1,
          .resource_name = "it",
          .pass = "pass",
          .stages = from,
          .dst_stages = to,
          .access = made_available,
          .dst_access = made_visible};
}
HazardEvent to_layout(HazardEvent event, VkImageLayout from, VkImageLayout to) {
  event.old_layout = from, event.layout = to;
  return event;
}
size_t hazards(const HazardLog& log) { return gpu::find_hazards(log).size(); }

TEST(HazardChecker, SeesWhatIsNotOrdered) {
  const HazardEvent write = access(1, kCompute, kWrite), read = access(2, kCompute, kRead),
                    write_later = access(3, kCompute, kWrite);
  EXPECT_EQ(hazards({write, read}), 1u) << "read after write";
  EXPECT_EQ(hazards({write, write_later}), 1u) << "write after write";
  EXPECT_EQ(hazards({read, write_later}), 1u) << "write after read";
  EXPECT_EQ(hazards({read, access(3, kVertex, kRead)}), 0u) << "read after read";
  EXPECT_EQ(hazards({write, access(1, kCompute, kRead)}), 0u) << "within one pass";
  EXPECT_EQ(hazards({write, barrier(kCompute, kWrite, kCompute, kRead), read}), 0u);
  EXPECT_EQ(hazards({write, barrier(kCopy, kWrite, kCompute, kRead), read}), 1u) << "waits for other stages";
  EXPECT_EQ(hazards({write, barrier(kCompute, 0, kCompute, kRead), read}), 1u) << "makes nothing available";
  EXPECT_EQ(hazards({write, barrier(kCompute, kWrite, kVertex, kRead), read}), 1u) << "other stages wait";
  EXPECT_EQ(hazards({write, barrier(kCompute, kWrite, kCompute, kWrite), read}), 1u) << "visible to other accesses";
  EXPECT_EQ(hazards({barrier(kCompute, kWrite, kCompute, kRead), write, read}), 1u) << "too early";
  EXPECT_EQ(hazards({read, barrier(kCompute, 0, kCompute, 0), write_later}), 0u) << "a read needs execution only";
  HazardEvent elsewhere = barrier(kCompute, kWrite, kCompute, kRead);
  elsewhere.resource = 2;
  EXPECT_EQ(hazards({write, elsewhere, read}), 1u) << "another resource";
}

TEST(HazardChecker, SeesLayouts) {
  constexpr VkImageLayout kNone = VK_IMAGE_LAYOUT_UNDEFINED, kDepth = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                          kShown = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
  const HazardEvent first = to_layout(barrier(0, 0, kCompute, kWrite), kNone, kDepth),
                    then = to_layout(barrier(kCompute, kWrite, kVertex, kRead), kDepth, kShown);
  const HazardEvent write = access(1, kCompute, kWrite, kDepth), read = access(2, kVertex, kRead, kShown);
  EXPECT_EQ(hazards({first, write, then, read}), 0u);
  EXPECT_GT(hazards({write, then, read}), 0u) << "never brought into its layout";
  EXPECT_GT(hazards({first, write, barrier(kCompute, kWrite, kVertex, kRead), read}), 0u) << "left in another layout";
  EXPECT_GT(hazards({first, write, to_layout(barrier(kCompute, 0, kVertex, kRead), kDepth, kShown), read}), 0u)
      << "changed before the write is available";
  EXPECT_GT(hazards({first, write, then, read, to_layout(barrier(kCopy, 0, kCompute, kWrite), kShown, kDepth),
                     access(3, kCompute, kWrite, kDepth)}),
            0u)
      << "changed under a read";
}

/// Log of some frames in which everything happens: buffers grow, lists overflow, things move and go, writers change.
HazardLog eventful_frames(Gpu& gpu, Store store) {
  HazardLog log;
  SystemRig rig(gpu, {.budget_mib = 16, .max_cluster_light_pairs = 1024, .max_caster_pairs = 1024}, store);
  const Writer other = store == Store::fixed_cubes ? Writer::traditional : Writer::automatic;
  rig.state().hazard_log = &log;
  const CameraDesc camera = perspective_camera({0, 5, 16}, {0, 1, 0}, 96, 64);
  rig.show(camera, picture(camera, balls_on_ground));
  const FrameSettings small{.max_resolution = 32};
  rig.frame(small);  // an empty scene
  rig.add(mixed_scene(60, 20, 1));
  rig.frame(small);
  rig.frame(small);  // nothing changes
  for (uint32_t i = 0; i < 10; ++i) take(rig.system().remove(rig.instance_ids[3 * i]));
  take(rig.system().remove(rig.light_ids[4]));
  rig.add(mixed_scene(400, 120, 2));  // every buffer grows
  rig.frame(small);
  const Affine there = random_affine(1, {0, 2, 0});
  for (uint32_t i = 1; i < 20; i += 3)
    take(rig.system().set_transforms({&rig.instance_ids[i == 13 ? 14 : i], 1}, {&there, 1}));
  rig.frame({.light_assignment = LightAssignment::brute_force,
             .caster_culling = CasterCulling::light_volume,
             .max_resolution = 32});
  rig.frame({.writer = other, .max_resolution = 32});
  rig.frame({.writer = other, .max_resolution = 16});
  rig.frame(small, {}, VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT);
  const std::vector<Aabb> boxes{{{-4, 1, -4}, {-2, 2, 1}}, {{0, 0, 0}, {3, 3, 3}}};
  rig.camera().other_receivers = true, rig.camera().other_receivers_ws = boxes;
  rig.frame(small);
  rig.frame(small);
  rig.camera().other_receivers = false, rig.camera().other_receivers_ws = {};
  for (const LightId light : rig.light_ids)
    if (light.value != rig.light_ids[4].value) take(rig.system().remove(light));
  rig.frame(small);
  rig.frame({.writer = other, .max_resolution = 32});
  rig.state().hazard_log = nullptr;
  return log;
}

void expect_just_enough_barriers(const HazardLog& log) {
  for (const gpu::Hazard& hazard : gpu::find_hazards(log)) ADD_FAILURE() << hazard.text;

  std::map<uint64_t, HazardLog> by_resource;  // a barrier orders accesses of its own resource only
  for (const HazardEvent& event : log) by_resource[event.resource].push_back(event);
  size_t barriers = 0;
  std::set<std::string> needless;
  for (const auto& [resource, events] : by_resource) {
    for (size_t i = 0; i < events.size(); ++i) {
      if (events[i].kind != HazardEvent::Kind::barrier) continue;
      ++barriers;
      HazardLog without = events;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
      if (gpu::find_hazards(without).empty())
        needless.insert(std::string(events[i].pass) + ": " + events[i].resource_name);
    }
  }
  for (const std::string& text : needless) ADD_FAILURE() << "needless barrier in " << text;
  EXPECT_GT(barriers, 1000u);
  EXPECT_GT(by_resource.size(), 50u);
}

TEST_F(Hazards, AreNotThereAndNoBarrierIsTooManyInFixedCubes) {
  expect_just_enough_barriers(eventful_frames(gpu(), Store::fixed_cubes));
}
TEST_F(Hazards, AreNotThereAndNoBarrierIsTooManyInThePagePool) {
  expect_just_enough_barriers(eventful_frames(gpu(), Store::page_pool));
}
TEST_F(Hazards, AreNotThereAndNoBarrierIsTooManyInThePhysicalPool) {
  expect_just_enough_barriers(eventful_frames(gpu(), Store::physical_pool));
}
TEST_F(Hazards, AreNotThereAndNoBarrierIsTooManyInSparseImages) {
  expect_just_enough_barriers(eventful_frames(gpu(), Store::hardware_sparse));
}

}  // namespace
}  // namespace umbrage::test
