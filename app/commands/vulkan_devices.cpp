// The machine's Vulkan devices.
#define VK_NO_PROTOTYPES
#include "commands/vulkan_devices.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string_view>

namespace app {
namespace {

using umbrage::Result;

umbrage::Error unsupported(std::string message) {
  return umbrage::Error{umbrage::ErrorCode::unsupported, std::move(message)};
}

/// The loader and an instance, gone with the object.
class Instance {
 public:
  static Result<Instance> create() {
    Instance made;
    made.loader_.reset(dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL));
    if (made.loader_)
      made.get_ = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(made.loader_.get(), "vkGetInstanceProcAddr"));
    if (!made.get_) return unsupported("there is no Vulkan loader: install libvulkan1");
    const VkApplicationInfo application{
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "umbrage", .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    const auto create = made.global_function<PFN_vkCreateInstance>("vkCreateInstance");
    if (!create || create(&info, nullptr, &made.instance_) != VK_SUCCESS)
      return unsupported("no Vulkan driver is usable: install one (mesa-vulkan-drivers has one in software)");
    return made;
  }
  Instance(Instance&& other) noexcept
      : loader_(std::move(other.loader_)), get_(other.get_), instance_(std::exchange(other.instance_, nullptr)) {}
  Instance& operator=(Instance&&) = delete;
  ~Instance() {
    if (instance_) function<PFN_vkDestroyInstance>("vkDestroyInstance")(instance_, nullptr);
  }

  template <class T>
  T function(const char* name) const {
    return reinterpret_cast<T>(get_(instance_, name));
  }
  /// Of those that Vulkan offers without an instance.
  template <class T>
  T global_function(const char* name) const {
    return reinterpret_cast<T>(get_(nullptr, name));
  }
  VkInstance get() const { return instance_; }
  PFN_vkGetInstanceProcAddr loader_function() const { return get_; }

 private:
  struct Close {
    void operator()(void* library) const { dlclose(library); }
  };
  Instance() = default;
  std::unique_ptr<void, Close> loader_;
  PFN_vkGetInstanceProcAddr get_ = nullptr;
  VkInstance instance_ = nullptr;
};

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "software";
    default:
      return "other";
  }
}

std::string version_text(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

/// What is required and missing, as a reason; nothing: empty.
std::string missing(const std::vector<umbrage::RequirementCheck>& checks) {
  std::string reason;
  for (const umbrage::RequirementCheck& check : checks) {
    if (check.required && !check.supported) reason += (reason.empty() ? "lacks " : ", ") + std::string(check.name);
  }
  return reason;
}

PresetEntry describe(const Instance& instance, VkPhysicalDevice device, const umbrage::Preset& preset,
                     size_t required) {
  const auto asked = umbrage::requirements(instance.get(), device, instance.loader_function(), preset.settings.fixed);
  if (!asked) return {.needs = {}, .reason = asked.error().message};
  PresetEntry entry{.needs = {}, .reason = missing(asked->checks)};
  size_t number = 0;
  for (const umbrage::RequirementCheck& check : asked->checks)
    if (check.required && ++number > required)
      entry.needs += (entry.needs.empty() ? "" : ", ") + std::string(check.name);
  return entry;
}

DeviceEntry describe(const Instance& instance, VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties{};
  instance.function<PFN_vkGetPhysicalDeviceProperties>("vkGetPhysicalDeviceProperties")(device, &properties);
  DeviceEntry entry;
  entry.name = properties.deviceName;
  entry.type = type_name(properties.deviceType);
  entry.api = version_text(properties.apiVersion);
  const auto asked = umbrage::requirements(instance.get(), device, instance.loader_function());
  if (!asked) {
    entry.reason = asked.error().message;
    return entry;
  }
  entry.driver = asked->driver;
  entry.is_supported = asked->supported;
  entry.checks = asked->checks;
  entry.reason = missing(entry.checks);
  const auto required = static_cast<size_t>(std::count_if(
      entry.checks.begin(), entry.checks.end(), [](const umbrage::RequirementCheck& check) { return check.required; }));
  for (const umbrage::Preset& preset : umbrage::presets())
    entry.presets.push_back(describe(instance, device, preset, required));
  return entry;
}

bool find_validation_layer(const Instance& instance) {
  const auto enumerate =
      instance.global_function<PFN_vkEnumerateInstanceLayerProperties>("vkEnumerateInstanceLayerProperties");
  uint32_t count = 0;
  if (!enumerate || enumerate(&count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkLayerProperties> layers(count);
  if (enumerate(&count, layers.data()) < 0) return false;
  layers.resize(count);
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::string_view(layer.layerName) == "VK_LAYER_KHRONOS_validation";
  });
}

}  // namespace

Result<DeviceList> list_devices() {
  const auto instance = Instance::create();
  if (!instance) return instance.error();
  const auto enumerate = instance->function<PFN_vkEnumeratePhysicalDevices>("vkEnumeratePhysicalDevices");
  uint32_t count = 0;
  if (enumerate(instance->get(), &count, nullptr) != VK_SUCCESS || count == 0)
    return unsupported("there is no Vulkan device: install a driver (mesa-vulkan-drivers has one in software)");
  std::vector<VkPhysicalDevice> devices(count);
  if (enumerate(instance->get(), &count, devices.data()) < 0) return unsupported("the Vulkan devices cannot be listed");
  devices.resize(count);
  DeviceList list;
  for (const VkPhysicalDevice device : devices) list.devices.push_back(describe(*instance, device));
  list.has_validation_layer = find_validation_layer(*instance);
  return list;
}

}  // namespace app
