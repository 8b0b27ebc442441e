// The n-th Vulkan call fails, for every n: an error, the old state intact, nothing leaked.
#include <gtest/gtest.h>

#include "failing_vulkan.hpp"
#include "stub_host.hpp"
#include "umbrage/layered_pass.hpp"

namespace embedding {
namespace {

using umbrage::ErrorCode;

template <class T>
T take(umbrage::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}

class FailingCalls : public testing::Test {
 protected:
  FailingCalls()
      : device_(take(umbrage::HeadlessDevice::create({.get_instance_proc_addr = vkGetInstanceProcAddr}))),
        desc_(device_.desc()) {
    desc_.get_instance_proc_addr = &failing_vulkan::get_instance_proc_addr;
    failing_vulkan::fail_call(0, VK_SUCCESS);
  }

  auto create() { return umbrage::ShadowSystem::create(desc_, {.budget_mib = 8}); }

  static void expect_error(const umbrage::Error& error, size_t n, VkResult result) {
    EXPECT_FALSE(error.message.empty()) << n;
    EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
    if (result == VK_ERROR_DEVICE_LOST)
      EXPECT_EQ(error.code, ErrorCode::device_lost) << error.message;
    else
      EXPECT_EQ(error.code, ErrorCode::out_of_memory) << failing_vulkan::failed_call() << ": " << error.message;
  }

  umbrage::HeadlessDevice device_;
  umbrage::DeviceDesc desc_;
};

TEST_F(FailingCalls, CreateReportsAndFreesEverything) {
  size_t calls = 0;
  {
    const auto system = create();
    ASSERT_TRUE(system.ok()) << system.error().message;
    calls = failing_vulkan::calls();
  }
  ASSERT_GT(calls, 10u);
  ASSERT_TRUE(failing_vulkan::alive().empty()) << failing_vulkan::alive().begin()->first;
  for (size_t n = 1; n <= calls; n++) {
    const VkResult result = n % 3 == 0 ? VK_ERROR_DEVICE_LOST : VK_ERROR_OUT_OF_DEVICE_MEMORY;
    failing_vulkan::fail_call(n, result);
    const auto system = create();
    // vkGetPipelineCacheData and the like may be asked for in vain; nothing else may go unnoticed.
    ASSERT_FALSE(system.ok()) << "call " << n << ", " << failing_vulkan::failed_call() << ", failed unnoticed";
    expect_error(system.error(), n, result);
    ASSERT_TRUE(failing_vulkan::alive().empty())
        << failing_vulkan::alive().begin()->first << " leaked when " << failing_vulkan::failed_call() << " failed";
  }
}

TEST_F(FailingCalls, EditsAndFramesCanBeTriedAgain) {
  const Scene scene = Scene::room();
  const Convention camera_in_room = Convention::in_room();
  size_t calls = 1;
  std::vector<float> expected;
  for (size_t n = 0; n <= calls; n++) {
    {
      auto system = take(create());
      StubHost host(device_.desc(), device_.queue(), system.descriptor_set_layout());
      size_t refused = 0;
      const auto again = [&](const umbrage::Error& error) {
        expect_error(error, n, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        return ++refused == 1;
      };
      failing_vulkan::fail_call(n, VK_ERROR_OUT_OF_DEVICE_MEMORY);
      scene.add_to(system, again);
      const Visibility found = host.render(system, scene, camera_in_room, again);
      EXPECT_EQ(refused, n == 0 ? 0u : 1u) << "call " << n << ", " << failing_vulkan::failed_call() << ", unnoticed";
      if (n == 0) {
        calls = failing_vulkan::calls();
        expected = found.of;
        ASSERT_GT(calls, 0u);
      }
      EXPECT_EQ(found.of, expected) << "after " << failing_vulkan::failed_call() << " had failed";
    }
    ASSERT_TRUE(failing_vulkan::alive().empty())
        << failing_vulkan::alive().begin()->first << " leaked when " << failing_vulkan::failed_call() << " failed";
  }
}

TEST_F(FailingCalls, LayeredPassesReportAndFreeEverything) {
  const umbrage::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const uint32_t indices[] = {0, 1, 2};
  const umbrage::LayeredMesh mesh{.positions = corners, .indices = indices};
  const umbrage::LayeredInstance instance;
  /// Nothing, or the error of what failed.
  const auto create_all = [&]() -> umbrage::Result<void> {
    auto scene = umbrage::LayeredScene::create(desc_, {.meshes = {&mesh, 1}, .instances = {&instance, 1}});
    if (!scene) return scene.error();
    for (const auto writer : {umbrage::LayeredWriter::traditional, umbrage::LayeredWriter::compute}) {
      auto pass = umbrage::LayeredPass::create(*scene, {.writer = writer, .depth_format = VK_FORMAT_D16_UNORM});
      if (!pass) return pass.error();
    }
    return scene->begin_frame(1);
  };
  ASSERT_TRUE(create_all());
  const size_t calls = failing_vulkan::calls();
  ASSERT_GT(calls, 10u);
  for (size_t n = 1; n <= calls; n++) {
    const VkResult result = n % 3 == 0 ? VK_ERROR_DEVICE_LOST : VK_ERROR_OUT_OF_DEVICE_MEMORY;
    failing_vulkan::fail_call(n, result);
    const auto made = create_all();
    ASSERT_FALSE(made.ok()) << "call " << n << ", " << failing_vulkan::failed_call() << ", failed unnoticed";
    expect_error(made.error(), n, result);
    ASSERT_TRUE(failing_vulkan::alive().empty())
        << failing_vulkan::alive().begin()->first << " leaked when " << failing_vulkan::failed_call() << " failed";
  }
}

}  // namespace
}  // namespace embedding
