// A device under validation for the tests here, and the few things they do with it: run commands, move bytes to and fro.
// Faults of the test itself throw; what the layers say is collected and fails the test.
#pragma once
#include <gtest/gtest.h>
#include <volk.h>

#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "gpu/memory.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/recorder.hpp"
#include "umbrage/device.hpp"

namespace umbrage::test {

template <class T>
T take(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}
inline void take(const Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}
void check(VkResult, const char* call);

class Gpu;

/// An image with one view, as hosts have it.
class Image {
 public:
  Image(const Gpu&, VkFormat, VkImageAspectFlags, uint32_t width, uint32_t height);
  Image(Image&&) noexcept;
  Image& operator=(Image&&) noexcept = delete;
  ~Image();
  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }
  VkImageAspectFlags aspect() const { return aspect_; }
  VkExtent3D extent() const { return extent_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  VkImage handle_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageAspectFlags aspect_ = 0;
  VkExtent3D extent_{};
};

/// A compute pipeline of the tests' own, over any set layouts and 128 bytes of push constants.
class Program {
 public:
  Program(const Gpu&, std::span<const uint32_t> spirv, std::span<const VkDescriptorSetLayout>);
  Program(const Program&) = delete;
  ~Program();
  VkPipelineLayout layout() const { return layout_; }
  VkPipeline pipeline() const { return pipeline_; }

  template <class Push>
  void dispatch(VkCommandBuffer commands, VkDescriptorSet set, const Push& push, uint32_t x, uint32_t y = 1) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    if (set) vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push), &push);
    vkCmdDispatch(commands, x, y, 1);
  }

 private:
  VkDevice device_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

/// Instance, device, queue and the library's own layer over them.
class Gpu {
 public:
  Gpu();
  Gpu(const Gpu&) = delete;
  ~Gpu();

  /// Records, submits, waits.
  void run(const std::function<void(VkCommandBuffer)>& record);
  VkCommandBuffer begin();
  void submit(VkCommandBuffer, VkFence);

  gpu::Buffer buffer(VkDeviceSize bytes, gpu::MemoryKind, const char* name);
  /// A device buffer that holds these bytes.
  gpu::Buffer upload(const void* data, size_t bytes);
  template <class T>
  gpu::Buffer upload(const std::vector<T>& values) {
    return upload(values.data(), values.size() * sizeof(T));
  }
  /// Fills an image, tightly packed, and leaves it in a layout that shaders read.
  void fill(const Image&, const void* texels, size_t bytes, VkImageLayout);
  /// Copies from a device buffer after everything submitted before.
  void read(const gpu::Buffer&, VkDeviceSize offset, void* data, size_t bytes);
  template <class T>
  std::vector<T> download(const gpu::Buffer& from, size_t count, VkDeviceSize offset = 0) {
    std::vector<T> values(count);
    if (count) read(from, offset, values.data(), count * sizeof(T));
    return values;
  }

  const DeviceDesc& desc() const { return desc_; }
  VkQueue queue() const { return queue_; }
  const gpu::Device& device() const { return *device_; }
  gpu::Memory& memory() { return *memory_; }
  const gpu::PipelineFactory& factory() const { return *factory_; }
  /// A recorder as the library makes them, with descriptor sets that nothing reads.
  gpu::Recorder recorder(VkCommandBuffer, gpu::HazardLog* = nullptr);
  /// Makes an image mask `slot` of recorders from now on.
  void set_mask(uint32_t slot, const Image&);
  /// What the validation layers have said since the last call.
  std::vector<std::string> take_messages() { return std::exchange(messages_, {}); }

 private:
  std::vector<std::string> messages_;
  std::unique_ptr<HeadlessDevice> owner_;
  DeviceDesc desc_;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool commands_ = VK_NULL_HANDLE;
  VkDescriptorPool sets_ = VK_NULL_HANDLE;
  VkDescriptorSet frame_set_ = VK_NULL_HANDLE, mask_set_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
  std::unique_ptr<gpu::Device> device_;
  std::unique_ptr<gpu::Memory> memory_;
  std::unique_ptr<gpu::PipelineFactory> factory_;
};

/// One device a suite; silent layers or the test fails.
class GpuTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { gpu_ = std::make_unique<Gpu>(); }
  static void TearDownTestSuite() { gpu_.reset(); }
  void TearDown() override;
  static Gpu& gpu() { return *gpu_; }

 private:
  inline static std::unique_ptr<Gpu> gpu_;
};

}  // namespace umbrage::test
