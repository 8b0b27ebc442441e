// Instance, device and queue for programs that bring none of their own.
#include <algorithm>
#include <cstring>

#include "gpu/device.hpp"

namespace umbrage {

namespace {
/// Where validation messages go; at a fixed address while the messenger lives.
struct MessageTarget {
  MessageCallback message = nullptr;
  void* user = nullptr;
};
}  // namespace

struct HeadlessDevice::State {
  gpu::Functions vk;
  PFN_vkGetInstanceProcAddr get = nullptr;
  PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
  Capabilities enabled;
  std::string name, driver;
  MessageTarget messages;

  ~State() {
    if (device) {
      vk.vkDeviceWaitIdle(device);
      vk.vkDestroyDevice(device, nullptr);
    }
    if (messenger) destroy_messenger(instance, messenger, nullptr);
    if (instance && vk.vkDestroyInstance) vk.vkDestroyInstance(instance, nullptr);
  }
};

namespace {
constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  const Severity level =
      (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) ? Severity::error : Severity::warning;
  const auto* target = static_cast<const MessageTarget*>(user);
  if (target->message) target->message(target->user, level, data->pMessage);
  return VK_FALSE;
}

Result<void> check_layer(PFN_vkGetInstanceProcAddr get) {
  const auto enumerate =
      reinterpret_cast<PFN_vkEnumerateInstanceLayerProperties>(get(nullptr, "vkEnumerateInstanceLayerProperties"));
  uint32_t count = 0;
  if (enumerate) enumerate(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  if (enumerate && enumerate(&count, layers.data()) != VK_SUCCESS) count = 0;
  const bool found = std::any_of(layers.begin(), layers.begin() + count,
                                 [](const auto& l) { return std::strcmp(l.layerName, kValidationLayer) == 0; });
  if (found) return {};
  return Error{ErrorCode::unsupported,
               std::string(kValidationLayer) + " is not installed (Debian: vulkan-validationlayers)"};
}

int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    default:
      return 3;
  }
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The device that was asked for, or the best one that umbrage can use.
Result<VkPhysicalDevice> choose(const gpu::Functions& vk, VkInstance instance, const HeadlessDesc& desc) {
  uint32_t count = 0;
  VkResult result = vk.vkEnumeratePhysicalDevices(instance, &count, nullptr);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkEnumeratePhysicalDevices", "");
  std::vector<VkPhysicalDevice> devices(count);
  result = vk.vkEnumeratePhysicalDevices(instance, &count, devices.data());
  if (result != VK_SUCCESS && result != VK_INCOMPLETE)
    return gpu::vulkan_error(result, "vkEnumeratePhysicalDevices", "");
  devices.resize(count);
  if (devices.empty())
    return Error{ErrorCode::unsupported, "no Vulkan device found (Debian: mesa-vulkan-drivers has one in software)"};

  std::string names, last_reason;
  VkPhysicalDevice best = VK_NULL_HANDLE;
  int best_rank = 4;
  for (uint32_t i = 0; i < devices.size(); ++i) {
    VkPhysicalDeviceProperties properties;
    vk.vkGetPhysicalDeviceProperties(devices[i], &properties);
    names += (i ? ", " : "") + std::to_string(i) + " " + properties.deviceName;
    if (!desc.device.empty() && desc.device != std::to_string(i) &&
        lower(properties.deviceName).find(lower(desc.device)) == std::string::npos)
      continue;
    auto needs = requirements(instance, devices[i], desc.get_instance_proc_addr);
    if (!needs) {
      last_reason = needs.error().message;
      continue;
    }
    if (!needs->supported) {
      for (const RequirementCheck& check : needs->checks)
        if (check.required && !check.supported)
          last_reason = std::string(properties.deviceName) + " lacks " + std::string(check.name);
      continue;
    }
    if (rank(properties.deviceType) < best_rank) best = devices[i], best_rank = rank(properties.deviceType);
  }
  if (best) return best;
  if (!last_reason.empty()) return Error{ErrorCode::unsupported, "no usable device: " + last_reason};
  return Error{ErrorCode::invalid_argument, "no device matches \"" + desc.device + "\"; there are: " + names};
}

/// Ors the 32-bit flags of two feature structs from their first feature on; they hold nothing but VkBool32 there.
template <class Features>
void merge(Features& into, const Features& more, size_t first) {
  for (size_t at = first; at + sizeof(VkBool32) <= sizeof(Features); at += sizeof(VkBool32)) {
    VkBool32 a, b;
    std::memcpy(&a, reinterpret_cast<const std::byte*>(&into) + at, sizeof a);
    std::memcpy(&b, reinterpret_cast<const std::byte*>(&more) + at, sizeof b);
    a = a || b;
    std::memcpy(reinterpret_cast<std::byte*>(&into) + at, &a, sizeof a);
  }
}

/// Capabilities that are wanted, where the device has them.
void enable_wanted(const Capabilities& wanted, Requirements& needs, Capabilities& enabled,
                   VkPhysicalDeviceMeshShaderFeaturesEXT& mesh, std::vector<const char*>& extensions) {
  enabled.geometry_shader = wanted.geometry_shader && needs.available.geometry_shader;
  enabled.vertex_layer = wanted.vertex_layer && needs.available.vertex_layer;
  enabled.multiview = wanted.multiview && needs.available.multiview;
  enabled.mesh_shader = wanted.mesh_shader && needs.available.mesh_shader;
  enabled.sparse_residency = wanted.sparse_residency && needs.available.sparse_residency;
  enabled.shader_residency = wanted.shader_residency && needs.available.shader_residency;
  gpu::enable_capabilities(enabled, needs);
  if (enabled.geometry_shader) needs.features.features.geometryShader = VK_TRUE;
  if (enabled.multiview) needs.features_11.multiview = VK_TRUE;
  if (!enabled.mesh_shader) return;
  mesh.meshShader = mesh.taskShader = VK_TRUE;
  extensions.push_back(VK_EXT_MESH_SHADER_EXTENSION_NAME);
}

struct InstanceMade {
  VkInstance instance = VK_NULL_HANDLE;
  bool debug_utils = false;
};

Result<InstanceMade> make_instance(const HeadlessDesc& desc) {
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(desc.get_instance_proc_addr(nullptr, "vkCreateInstance"));
  if (!create) return Error{ErrorCode::unsupported, "vkGetInstanceProcAddr does not offer vkCreateInstance"};
  if (desc.validate)
    if (auto found = check_layer(desc.get_instance_proc_addr); !found) return found.error();
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "umbrage";
  application.apiVersion = VK_API_VERSION_1_3;
  const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT validation{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  validation.enabledValidationFeatureCount = 1;
  validation.pEnabledValidationFeatures = &synchronization;
  std::vector<const char*> extensions = desc.instance_extensions;
  if (desc.validate) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  if (desc.validate) {
    info.pNext = &validation;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
  }
  InstanceMade made{.debug_utils = desc.validate};
  const VkResult result = create(&info, nullptr, &made.instance);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateInstance", "");
  return made;
}
}  // namespace

Result<HeadlessDevice> HeadlessDevice::create(const HeadlessDesc& desc) {
  if (!desc.get_instance_proc_addr)
    return Error{ErrorCode::invalid_argument, "HeadlessDesc: get_instance_proc_addr is needed"};
  auto state = std::make_unique<State>();
  state->get = desc.get_instance_proc_addr;
  auto made = make_instance(desc);
  if (!made) return made.error();
  state->instance = made->instance;
  gpu::Functions& vk = state->vk;
  if (const char* missing = vk.load_instance(state->instance, desc.get_instance_proc_addr))
    return Error{ErrorCode::unsupported, std::string("the instance does not offer ") + missing};

  if (desc.validate) {
    const auto create_messenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        state->get(state->instance, "vkCreateDebugUtilsMessengerEXT"));
    state->destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        state->get(state->instance, "vkDestroyDebugUtilsMessengerEXT"));
    if (!create_messenger || !state->destroy_messenger)
      return Error{ErrorCode::unsupported, "VK_EXT_debug_utils lacks its functions"};
    state->messages = {desc.message, desc.message_user};
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = &state->messages;
    const VkResult result = create_messenger(state->instance, &info, nullptr, &state->messenger);
    if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateDebugUtilsMessengerEXT", "");
  }

  auto chosen = choose(vk, state->instance, desc);
  if (!chosen) return chosen.error();
  state->physical = *chosen;
  auto needs = requirements(state->instance, state->physical, desc.get_instance_proc_addr);
  if (!needs) return needs.error();
  state->name = needs->device_name, state->driver = needs->driver;
  state->enabled.debug_utils = made->debug_utils;

  uint32_t family_count = 0;
  vk.vkGetPhysicalDeviceQueueFamilyProperties(state->physical, &family_count, nullptr);
  std::vector<VkQueueFamilyProperties> families(family_count);
  vk.vkGetPhysicalDeviceQueueFamilyProperties(state->physical, &family_count, families.data());
  const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  const auto family =
      std::find_if(families.begin(), families.end(), [both](const auto& f) { return (f.queueFlags & both) == both; });
  if (family == families.end())
    return Error{ErrorCode::unsupported, state->name + ": no queue with graphics and compute"};
  state->family = static_cast<uint32_t>(family - families.begin());

  constexpr size_t kFirst = offsetof(VkPhysicalDeviceVulkan12Features, samplerMirrorClampToEdge);
  static_assert(offsetof(VkPhysicalDeviceVulkan11Features, storageBuffer16BitAccess) == kFirst &&
                offsetof(VkPhysicalDeviceVulkan13Features, robustImageAccess) == kFirst);
  std::vector<const char*> extensions = desc.device_extensions;
  VkPhysicalDeviceMeshShaderFeaturesEXT mesh{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT};
  enable_wanted(desc.wanted, *needs, state->enabled, mesh, extensions);
  const void* chain = needs->chain();
  if (mesh.meshShader) {
    mesh.pNext = const_cast<void*>(chain);
    chain = &mesh;
  }
  merge(needs->features.features, desc.features, 0);
  merge(needs->features_11, desc.features_11, kFirst);
  merge(needs->features_12, desc.features_12, kFirst);
  merge(needs->features_13, desc.features_13, kFirst);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = state->family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, chain};
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  const VkResult result = vk.vkCreateDevice(state->physical, &info, nullptr, &state->device);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateDevice", state->name);
  if (const char* missing = vk.load_device(state->device, state->enabled.debug_utils, state->enabled.mesh_shader))
    return Error{ErrorCode::unsupported, state->name + " does not offer " + missing};
  vk.vkGetDeviceQueue(state->device, state->family, 0, &state->queue);
  return HeadlessDevice(std::move(state));
}

HeadlessDevice::HeadlessDevice(std::unique_ptr<State> state) : state_(std::move(state)) {}
HeadlessDevice::HeadlessDevice(HeadlessDevice&&) noexcept = default;
HeadlessDevice& HeadlessDevice::operator=(HeadlessDevice&&) noexcept = default;
HeadlessDevice::~HeadlessDevice() = default;

DeviceDesc HeadlessDevice::desc() const {
  return {.instance = state_->instance,
          .physical_device = state_->physical,
          .device = state_->device,
          .get_instance_proc_addr = state_->get,
          .queue_family = state_->family,
          .enabled = state_->enabled};
}
VkQueue HeadlessDevice::queue() const { return state_->queue; }
std::string_view HeadlessDevice::name() const { return state_->name; }
std::string_view HeadlessDevice::driver() const { return state_->driver; }

}  // namespace umbrage
