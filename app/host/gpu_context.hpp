// The host's device: made through umbrage::HeadlessDevice, used through a function table and an allocator of its own.
#pragma once
#include <volk.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "umbrage/device.hpp"

VK_DEFINE_HANDLE(VmaAllocator)
VK_DEFINE_HANDLE(VmaAllocation)

namespace app {

umbrage::Error vulkan_error(const char* call, VkResult result);

/// A Vulkan object that is destroyed with its owner.
template <class T>
class Handle {
 public:
  using Destroy = void(VKAPI_PTR*)(VkDevice, T, const VkAllocationCallbacks*);
  Handle() = default;
  Handle(VkDevice device, T object, Destroy destroy) : device_(device), object_(object), destroy_(destroy) {}
  Handle(Handle&& other) noexcept
      : device_(other.device_), object_(std::exchange(other.object_, T{})), destroy_(other.destroy_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(object_, other.object_);
    std::swap(destroy_, other.destroy_);
    return *this;
  }
  ~Handle() {
    if (object_ != T{}) destroy_(device_, object_, nullptr);
  }
  T get() const { return object_; }
  const T* address() const { return &object_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  T object_{};
  Destroy destroy_ = nullptr;
};

enum class Memory : uint8_t {
  device,     ///< Fast for the device; filled through upload().
  upload,     ///< Mapped, written in order by the CPU.
  read_back,  ///< Mapped and cached, read by the CPU.
};

/// A buffer with an address. Mapped unless Memory::device.
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  DeviceBuffer(DeviceBuffer&& other) noexcept { swap(other); }
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~DeviceBuffer();
  VkBuffer get() const { return buffer_; }
  VkDeviceAddress address() const { return address_; }
  VkDeviceSize size() const { return size_; }
  std::byte* mapped() const { return mapped_; }
  /// Precondition: mapped, offset + bytes within the size.
  template <class T>
  void write(std::span<const T> values, VkDeviceSize offset = 0) {
    if (!values.empty()) std::memcpy(mapped_ + offset, values.data(), values.size_bytes());
  }

 private:
  friend class GpuContext;
  void swap(DeviceBuffer& other) noexcept;
  VmaAllocator allocator_ = VK_NULL_HANDLE;
  VmaAllocation allocation_ = VK_NULL_HANDLE;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceAddress address_ = 0;
  VkDeviceSize size_ = 0;
  std::byte* mapped_ = nullptr;
};

class GpuContext {
 public:
  /// device: as HeadlessDesc::device. Errors: no loader, no device, a feature that the host needs is missing.
  static umbrage::Result<std::unique_ptr<GpuContext>> create(const std::string& device, bool validate);
  GpuContext(const GpuContext&) = delete;
  GpuContext& operator=(const GpuContext&) = delete;
  ~GpuContext();

  VolkDeviceTable vk{};
  uint32_t shadow_store =
      0;  ///< ShadowSystem::shader_store(), specialization constant 1 of shaders that look up shadows.
  VkDevice device() const { return headless_->desc().device; }
  VkPhysicalDevice physical_device() const { return headless_->desc().physical_device; }
  const umbrage::HeadlessDevice& headless() const { return *headless_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  VmaAllocator allocator() const { return allocator_; }
  uint64_t validation_messages() const { return messages_.load(); }
  bool supports(VkFormat format, VkFormatFeatureFlags features) const;

  /// usage: besides addresses and transfers, which every buffer has. bytes > 0.
  umbrage::Result<DeviceBuffer> create_buffer(VkDeviceSize bytes, Memory memory, const char* name,
                                              VkBufferUsageFlags usage = 0) const;
  /// A device buffer with these contents; at least 16 bytes long.
  umbrage::Result<DeviceBuffer> upload(std::span<const std::byte> bytes, const char* name,
                                       VkBufferUsageFlags usage = 0);

  /// The one command buffer, reset and begun. The submission before has been waited for.
  umbrage::Result<VkCommandBuffer> begin();
  /// Ends and submits what begin() returned, and waits for it.
  umbrage::Result<void> submit_and_wait();
  void name(VkObjectType type, uint64_t object, const char* text) const;

 private:
  GpuContext() = default;
  umbrage::Result<void> create_queue_objects();
  umbrage::Result<void> create_allocator();
  static void on_message(void* user, umbrage::Severity severity, std::string_view text);

  std::atomic<uint64_t> messages_{0};
  std::unique_ptr<umbrage::HeadlessDevice> headless_;
  VkPhysicalDeviceLimits limits_{};
  VmaAllocator allocator_ = VK_NULL_HANDLE;
  Handle<VkCommandPool> pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Handle<VkFence> fence_;
};

/// Everything before that touches `from` is done and visible to `to`. For buffers; images have DeviceImage::use().
struct Access {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
};
void memory_barrier(const GpuContext& context, VkCommandBuffer commands, Access from, Access to);

constexpr Access compute_write{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access compute_access{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access transfer_read{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Access transfer_write{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr Access host_read{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
constexpr Access any_shader_read{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT};

}  // namespace app
