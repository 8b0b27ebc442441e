// The adopted device as every stage sees it: functions, limits, memory, errors.
#pragma once
#include <vulkan/vulkan_core.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/functions.hpp"
#include "umbrage/device.hpp"
#include "umbrage/result.hpp"

namespace umbrage::gpu {

/// "vkCreateBuffer (cluster words): VK_ERROR_OUT_OF_DEVICE_MEMORY", with the matching ErrorCode.
Error vulkan_error(VkResult, const char* call, std::string_view what);
const char* result_name(VkResult);

/// Texels of a page of sparse 2D images, if the device has such images.
std::optional<VkExtent2D> sparse_page(const Functions&, VkPhysicalDevice, VkFormat, VkImageUsageFlags);

/// Sets the features of those capabilities that need no extension.
void enable_capabilities(const Capabilities& wanted, Requirements&);

struct Limits {
  VkDeviceSize min_storage_alignment = 16;
  uint32_t max_image_side = 4096, max_image_layers = 256;
  uint32_t max_draw_indirect_count = 1;
  VkDeviceSize sparse_address_bytes = 0;
  float timestamp_period_ns = 0;  ///< 0: the queue family has no timestamps.
};

/// Immutable after create; shared by reference with everything that the system owns.
class Device {
 public:
  static Result<std::unique_ptr<Device>> create(const DeviceDesc&);
  ~Device();
  Device(const Device&) = delete;

  const Functions& vk() const { return functions_; }
  VkDevice handle() const { return desc_.device; }
  const VkAllocationCallbacks* callbacks() const { return desc_.allocation_callbacks; }
  const Limits& limits() const { return limits_; }
  const std::string& name() const { return name_; }
  VkDriverId driver_id() const { return driver_id_; }
  /// Whether the queue family binds sparse memory.
  bool binds_sparse() const { return binds_sparse_; }
  std::optional<VkExtent2D> sparse_page(VkFormat format, VkImageUsageFlags usage) const {
    return gpu::sparse_page(functions_, desc_.physical_device, format, usage);
  }
  /// Bytes and layers that one sparse image may have; zeros where there are none.
  VkImageFormatProperties sparse_image_limits(VkFormat, VkImageUsageFlags) const;
  const Capabilities& capabilities() const { return desc_.enabled; }
  VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
  /// Index of a memory type of `allowed` with all of `wanted`, preferring `preferred` too; -1 = none.
  int memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred = 0) const;
  void set_name(VkObjectType, uint64_t handle, const char* name) const;
  void message(Severity, std::string_view) const;

 private:
  Device() = default;
  Functions functions_;
  DeviceDesc desc_;
  Limits limits_;
  std::string name_;
  VkDriverId driver_id_ = VK_DRIVER_ID_MAX_ENUM;
  bool binds_sparse_ = false;
  VkPhysicalDeviceMemoryProperties memory_{};
  VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
};

}  // namespace umbrage::gpu
