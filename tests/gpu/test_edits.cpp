// Frames in flight and edits between them: whatever came and went, the last picture is that of a fresh system with what is
// left; what is refused changes nothing.
#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <random>

#include "system_rig.hpp"

namespace umbrage::test {
namespace {

class Edits : public GpuTest {};

/// Submissions that the device may still be working on, oldest first.
class Flight {
 public:
  explicit Flight(Gpu& gpu) : gpu_(gpu) {}
  Flight(const Flight&) = delete;
  ~Flight() { land(0); }

  void depart(uint64_t serial, VkCommandBuffer commands) {
    VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence fence;
    check(vkCreateFence(gpu_.desc().device, &info, nullptr, &fence), "vkCreateFence");
    gpu_.submit(commands, fence);
    flying_.push_back({serial, fence});
  }
  /// Waits until at most so many are left; returns the newest serial that has landed.
  uint64_t land(size_t left) {
    while (flying_.size() > left) {
      check(vkWaitForFences(gpu_.desc().device, 1, &flying_.front().fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
      landed_ = flying_.front().serial;
      vkDestroyFence(gpu_.desc().device, flying_.front().fence, nullptr);
      flying_.pop_front();
    }
    return landed_;
  }

 private:
  struct Entry {
    uint64_t serial;
    VkFence fence;
  };
  Gpu& gpu_;
  std::deque<Entry> flying_;
  uint64_t landed_ = 0;
};

/// A scene that is edited at random, and what of it is there.
struct Changing {
  SystemRig& rig;
  TestScene scene;
  std::vector<MeshId> meshes;  // by scene.meshes, 0: removed
  std::vector<InstanceId> instances;
  std::vector<LightId> lights;
  std::mt19937 engine{77};

  uint32_t below(size_t n) { return static_cast<uint32_t>(engine() % n); }
  void add_instances(uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
      const glm::vec3 at(float(below(24)) - 12, float(below(30)) / 10, float(below(24)) - 12);
      TestInstance instance{.mesh = below(scene.meshes.size()), .world_from_mesh = random_affine(below(1000), at)};
      if (!meshes[instance.mesh].value) continue;
      instances.push_back(take(rig.system().add_instance({.mesh = meshes[instance.mesh],
                                                          .world_from_mesh = instance.world_from_mesh,
                                                          .mobility = instance.mobility})));
      scene.instances.push_back(instance);
    }
  }
  void add_lights(uint32_t count) {
    const TestScene more = mixed_scene(0, count, below(1000));
    for (const LightDesc& light : more.lights) {
      lights.push_back(take(rig.system().add_light(light)));
      scene.lights.push_back(light);
    }
  }
  void move() {
    for (uint32_t i = 0; i < instances.size(); i += 3) {
      if (!instances[i].value) continue;
      scene.instances[i].world_from_mesh =
          random_affine(below(1000), {float(below(20)) - 10, 1, float(below(20)) - 10});
      take(rig.system().set_transforms({&instances[i], 1}, {&scene.instances[i].world_from_mesh, 1}));
    }
    for (uint32_t i = 0; i < lights.size(); i += 5) {
      if (!lights[i].value) continue;
      scene.lights[i].position.x += 0.5f;
      scene.lights[i].range_m *= 1.1f;
      take(rig.system().set_lights({&lights[i], 1}, {&scene.lights[i], 1}));
    }
  }
  template <class Id>
  void remove_some(std::vector<Id>& ids, uint32_t one_in) {
    for (Id& id : ids) {
      if (!id.value || below(one_in) != 0) continue;
      take(rig.system().remove(id));
      EXPECT_EQ(rig.system().remove(id).error().code, ErrorCode::stale_id);
      id = {};
    }
  }
  /// A mesh and all of its instances.
  void remove_mesh(uint32_t mesh) {
    EXPECT_EQ(rig.system().remove(meshes[mesh]).ok(),
              std::none_of(instances.begin(), instances.end(), [&](const InstanceId& id) {
                return id.value && scene.instances[size_t(&id - instances.data())].mesh == mesh;
              }));
    for (uint32_t i = 0; i < instances.size(); ++i) {
      if (!instances[i].value || scene.instances[i].mesh != mesh) continue;
      take(rig.system().remove(instances[i]));
      instances[i] = {};
    }
    (void)rig.system().remove(meshes[mesh]);  // unless the first attempt did it
    meshes[mesh] = {};
  }
  void add_mesh(const TestMesh& mesh) {
    meshes.push_back(rig.add(mesh));
    scene.meshes.push_back(mesh);
  }
};

void edit(Changing& changing, uint32_t frame) {
  if (frame == 1) {
    for (const TestMesh& mesh : {sphere_mesh(16, 24), box_mesh(), masked_mesh()}) changing.add_mesh(mesh);
    changing.add_instances(60);
    changing.add_lights(20);
  }
  if (frame % 3 == 2) changing.move();
  if (frame % 4 == 3) changing.remove_some(changing.instances, 4), changing.remove_some(changing.lights, 3);
  if (frame % 4 == 0) changing.add_lights(frame * 3);
  if (frame % 5 == 0) changing.add_instances(10 * frame);
  if (frame == 7 || frame == 12) {
    changing.remove_mesh(frame == 7 ? 0 : 2);
    changing.add_mesh(frame == 7 ? masked_mesh() : sphere_mesh(20, 20));
    changing.add_instances(40);
  }
  if (frame == 15) changing.remove_some(changing.lights, 1);  // all of them
  if (frame == 17) changing.add_lights(12);
}

TEST_F(Edits, OverFramesInFlightLeaveNothingBehind) {
  constexpr uint32_t kFrames = 24, kInFlight = 3;
  SystemRig rig(
      gpu(),
      {.frames_in_flight = kInFlight, .budget_mib = 16, .max_cluster_light_pairs = 1024, .max_caster_pairs = 1024});
  rig.show_nothing();
  Changing changing{.rig = rig};
  {
    Flight flight(gpu());
    for (uint32_t frame = 1; frame <= kFrames; ++frame) {
      edit(changing, frame);
      FrameDesc desc = rig.describe({.writer = frame % 6 == 5 ? Writer::traditional : Writer::multi_draw,
                                     .max_resolution = frame % 7 < 3 ? 32u : 64u});
      desc.completed_serial = flight.land(kInFlight - 1);
      take(rig.system().begin_frame(desc));
      VkCommandBuffer commands = gpu().begin();
      rig.system().record_scene(commands);
      rig.system().record_shadows(commands);
      flight.depart(desc.serial, commands);
    }
  }
  rig.frame({.max_resolution = 64});
  EXPECT_EQ(rig.system().statistics().serial, kFrames + 1);

  SystemRig fresh(gpu(), {.budget_mib = 16});
  fresh.show_nothing();
  for (const TestMesh& mesh : changing.scene.meshes) fresh.add(mesh);
  for (size_t i = 0; i < changing.instances.size(); ++i)
    if (changing.instances[i].value) fresh.add(changing.scene.instances[i]);
  std::map<uint32_t, LightDesc> left;  // in the order of slots, which is that of tiles
  for (size_t i = 0; i < changing.lights.size(); ++i)
    if (changing.lights[i].value) left[slot_of(changing.lights[i])] = changing.scene.lights[i];
  for (const auto& [slot, light] : left) take(fresh.system().add_light(light));
  fresh.frame({.max_resolution = 64});
  ASSERT_GE(left.size(), 10u);
  EXPECT_EQ(rig.system().statistics().casters, fresh.system().statistics().casters);
  EXPECT_EQ(rig.system().statistics().batches_drawn, fresh.system().statistics().batches_drawn);
  const Atlas edited = rig.atlas(), made = fresh.atlas();
  ASSERT_EQ(edited.depth.size(), made.depth.size());
  EXPECT_EQ(std::memcmp(edited.depth.data(), made.depth.data(), made.depth.size() * sizeof(float)), 0);
  EXPECT_GT(std::count_if(made.depth.begin(), made.depth.end(), [](float depth) { return depth != 0; }), 10000);
}

TEST_F(Edits, GiveMemoryBack) {
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.show_nothing();
  VkDeviceSize after_five = 0;
  for (uint32_t cycle = 0; cycle < 12; ++cycle) {
    Changing changing{.rig = rig};
    changing.add_mesh(sphere_mesh(30, 40));
    changing.add_mesh(masked_mesh());
    changing.add_instances(80);
    changing.add_lights(10);
    rig.frame({.max_resolution = 32});
    changing.remove_some(changing.lights, 1);
    changing.remove_mesh(0);
    changing.remove_mesh(1);
    rig.frame({.max_resolution = 32});
    rig.frame({.max_resolution = 32});
    const VkDeviceSize bytes = rig.state().memory->bytes_in_use(gpu::MemoryKind::device);
    if (cycle == 4) after_five = bytes;
    if (cycle > 4) { EXPECT_EQ(bytes, after_five) << "cycle " << cycle; }
  }
}

TEST_F(Edits, OfMasksWaitForFramesInFlight) {
  SystemRig rig(gpu(), {.frames_in_flight = 2, .budget_mib = 4});
  rig.show_nothing();
  const Image image(gpu(), VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, 1, 1);
  const auto add = [&] { return take(rig.system().add_mask(image.view())).value; };
  const uint32_t first = add();
  rig.frame();
  take(rig.system().remove(MaskId{first}));
  EXPECT_EQ(rig.system().remove(MaskId{first}).error().code, ErrorCode::stale_id);
  EXPECT_NE(add() & 0xfffff, first & 0xfffff) << "frame 1 may still read its descriptor";
  rig.frame();
  EXPECT_EQ(add() & 0xfffff, first & 0xfffff) << "frame 2, the first without it, has finished";
  rig.frame();
}

ErrorCode code(const Result<void>& result) { return result.ok() ? ErrorCode{} : result.error().code; }

TEST_F(Edits, ThatAreWrongAreRefusedAndChangeNothing) {
  const TestScene scene = mixed_scene(12, 6, 5);  // instance 3 is fixed
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.add(scene);
  rig.show_nothing();
  rig.frame({.max_resolution = 32});
  const Atlas before = rig.atlas();
  ShadowSystem& system = rig.system();
  const Affine there = random_affine(1, {0, 1, 0});
  Affine broken;
  broken.m[5] = NAN;
  const InstanceId pair[] = {rig.instance_ids[1], rig.instance_ids[3]};
  const Affine places[] = {there, there};
  EXPECT_EQ(code(system.set_transforms(pair, places)), ErrorCode::invalid_argument) << "the second is fixed";
  EXPECT_EQ(code(system.set_transforms({pair, 1}, places)), ErrorCode::invalid_argument) << "one id, two transforms";
  EXPECT_EQ(code(system.set_transforms({pair, 1}, {&broken, 1})), ErrorCode::invalid_argument);
  const InstanceId unknown{123456};
  EXPECT_EQ(code(system.set_transforms({&unknown, 1}, {&there, 1})), ErrorCode::stale_id);
  EXPECT_EQ(code(system.mark_deformed({pair, 1})), ErrorCode::invalid_argument) << "has no stream";
  EXPECT_EQ(code(system.remove(rig.mesh_ids[0])), ErrorCode::invalid_argument) << "has instances";
  EXPECT_EQ(code(system.remove(MeshId{})), ErrorCode::stale_id);
  EXPECT_EQ(code(system.remove(LightId{rig.light_ids[0].value + (1u << 20)})), ErrorCode::stale_id)
      << "of another generation";
  const LightId two[] = {rig.light_ids[0], rig.light_ids[1]};
  const LightDesc descs[] = {{.position = {9, 9, 9}}, {.range_m = -1}};
  EXPECT_EQ(code(system.set_lights(two, descs)), ErrorCode::invalid_argument) << "the second has no range";
  EXPECT_EQ(system.add_instance({.mesh = MeshId{99}}).error().code, ErrorCode::stale_id);
  EXPECT_EQ(system.add_light({.type = LightType::spot, .direction = {0, 0, 0}}).error().code,
            ErrorCode::invalid_argument);
  EXPECT_EQ(system.add_light({.type = LightType::spot, .outer_cone_rad = 2}).error().code, ErrorCode::invalid_argument);
  EXPECT_EQ(system.add_light({.range_m = INFINITY}).error().code, ErrorCode::invalid_argument);
  const uint32_t outside[] = {0, 1, 8};
  const TestMesh box = box_mesh();
  EXPECT_EQ(system.add_mesh({.positions = box.positions, .indices = outside}).error().code,
            ErrorCode::invalid_argument);
  rig.frame({.max_resolution = 32});
  const Atlas after = rig.atlas();
  EXPECT_EQ(std::memcmp(before.depth.data(), after.depth.data(), before.depth.size() * sizeof(float)), 0);
  EXPECT_EQ(system.statistics().lights, 6u);
}

TEST_F(Edits, BeyondTheLastSlotAreRefusedAndChangeNothing) {
  SystemRig rig(gpu(), {.budget_mib = 4});
  const TestMesh plane = plane_mesh(1);
  const MeshId mesh = take(rig.system().add_mesh({.positions = plane.positions, .indices = plane.indices}));
  std::vector<InstanceId> instances;
  Result<InstanceId> added = rig.system().add_instance({.mesh = mesh, .casts = false});
  for (; added.ok(); added = rig.system().add_instance({.mesh = mesh, .casts = false})) instances.push_back(*added);
  EXPECT_EQ(added.error().code, ErrorCode::out_of_memory);
  EXPECT_EQ(instances.size(), 1048576u);
  EXPECT_TRUE(rig.system().remove(instances.back()).ok());
  instances.back() = take(rig.system().add_instance({.mesh = mesh, .casts = false}));
  EXPECT_FALSE(rig.system().add_instance({.mesh = mesh}).ok());
  for (const InstanceId id : instances) ASSERT_TRUE(rig.system().remove(id).ok());
  EXPECT_TRUE(rig.system().remove(mesh).ok()) << "the refused ones count as instances";
}

TEST_F(Edits, StayPendingWhenAFrameIsRefused) {
  SystemRig rig(gpu(), {.frames_in_flight = 2, .budget_mib = 4});
  rig.show_nothing();
  for (int frame = 0; frame < 3; ++frame) rig.frame({.max_resolution = 32});
  rig.add(mixed_scene(12, 6, 5));
  const FrameDesc good = rig.describe({.max_resolution = 32});  // serial 4
  ASSERT_EQ(good.serial, 4u);
  const auto refused = [&](const char* why, const auto& spoil) {
    FrameDesc desc = good;
    CameraDesc camera = rig.camera();
    desc.cameras = {&camera, 1};
    spoil(desc, camera);
    const auto begun = rig.system().begin_frame(desc);
    ASSERT_FALSE(begun.ok()) << why;
    EXPECT_EQ(begun.error().code, ErrorCode::invalid_argument) << why;
  };
  refused("serials grow", [](FrameDesc& desc, CameraDesc&) { desc.serial = 3; });
  refused("a frame is not over before it begins", [](FrameDesc& desc, CameraDesc&) { desc.completed_serial = 4; });
  refused("two frames ago must be over", [](FrameDesc& desc, CameraDesc&) { desc.completed_serial = 1; });
  refused("no camera", [](FrameDesc& desc, CameraDesc&) { desc.cameras = {}; });
  refused("no depth", [](FrameDesc&, CameraDesc& camera) { camera.depth = VK_NULL_HANDLE; });
  refused("an encoding of nothing", [](FrameDesc&, CameraDesc& camera) { camera.normal = VK_NULL_HANDLE; });
  refused("no pixels", [](FrameDesc&, CameraDesc& camera) { camera.width = 0; });
  refused("a singular view", [](FrameDesc&, CameraDesc& camera) { camera.view_from_world = {{}}; });
  refused("no projection", [](FrameDesc&, CameraDesc& camera) { camera.clip_from_view = {{}}; });
  refused("not a number", [](FrameDesc&, CameraDesc& camera) { camera.view_from_world.m[13] = NAN; });
  refused("not a power of two", [](FrameDesc& desc, CameraDesc&) { desc.settings.max_resolution = 100; });
  refused("nothing between", [](FrameDesc& desc, CameraDesc&) { desc.settings.min_resolution = 512; });
  rig.frame({.max_resolution = 32});
  EXPECT_EQ(rig.system().statistics().lights, 6u);
  EXPECT_GT(rig.system().statistics().batches_drawn, 0u);
}

}  // namespace
}  // namespace umbrage::test
