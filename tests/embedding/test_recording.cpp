// Recording allocates nothing, and systems are independent of each other: two threads, two systems.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include "stub_host.hpp"

namespace {
thread_local bool counting = false;
thread_local size_t allocations = 0;

void* allocate(size_t size) {
  if (counting) allocations++;
  return std::malloc(size == 0 ? 1 : size);
}
}  // namespace

void* operator new(size_t size) {
  if (void* memory = allocate(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
// Not inlined: GCC would see free() beside a call of operator new and take them for a mismatch.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace embedding {
namespace {

template <class T>
T take(umbrage::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}

TEST(Recording, AllocatesNothing) {
  const auto device = take(umbrage::HeadlessDevice::create({.get_instance_proc_addr = vkGetInstanceProcAddr}));
  auto system = take(umbrage::ShadowSystem::create(device.desc(), {.budget_mib = 32}));
  const Scene scene = Scene::room();
  scene.add_to(system);
  StubHost host(device.desc(), device.queue(), system.descriptor_set_layout());
  const Convention convention = Convention::in_room();
  for (int frame = 0; frame < 4; frame++) host.render(system, scene, convention);

  for (int frame = 0; frame < 3; frame++) {
    umbrage::CameraDesc camera;
    const umbrage::FrameDesc desc = host.describe(convention, camera);
    const vk::CommandBuffer commands = host.begin_commands();
    allocations = 0;
    counting = true;
    const bool begun = system.begin_frame(desc).ok();
    system.record_scene(commands);
    counting = false;
    EXPECT_TRUE(begun);
    EXPECT_EQ(allocations, 0u) << "begin_frame and record_scene, frame " << frame;
    host.draw(commands, scene, convention);
    allocations = 0;
    counting = true;
    system.record_shadows(commands);
    counting = false;
    EXPECT_EQ(allocations, 0u) << "record_shadows, frame " << frame;
    host.read(commands, system, scene, convention);
    host.submit_and_wait(commands);
  }
}

/// The counter above sees what the library allocates: here, an error's text.
TEST(Recording, SeesTheLibrarysAllocations) {
  allocations = 0;
  counting = true;
  const bool found = umbrage::preset("no such preset, by a name too long to be stored in place").ok();
  counting = false;
  EXPECT_FALSE(found);
  EXPECT_GT(allocations, 0u);
}

TEST(Threads, SystemsAreIndependent) {
  const Scene scene = Scene::room();
  std::vector<float> results[2];
  auto work = [&](std::vector<float>& result) {
    const auto device = take(umbrage::HeadlessDevice::create({.get_instance_proc_addr = vkGetInstanceProcAddr}));
    auto system = take(umbrage::ShadowSystem::create(device.desc(), {.budget_mib = 16}));
    scene.add_to(system);
    StubHost host(device.desc(), device.queue(), system.descriptor_set_layout());
    for (int frame = 0; frame < 3; frame++) result = host.render(system, scene, Convention::in_room()).of;
  };
  std::thread first(work, std::ref(results[0])), second(work, std::ref(results[1]));
  first.join();
  second.join();
  EXPECT_FALSE(results[0].empty());
  EXPECT_EQ(results[0], results[1]);
}

TEST(Threads, MeshesArePreparedAnywhere) {
  std::vector<umbrage::Vec3> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 3000; i++) {
    const float at = float(i);
    for (const umbrage::Vec3 corner : {umbrage::Vec3{at, 0, 0}, {at, 1, 0}, {at, 0, at}}) positions.push_back(corner);
    for (uint32_t corner = 0; corner < 3; corner++) indices.push_back(3 * i + corner);
  }
  std::vector<std::byte> results[2];
  auto work = [&](std::vector<std::byte>& result) { result = take(umbrage::prepare_mesh(positions, indices, {}, {})); };
  std::thread first(work, std::ref(results[0])), second(work, std::ref(results[1]));
  first.join();
  second.join();
  EXPECT_FALSE(results[0].empty());
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace embedding
