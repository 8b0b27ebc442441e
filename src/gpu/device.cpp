// Adopts the host's device: loads the function table, reads limits, opens the pipeline cache.
#include "gpu/device.hpp"

#include <algorithm>

namespace umbrage::gpu {

const char* result_name(VkResult result) {
  switch (result) {
    case VK_SUCCESS:
      return "VK_SUCCESS";
    case VK_NOT_READY:
      return "VK_NOT_READY";
    case VK_TIMEOUT:
      return "VK_TIMEOUT";
    case VK_INCOMPLETE:
      return "VK_INCOMPLETE";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
      return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED:
      return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT:
      return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
      return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
      return "VK_ERROR_FORMAT_NOT_SUPPORTED";
    case VK_ERROR_OUT_OF_POOL_MEMORY:
      return "VK_ERROR_OUT_OF_POOL_MEMORY";
    default:
      return "a Vulkan error";
  }
}

Error vulkan_error(VkResult result, const char* call, std::string_view what) {
  ErrorCode code = ErrorCode::vulkan;
  if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY) code = ErrorCode::out_of_memory;
  if (result == VK_ERROR_DEVICE_LOST) code = ErrorCode::device_lost;
  std::string text = call;
  if (!what.empty()) text.append(" (").append(what).append(")");
  return {code, text + ": " + result_name(result) + " (" + std::to_string(static_cast<int>(result)) + ")"};
}

Result<std::unique_ptr<Device>> Device::create(const DeviceDesc& desc) {
  if (!desc.instance || !desc.physical_device || !desc.device || !desc.get_instance_proc_addr)
    return Error{ErrorCode::invalid_argument,
                 "DeviceDesc: instance, physical_device, device and get_instance_proc_addr are all needed"};
  std::unique_ptr<Device> device(new Device);
  device->desc_ = desc;
  device->desc_.pipeline_cache = {};
  Functions& vk = device->functions_;
  if (const char* missing = vk.load_instance(desc.instance, desc.get_instance_proc_addr))
    return Error{ErrorCode::unsupported, std::string("the instance does not offer ") + missing};
  if (const char* missing = vk.load_device(desc.device, desc.enabled.debug_utils, desc.enabled.mesh_shader))
    return Error{ErrorCode::unsupported, std::string("the device does not offer ") + missing};

  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
  vk.vkGetPhysicalDeviceProperties2(desc.physical_device, &all);
  const VkPhysicalDeviceProperties& properties = all.properties;
  vk.vkGetPhysicalDeviceMemoryProperties(desc.physical_device, &device->memory_);
  uint32_t family_count = 0;
  vk.vkGetPhysicalDeviceQueueFamilyProperties(desc.physical_device, &family_count, nullptr);
  std::vector<VkQueueFamilyProperties> families(family_count);
  vk.vkGetPhysicalDeviceQueueFamilyProperties(desc.physical_device, &family_count, families.data());
  if (desc.queue_family >= family_count)
    return Error{ErrorCode::invalid_argument, "DeviceDesc: queue_family " + std::to_string(desc.queue_family) +
                                                  " is beyond the device's " + std::to_string(family_count)};
  const VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  if ((families[desc.queue_family].queueFlags & needed) != needed)
    return Error{ErrorCode::unsupported, "DeviceDesc: queue_family lacks graphics or compute"};

  device->name_ = properties.deviceName;
  device->driver_id_ = driver.driverID;
  device->binds_sparse_ = (families[desc.queue_family].queueFlags & VK_QUEUE_SPARSE_BINDING_BIT) != 0;
  Limits& limits = device->limits_;
  limits.min_storage_alignment = std::max<VkDeviceSize>(properties.limits.minStorageBufferOffsetAlignment, 16);
  limits.max_image_side =
      std::min(properties.limits.maxImageDimension2D,
               std::min(properties.limits.maxFramebufferWidth, properties.limits.maxFramebufferHeight));
  limits.sparse_address_bytes = properties.limits.sparseAddressSpaceSize;
  limits.max_image_layers = std::min(properties.limits.maxImageArrayLayers, properties.limits.maxFramebufferLayers);
  limits.max_draw_indirect_count = properties.limits.maxDrawIndirectCount;
  if (families[desc.queue_family].timestampValidBits > 0)
    limits.timestamp_period_ns = properties.limits.timestampPeriod;

  VkPipelineCacheCreateInfo cache{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  cache.initialDataSize = desc.pipeline_cache.size();
  cache.pInitialData = desc.pipeline_cache.data();
  const VkResult result =
      vk.vkCreatePipelineCache(desc.device, &cache, desc.allocation_callbacks, &device->pipeline_cache_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreatePipelineCache", "");
  return device;
}

Device::~Device() {
  if (pipeline_cache_) functions_.vkDestroyPipelineCache(desc_.device, pipeline_cache_, desc_.allocation_callbacks);
}

std::optional<VkExtent2D> sparse_page(const Functions& vk, VkPhysicalDevice physical, VkFormat format,
                                      VkImageUsageFlags usage) {
  uint32_t count = 0;
  const auto ask = [&](VkSparseImageFormatProperties* out) {
    vk.vkGetPhysicalDeviceSparseImageFormatProperties(physical, format, VK_IMAGE_TYPE_2D, VK_SAMPLE_COUNT_1_BIT, usage,
                                                      VK_IMAGE_TILING_OPTIMAL, &count, out);
  };
  ask(nullptr);
  std::vector<VkSparseImageFormatProperties> parts(count);
  ask(parts.data());
  for (const VkSparseImageFormatProperties& part : parts)
    if ((part.aspectMask & (VK_IMAGE_ASPECT_COLOR_BIT | VK_IMAGE_ASPECT_DEPTH_BIT)) != 0)
      return VkExtent2D{part.imageGranularity.width, part.imageGranularity.height};
  return std::nullopt;
}

VkImageFormatProperties Device::sparse_image_limits(VkFormat format, VkImageUsageFlags usage) const {
  VkImageFormatProperties limits{};
  const VkImageCreateFlags flags = VK_IMAGE_CREATE_SPARSE_BINDING_BIT | VK_IMAGE_CREATE_SPARSE_RESIDENCY_BIT;
  const VkResult result = functions_.vkGetPhysicalDeviceImageFormatProperties(
      desc_.physical_device, format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, usage, flags, &limits);
  return result == VK_SUCCESS ? limits : VkImageFormatProperties{};
}

int Device::memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred) const {
  int found = -1;
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = memory_.memoryTypes[i].propertyFlags;
    if (!(allowed & (1u << i)) || (flags & wanted) != wanted) continue;
    if ((flags & preferred) == preferred) return static_cast<int>(i);
    if (found < 0) found = static_cast<int>(i);
  }
  return found;
}

void Device::set_name(VkObjectType type, uint64_t handle, const char* name) const {
  if (!functions_.vkSetDebugUtilsObjectNameEXT || !name) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = name;
  functions_.vkSetDebugUtilsObjectNameEXT(desc_.device, &info);
}

void Device::message(Severity severity, std::string_view text) const {
  if (desc_.message) desc_.message(desc_.message_user, severity, text);
}

}  // namespace umbrage::gpu
