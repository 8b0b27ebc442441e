// A host with its own way to Vulkan: linked prototypes or volk's globals, with or without an allocator of its own. It
// makes instance and device itself, lets umbrage adopt them, and takes everything down again.
#if defined(HOST_VOLK)
#define VOLK_IMPLEMENTATION
#include <volk.h>
#else
#include <vulkan/vulkan.h>
#endif
#if defined(HOST_ALLOCATOR)
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_IMPLEMENTATION
#include <vk_mem_alloc.h>
#endif

#include <cstdio>
#include <umbrage/umbrage.hpp>
#include <vector>

namespace {

int fail(const char* what, const std::string& why) {
  std::fprintf(stderr, "%s: %s\n", what, why.c_str());
  return 1;
}

VkInstance make_instance() {
#if defined(HOST_VOLK)
  if (volkInitialize() != VK_SUCCESS) return VK_NULL_HANDLE;
#endif
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
  VkInstance instance = VK_NULL_HANDLE;
  if (vkCreateInstance(&info, nullptr, &instance) != VK_SUCCESS) return VK_NULL_HANDLE;
#if defined(HOST_VOLK)
  volkLoadInstance(instance);
#endif
  return instance;
}

VkDevice make_device(VkPhysicalDevice physical_device, umbrage::Requirements& requirements) {
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = 0,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = requirements.chain(),
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = uint32_t(requirements.device_extensions.size()),
                                .ppEnabledExtensionNames = requirements.device_extensions.data()};
  VkDevice device = VK_NULL_HANDLE;
  if (vkCreateDevice(physical_device, &info, nullptr, &device) != VK_SUCCESS) return VK_NULL_HANDLE;
#if defined(HOST_VOLK)
  volkLoadDevice(device);
#endif
  return device;
}

#if defined(HOST_ALLOCATOR)
/// The host's own allocator works beside the library's.
bool allocate_buffer(VkInstance instance, VkPhysicalDevice physical_device, VkDevice device) {
  VmaVulkanFunctions functions{};
  functions.vkGetInstanceProcAddr = vkGetInstanceProcAddr;
  functions.vkGetDeviceProcAddr = vkGetDeviceProcAddr;
  VmaAllocatorCreateInfo info{};
  info.instance = instance;
  info.physicalDevice = physical_device;
  info.device = device;
  info.pVulkanFunctions = &functions;
  info.vulkanApiVersion = VK_API_VERSION_1_3;
  VmaAllocator allocator = VK_NULL_HANDLE;
  if (vmaCreateAllocator(&info, &allocator) != VK_SUCCESS) return false;

  VkBufferCreateInfo buffer_info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  buffer_info.size = 4096;
  buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VmaAllocationCreateInfo allocation_info{};
  allocation_info.usage = VMA_MEMORY_USAGE_AUTO;
  VkBuffer buffer = VK_NULL_HANDLE;
  VmaAllocation allocation = VK_NULL_HANDLE;
  const VkResult made = vmaCreateBuffer(allocator, &buffer_info, &allocation_info, &buffer, &allocation, nullptr);
  if (made == VK_SUCCESS) vmaDestroyBuffer(allocator, buffer, allocation);
  vmaDestroyAllocator(allocator);
  return made == VK_SUCCESS;
}
#endif

int run_system(const umbrage::DeviceDesc& desc) {
#if defined(HOST_ALLOCATOR)
  if (!allocate_buffer(desc.instance, desc.physical_device, desc.device)) return fail("allocator", "no buffer");
#endif
  const auto system = umbrage::ShadowSystem::create(desc, {.budget_mib = 16});
  if (!system) return fail("ShadowSystem::create", system.error().message);
  std::printf("%zu presets, the first is %s\n", umbrage::presets().size(), umbrage::presets()[0].name.data());
  return 0;
}

}  // namespace

int main() {
  VkInstance instance = make_instance();
  if (instance == VK_NULL_HANDLE) return fail("vkCreateInstance", "no instance");
  uint32_t count = 1;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  vkEnumeratePhysicalDevices(instance, &count, &physical_device);
  if (physical_device == VK_NULL_HANDLE) return fail("vkEnumeratePhysicalDevices", "no device");

  auto requirements = umbrage::requirements(instance, physical_device, vkGetInstanceProcAddr);
  if (!requirements) return fail("requirements", requirements.error().message);
  VkDevice device = make_device(physical_device, *requirements);
  if (device == VK_NULL_HANDLE) return fail("vkCreateDevice", "no device");

  umbrage::DeviceDesc desc;
  desc.instance = instance;
  desc.physical_device = physical_device;
  desc.device = device;
  desc.get_instance_proc_addr = vkGetInstanceProcAddr;
  const int result = run_system(desc);
  vkDestroyDevice(device, nullptr);
  vkDestroyInstance(instance, nullptr);
  return result;
}
