// One hook for every function of the library's table: the list of src/gpu keeps it complete.
#include "failing_vulkan.hpp"

#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "gpu/functions.hpp"

namespace embedding::failing_vulkan {

namespace {

size_t made_calls = 0, failing_call = 0;
VkResult failing_result = VK_ERROR_OUT_OF_HOST_MEMORY;
std::string name_of_failed;
std::map<std::string, int> objects;

/// "vkCreateBuffer", "vkDestroyBuffer" → "Buffer"; empty for other calls.
std::string kind_of(std::string_view name, std::string_view verb) {
  if (!name.starts_with(verb)) return {};
  std::string kind(name.substr(verb.size()));
  return kind.ends_with("Pipelines") ? "Pipeline" : kind;
}

template <class T>
uint64_t handle_bits(const T& value) {
  uint64_t bits = 0;
  if constexpr (sizeof(T) <= sizeof(bits)) std::memcpy(&bits, &value, sizeof(T));
  return bits;
}

/// What a call with these arguments made or destroyed.
template <class First, class Second, class... Rest>
void count_objects(std::string_view name, First, Second second, Rest... rest) {
  for (const auto* verb : {"vkCreate", "vkAllocate"}) {
    std::string kind = kind_of(name, verb);
    if (kind.empty() || kind == "DescriptorSets") continue;
    int made = 1;
    if constexpr (sizeof...(Rest) == 4 && std::is_same_v<Second, VkPipelineCache>)
      made = [](uint32_t count, auto...) { return int(count); }(rest...);
    objects[kind] += made;
  }
  for (const auto* verb : {"vkDestroy", "vkFree"}) {
    const std::string kind = kind_of(name, verb);
    if (!kind.empty() && handle_bits(second) != 0) objects[kind]--;
  }
}

template <class Hook, class R, class... Args>
R VKAPI_PTR hooked(Args... args) {
  if constexpr (std::is_same_v<R, VkResult>) {
    if (++made_calls == failing_call) {
      name_of_failed = Hook::name;
      return failing_result;
    }
    const VkResult result = Hook::real(args...);
    if constexpr (sizeof...(Args) >= 2)
      if (result == VK_SUCCESS) count_objects(Hook::name, args...);
    return result;
  } else {
    if constexpr (std::is_void_v<R> && sizeof...(Args) == 3) count_objects(Hook::name, args...);
    return Hook::real(args...);
  }
}

template <class Hook, class R, class... Args>
PFN_vkVoidFunction install(R(VKAPI_PTR* real)(Args...)) {
  if (!real) return nullptr;
  Hook::real = real;
  return reinterpret_cast<PFN_vkVoidFunction>(&hooked<Hook, R, Args...>);
}

#define HOOK(function)                             \
  struct Hook_##function {                         \
    static constexpr const char* name = #function; \
    static inline PFN_##function real = nullptr;   \
  };
UMB_INSTANCE_FUNCTIONS(HOOK)
UMB_DEVICE_FUNCTIONS(HOOK)
#undef HOOK

PFN_vkVoidFunction VKAPI_PTR get_device_proc_addr(VkDevice device, const char* name) {
#define INSTALL(function)                \
  if (std::strcmp(name, #function) == 0) \
    return install<Hook_##function>(reinterpret_cast<PFN_##function>(vkGetDeviceProcAddr(device, name)));
  UMB_DEVICE_FUNCTIONS(INSTALL)
#undef INSTALL
  return vkGetDeviceProcAddr(device, name);
}

}  // namespace

PFN_vkVoidFunction VKAPI_PTR get_instance_proc_addr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr);
#define INSTALL(function)                \
  if (std::strcmp(name, #function) == 0) \
    return install<Hook_##function>(reinterpret_cast<PFN_##function>(vkGetInstanceProcAddr(instance, name)));
  UMB_INSTANCE_FUNCTIONS(INSTALL)
#undef INSTALL
  return vkGetInstanceProcAddr(instance, name);
}

void fail_call(size_t n, VkResult result) {
  made_calls = 0;
  failing_call = n;
  failing_result = result;
  name_of_failed.clear();
}

size_t calls() { return made_calls; }
const std::string& failed_call() { return name_of_failed; }

std::map<std::string, int> alive() {
  std::map<std::string, int> result;
  for (const auto& [kind, count] : objects)
    if (count != 0) result[kind] = count;
  return result;
}

}  // namespace embedding::failing_vulkan
