// Casters as the device holds them: the triangles of their batches, and world boxes that follow every move and removal.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "system_rig.hpp"

namespace umbrage::test {
namespace {

class SceneOnDevice : public GpuTest {};

/// What the device knows of the casters, read back.
struct DeviceScene {
  std::vector<shared::CasterRecord> casters;
  std::vector<shared::BatchRecord> batches;
  std::vector<uint32_t> indices;
  std::vector<shared::Box> boxes;  // by caster

  explicit DeviceScene(SystemRig& rig) {
    scene::GpuScene& scene = rig.stages().scene;
    Gpu& gpu = rig.gpu();
    const uint32_t slots = scene.caster_slots();
    casters = gpu.download<shared::CasterRecord>(scene.caster_buffer(), slots);
    batches = gpu.download<shared::BatchRecord>(scene.batch_buffer(),
                                                scene.batch_buffer().size() / sizeof(shared::BatchRecord));
    indices = gpu.download<uint32_t>(scene.index_buffer(), scene.index_buffer().size() / sizeof(uint32_t));
    const auto order = gpu.download<uint32_t>(scene.caster_tree().order(), slots);
    const auto leaves = gpu.download<shared::Box>(scene.caster_tree().leaves(), slots);
    boxes.resize(slots);
    for (uint32_t i = 0; i < slots; ++i) boxes[order[i]] = leaves[i];
  }
};

using Triangle = std::array<uint32_t, 3>;

/// Every corner order of a triangle that keeps its winding, as one.
Triangle turned(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::vector<Triangle> sorted_triangles(const uint32_t* indices, size_t count) {
  std::vector<Triangle> triangles;
  for (size_t i = 0; i + 2 < count; i += 3) triangles.push_back(turned({indices[i], indices[i + 1], indices[i + 2]}));
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Box of a batch's vertices in double precision, and by how much a float sum of three products may be off it.
void expect_box(const shared::Box& box, const shared::BatchRecord& batch, const std::vector<uint32_t>& indices,
                const TestMesh& mesh, const Affine& world, const std::string& what) {
  for (int axis = 0; axis < 3; ++axis) {
    double lo = 1e30, hi = -1e30, rounding = 0;
    for (uint32_t i = 0; i < batch.index_count; ++i) {
      const Vec3& p = mesh.positions[indices[batch.first_index + i]];
      const float* row = &world.m[4 * axis];
      const double terms[] = {double(row[0]) * p.x, double(row[1]) * p.y, double(row[2]) * p.z, double(row[3])};
      const double value = terms[0] + terms[1] + terms[2] + terms[3];
      lo = std::min(lo, value), hi = std::max(hi, value);
      rounding = std::max(rounding, std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]) + std::abs(terms[3]));
    }
    rounding *= 3.0 / (1 << 24);
    ASSERT_NEAR(box.lo[axis], lo, rounding) << what << ", axis " << axis;
    ASSERT_NEAR(box.hi[axis], hi, rounding) << what << ", axis " << axis;
  }
}

/// Holds the device's scene against the test's: `alive[i]` says whether instance i of the scene still is.
void expect_scene(SystemRig& rig, const TestScene& scene, const std::vector<bool>& alive) {
  const DeviceScene device(rig);
  std::map<uint32_t, uint32_t> instance_of_slot;
  for (uint32_t i = 0; i < scene.instances.size(); ++i)
    if (alive[i]) instance_of_slot[slot_of(rig.instance_ids[i])] = i;
  std::map<uint32_t, std::vector<uint32_t>> drawn;  // indices by instance
  for (uint32_t c = 0; c < device.casters.size(); ++c) {
    const shared::CasterRecord caster = device.casters[c];
    if (caster.instance == shared::NoIndex) {
      EXPECT_TRUE(shared::box_is_empty(device.boxes[c])) << "caster " << c << " is nobody's";
      continue;
    }
    ASSERT_TRUE(instance_of_slot.count(caster.instance)) << "caster " << c << " belongs to a removed instance";
    const uint32_t i = instance_of_slot[caster.instance];
    const shared::BatchRecord& batch = device.batches[caster.batch];
    const auto first = device.indices.begin() + batch.first_index;
    drawn[i].insert(drawn[i].end(), first, first + batch.index_count);
    expect_box(device.boxes[c], batch, device.indices, scene.meshes[scene.instances[i].mesh],
               scene.instances[i].world_from_mesh, "caster " + std::to_string(c));
  }
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const bool casts = alive[i] && scene.instances[i].casts;
    const std::vector<uint32_t>& mesh = scene.meshes[scene.instances[i].mesh].indices;
    ASSERT_EQ(sorted_triangles(drawn[i].data(), drawn[i].size()),
              sorted_triangles(mesh.data(), casts ? mesh.size() : 0))
        << "instance " << i;
  }
}

TEST_F(SceneOnDevice, BoxesFollowEveryEdit) {
  TestScene scene = mixed_scene(300, 4, 1);
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.add(scene);
  rig.show_nothing();
  std::vector<bool> alive(scene.instances.size(), true);
  rig.frame();
  expect_scene(rig, scene, alive);

  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    TestInstance& instance = scene.instances[i];
    if (i % 5 == 1 && instance.mobility == Mobility::movable) {
      instance.world_from_mesh = random_affine(1000 + i, {float(i % 17) - 8, 40, float(i % 13) - 6});
      take(rig.system().set_transforms({&rig.instance_ids[i], 1}, {&instance.world_from_mesh, 1}));
    }
    if (i % 7 == 2) {
      take(rig.system().remove(rig.instance_ids[i]));
      alive[i] = false;
    }
  }
  rig.frame();
  expect_scene(rig, scene, alive);

  // Into the places of the removed ones, and beyond the buffers' first size.
  const TestScene more = mixed_scene(500, 0, 99);
  for (const TestInstance& instance : more.instances) {
    rig.add(instance);
    scene.instances.push_back(instance);
    alive.push_back(true);
  }
  rig.frame();
  expect_scene(rig, scene, alive);
  rig.frame();
  expect_scene(rig, scene, alive);
}

TEST_F(SceneOnDevice, MovedAndRemovedBeforeTheFirstFrame) {
  TestScene scene = mixed_scene(40, 1, 2);
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.add(scene);
  rig.show_nothing();
  std::vector<bool> alive(scene.instances.size(), true);
  for (uint32_t i = 0; i < scene.instances.size(); i += 4) {
    TestInstance& instance = scene.instances[i];
    if (instance.mobility == Mobility::fixed) continue;
    for (int move = 0; move < 3; ++move) {
      instance.world_from_mesh = random_affine(50 + i, {float(move), 1, float(i)});
      take(rig.system().set_transforms({&rig.instance_ids[i], 1}, {&instance.world_from_mesh, 1}));
    }
    if (i % 8 == 0) {
      take(rig.system().remove(rig.instance_ids[i]));
      alive[i] = false;
    }
  }
  rig.frame();
  expect_scene(rig, scene, alive);
}

TEST_F(SceneOnDevice, DeformedPositionsAreBoundWhenMarked) {
  const TestMesh mesh = box_mesh();
  std::vector<Vec3> moved = mesh.positions;
  for (Vec3& p : moved) p.y = 3 * p.y + 1;
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.show_nothing();
  const MeshId id = rig.add(mesh);
  const gpu::Buffer stream = gpu().upload(mesh.positions);
  const InstanceId instance = take(rig.system().add_instance(
      {.mesh = id, .mobility = Mobility::movable, .deformed = {stream.address(), sizeof(Vec3)}}));
  rig.frame();
  EXPECT_EQ(DeviceScene(rig).boxes[0].hi, glm::vec3(1, 1, 1));
  const gpu::Buffer next = gpu().upload(moved);
  gpu().run([&](VkCommandBuffer commands) {
    const VkBufferCopy all{0, 0, moved.size() * sizeof(Vec3)};
    vkCmdCopyBuffer(commands, next.handle(), stream.handle(), 1, &all);
  });
  rig.frame();
  EXPECT_EQ(DeviceScene(rig).boxes[0].hi, glm::vec3(1, 1, 1)) << "nothing has been announced";
  take(rig.system().mark_deformed({&instance, 1}));
  rig.frame();
  EXPECT_EQ(DeviceScene(rig).boxes[0].hi, glm::vec3(1, 4, 1));
  EXPECT_EQ(DeviceScene(rig).boxes[0].lo, glm::vec3(-1, -2, -1));
}

}  // namespace
}  // namespace umbrage::test
