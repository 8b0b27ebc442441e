// Device, function table, allocator, command buffer.
#include "host/gpu_context.hpp"

#include <vk_mem_alloc.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {

const char* result_name(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
      return "device lost";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "initialization failed";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
      return "format not supported";
    case VK_ERROR_TOO_MANY_OBJECTS:
      return "too many objects";
    default:
      return "error";
  }
}

/// What the host's own passes use besides what the library requires.
umbrage::HeadlessDesc headless_desc(const std::string& device, bool validate) {
  umbrage::HeadlessDesc desc;
  desc.get_instance_proc_addr = vkGetInstanceProcAddr;
  desc.device = device;
  desc.validate = validate;
  desc.wanted = {.geometry_shader = true,
                 .vertex_layer = true,
                 .multiview = true,
                 .mesh_shader = true,
                 .sparse_residency = true,
                 .shader_residency = true};
  desc.features.multiDrawIndirect = VK_TRUE;
  desc.features.drawIndirectFirstInstance = VK_TRUE;
  desc.features.shaderInt64 = VK_TRUE;
  desc.features_12.drawIndirectCount = VK_TRUE;
  desc.features_12.bufferDeviceAddress = VK_TRUE;
  desc.features_12.scalarBlockLayout = VK_TRUE;
  desc.features_12.descriptorIndexing = VK_TRUE;
  desc.features_12.runtimeDescriptorArray = VK_TRUE;
  desc.features_12.shaderSampledImageArrayNonUniformIndexing = VK_TRUE;
  desc.features_12.descriptorBindingPartiallyBound = VK_TRUE;
  desc.features_13.dynamicRendering = VK_TRUE;
  desc.features_13.synchronization2 = VK_TRUE;
  return desc;
}

/// Drivers that draw on the CPU take the lists of a pass's triangles from the heap and free them after it, tens of
/// megabytes in every frame. Given back to the kernel, their pages would be faulted in anew each time.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kWholeHeap = std::numeric_limits<int>::max(), kLargestBlock = 32 << 20;  // bytes; glibc takes no more
  mallopt(M_TRIM_THRESHOLD, kWholeHeap);
  mallopt(M_MMAP_THRESHOLD, kLargestBlock);
#endif
}

}  // namespace

Error vulkan_error(const char* call, VkResult result) {
  const ErrorCode code = result == VK_ERROR_DEVICE_LOST ? ErrorCode::device_lost
                         : result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY
                             ? ErrorCode::out_of_memory
                             : ErrorCode::vulkan;
  return {code, std::string(call) + " failed: " + result_name(result) + " (" + std::to_string(result) + ")"};
}

DeviceBuffer::~DeviceBuffer() {
  if (buffer_ != VK_NULL_HANDLE) vmaDestroyBuffer(allocator_, buffer_, allocation_);
}

void DeviceBuffer::swap(DeviceBuffer& other) noexcept {
  std::swap(allocator_, other.allocator_);
  std::swap(allocation_, other.allocation_);
  std::swap(buffer_, other.buffer_);
  std::swap(address_, other.address_);
  std::swap(size_, other.size_);
  std::swap(mapped_, other.mapped_);
}

void GpuContext::on_message(void* user, umbrage::Severity severity, std::string_view text) {
  if (severity == umbrage::Severity::info) return;
  static_cast<GpuContext*>(user)->messages_.fetch_add(1);
  std::fprintf(stderr, "umbrage: validation: %.*s\n", static_cast<int>(text.size()), text.data());
}

Result<std::unique_ptr<GpuContext>> GpuContext::create(const std::string& device, bool validate) {
  if (const VkResult result = volkInitialize(); result != VK_SUCCESS) {
    return Error{ErrorCode::unsupported, "no Vulkan loader found: install libvulkan1 and a Vulkan 1.3 driver"};
  }
  std::unique_ptr<GpuContext> context(new GpuContext);
  umbrage::HeadlessDesc desc = headless_desc(device, validate);
  desc.message = &GpuContext::on_message;
  desc.message_user = context.get();
  auto headless = umbrage::HeadlessDevice::create(desc);
  if (!headless) return headless.error();
  context->headless_ = std::make_unique<umbrage::HeadlessDevice>(std::move(headless).value());

  volkLoadInstanceOnly(context->headless_->desc().instance);
  volkLoadDeviceTable(&context->vk, context->device());
  VkPhysicalDeviceVulkan11Properties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups};
  vkGetPhysicalDeviceProperties2(context->physical_device(), &properties);
  context->limits_ = properties.properties.limits;
  if ((subgroups.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0 ||
      (subgroups.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT) == 0) {
    return Error{ErrorCode::unsupported,
                 std::string(properties.properties.deviceName) + " cannot add up within subgroups, which shading does"};
  }
  if (properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) keep_freed_memory();
  if (auto made = context->create_allocator(); !made) return made.error();
  if (auto made = context->create_queue_objects(); !made) return made.error();
  return context;
}

Result<void> GpuContext::create_allocator() {
  VmaVulkanFunctions functions{};
  functions.vkGetInstanceProcAddr = vkGetInstanceProcAddr;
  functions.vkGetDeviceProcAddr = vkGetDeviceProcAddr;
  VmaAllocatorCreateInfo info{};
  info.flags = VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT;
  info.physicalDevice = physical_device();
  info.device = device();
  info.instance = headless_->desc().instance;
  info.pVulkanFunctions = &functions;
  info.vulkanApiVersion = VK_API_VERSION_1_3;
  if (const VkResult result = vmaCreateAllocator(&info, &allocator_); result != VK_SUCCESS) {
    return vulkan_error("vmaCreateAllocator", result);
  }
  return {};
}

Result<void> GpuContext::create_queue_objects() {
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool_info.queueFamilyIndex = headless_->desc().queue_family;
  VkCommandPool pool = VK_NULL_HANDLE;
  if (const VkResult result = vk.vkCreateCommandPool(device(), &pool_info, nullptr, &pool); result != VK_SUCCESS) {
    return vulkan_error("vkCreateCommandPool", result);
  }
  pool_ = {device(), pool, vk.vkDestroyCommandPool};

  VkCommandBufferAllocateInfo commands_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  commands_info.commandPool = pool;
  commands_info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  commands_info.commandBufferCount = 1;
  if (const VkResult result = vk.vkAllocateCommandBuffers(device(), &commands_info, &commands_); result != VK_SUCCESS) {
    return vulkan_error("vkAllocateCommandBuffers", result);
  }

  VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  if (const VkResult result = vk.vkCreateFence(device(), &fence_info, nullptr, &fence); result != VK_SUCCESS) {
    return vulkan_error("vkCreateFence", result);
  }
  fence_ = {device(), fence, vk.vkDestroyFence};
  return {};
}

GpuContext::~GpuContext() {
  fence_ = {};
  pool_ = {};
  if (allocator_ != VK_NULL_HANDLE) vmaDestroyAllocator(allocator_);
}

bool GpuContext::supports(VkFormat format, VkFormatFeatureFlags features) const {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(physical_device(), format, &properties);
  return (properties.optimalTilingFeatures & features) == features;
}

Result<DeviceBuffer> GpuContext::create_buffer(VkDeviceSize bytes, Memory memory, const char* buffer_name,
                                               VkBufferUsageFlags usage) const {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VmaAllocationCreateInfo allocation{};
  allocation.usage = VMA_MEMORY_USAGE_AUTO;
  // Coherent memory: the passes then need no flushes and no invalidations by hand.
  if (memory != Memory::device) allocation.requiredFlags = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  if (memory == Memory::upload) {
    allocation.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT;
  }
  if (memory == Memory::read_back) {
    allocation.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT;
  }
  DeviceBuffer buffer;
  buffer.allocator_ = allocator_;
  buffer.size_ = bytes;
  VmaAllocationInfo placed{};
  const VkResult result =
      vmaCreateBuffer(allocator_, &info, &allocation, &buffer.buffer_, &buffer.allocation_, &placed);
  if (result != VK_SUCCESS) {
    Error error = vulkan_error("vmaCreateBuffer", result);
    error.message += std::string(": ") + buffer_name + ", " + std::to_string(bytes) + " bytes";
    return error;
  }
  buffer.mapped_ = static_cast<std::byte*>(placed.pMappedData);
  VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  address.buffer = buffer.buffer_;
  buffer.address_ = vk.vkGetBufferDeviceAddress(device(), &address);
  name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(buffer.buffer_), buffer_name);
  return buffer;
}

Result<DeviceBuffer> GpuContext::upload(std::span<const std::byte> bytes, const char* buffer_name,
                                        VkBufferUsageFlags usage) {
  auto buffer = create_buffer(std::max<VkDeviceSize>(bytes.size(), 16), Memory::device, buffer_name, usage);
  if (!buffer || bytes.empty()) return buffer;
  constexpr size_t chunk_bytes = size_t{16} << 20;
  auto staging = create_buffer(std::min(bytes.size(), chunk_bytes), Memory::upload, "staging");
  if (!staging) return staging.error();
  for (size_t offset = 0; offset < bytes.size(); offset += chunk_bytes) {
    const auto chunk = bytes.subspan(offset, std::min(chunk_bytes, bytes.size() - offset));
    staging->write(chunk);
    auto commands = begin();
    if (!commands) return commands.error();
    const VkBufferCopy region{0, offset, chunk.size()};
    vk.vkCmdCopyBuffer(*commands, staging->get(), buffer->get(), 1, &region);
    memory_barrier(*this, *commands, transfer_write, any_shader_read);
    if (auto done = submit_and_wait(); !done) return done.error();
  }
  return buffer;
}

Result<VkCommandBuffer> GpuContext::begin() {
  if (const VkResult result = vk.vkResetCommandPool(device(), pool_.get(), 0); result != VK_SUCCESS) {
    return vulkan_error("vkResetCommandPool", result);
  }
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  if (const VkResult result = vk.vkBeginCommandBuffer(commands_, &info); result != VK_SUCCESS) {
    return vulkan_error("vkBeginCommandBuffer", result);
  }
  return commands_;
}

Result<void> GpuContext::submit_and_wait() {
  if (const VkResult result = vk.vkEndCommandBuffer(commands_); result != VK_SUCCESS) {
    return vulkan_error("vkEndCommandBuffer", result);
  }
  VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  commands.commandBuffer = commands_;
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &commands;
  if (const VkResult result = vk.vkQueueSubmit2(headless_->queue(), 1, &submit, fence_.get()); result != VK_SUCCESS) {
    return vulkan_error("vkQueueSubmit2", result);
  }
  constexpr uint64_t forever = std::numeric_limits<uint64_t>::max();
  if (const VkResult result = vk.vkWaitForFences(device(), 1, fence_.address(), VK_TRUE, forever);
      result != VK_SUCCESS) {
    return vulkan_error("vkWaitForFences", result);
  }
  if (const VkResult result = vk.vkResetFences(device(), 1, fence_.address()); result != VK_SUCCESS) {
    return vulkan_error("vkResetFences", result);
  }
  return {};
}

void GpuContext::name(VkObjectType type, uint64_t object, const char* text) const {
  if (!headless_->desc().enabled.debug_utils || vkSetDebugUtilsObjectNameEXT == nullptr) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = object;
  info.pObjectName = text;
  vkSetDebugUtilsObjectNameEXT(device(), &info);
}

void memory_barrier(const GpuContext& context, VkCommandBuffer commands, Access from, Access to) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = from.stages;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stages;
  barrier.dstAccessMask = to.access;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  context.vk.vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace app
