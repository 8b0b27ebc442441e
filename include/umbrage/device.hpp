// The device: adopted from the host, or made here for programs that need no window.
#pragma once
#include <vulkan/vulkan_core.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "umbrage/result.hpp"
#include "umbrage/settings.hpp"

namespace umbrage {

/// What a device can do beyond the required features. In DeviceDesc: what the host enabled.
struct Capabilities {
  bool geometry_shader = false;
  bool vertex_layer = false;          ///< shaderOutputLayer: a vertex shader may choose the layer.
  bool multiview = false;
  bool mesh_shader = false;           ///< VK_EXT_mesh_shader, task and mesh.
  bool sparse_residency = false;      ///< sparseBinding, sparseResidencyImage2D, shaderStorageImageArrayDynamicIndexing and …NonUniformIndexing.
  bool shader_residency = false;      ///< shaderResourceResidency: shaders learn whether a texel is bound.
  bool ray_query = false;
  bool ray_tracing_pipeline = false;
  bool debug_utils = false;           ///< VK_EXT_debug_utils: names and markers.
};

/// One feature or limit, with what the device says.
struct RequirementCheck {
  std::string_view name;              ///< "bufferDeviceAddress", "maxPushConstantsSize >= 128", …
  bool required = true;               ///< false: a capability.
  bool supported = false;
  std::string_view purpose;           ///< What of umbrage needs it.
};

struct Requirements {
  bool supported = false;                     ///< Every required check holds.
  std::vector<RequirementCheck> checks;       ///< Required first.
  std::vector<const char*> device_extensions; ///< To enable besides features; empty on Vulkan 1.3 unless capabilities are wanted.
  Capabilities available;
  VkPhysicalDeviceFeatures2 features;         ///< With features_11 … features_13 chained: enable (at least) these.
  VkPhysicalDeviceVulkan11Features features_11;
  VkPhysicalDeviceVulkan12Features features_12;
  VkPhysicalDeviceVulkan13Features features_13;
  std::string device_name, driver;
  /// Chains the structs above and returns the head, for VkDeviceCreateInfo::pNext. Valid while this object stays in place.
  const void* chain();
};

/// To be asked before device creation, for the settings that will be used: their store may need more. Errors: unsupported
/// (Vulkan < 1.3), vulkan.
Result<Requirements> requirements(VkInstance, VkPhysicalDevice, PFN_vkGetInstanceProcAddr, const StaticSettings& = {});

enum class Severity : uint8_t { info, warning, error };
/// Called from the thread that calls the library. The text is valid during the call.
using MessageCallback = void (*)(void* user, Severity, std::string_view text);

struct DeviceDesc {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  ///< The library loads its own function table through it.
  uint32_t queue_family = 0;                                   ///< Graphics and compute; where the host submits what is recorded.
  Capabilities enabled;                                        ///< What the host enabled of the optional features.
  const VkAllocationCallbacks* allocation_callbacks = nullptr;
  std::span<const std::byte> pipeline_cache;                   ///< From pipeline_cache() of an earlier run; foreign bytes are ignored.
  MessageCallback message = nullptr;
  void* message_user = nullptr;
};

struct HeadlessDesc {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  std::string device;                         ///< Index or part of the name; empty = best discrete, then integrated, then software.
  bool validate = false;                      ///< VK_LAYER_KHRONOS_validation with synchronisation validation; refused when not installed.
  MessageCallback message = nullptr;          ///< Validation messages arrive here as errors and warnings.
  void* message_user = nullptr;
  Capabilities wanted;                        ///< Enabled where the device has them: geometry_shader, vertex_layer, multiview, mesh_shader, sparse_residency, shader_residency.
  std::vector<const char*> instance_extensions;  ///< Further ones (a window's surface).
  std::vector<const char*> device_extensions;
  VkPhysicalDeviceFeatures features{};        ///< Further ones the program needs besides the library's.
  VkPhysicalDeviceVulkan11Features features_11{};
  VkPhysicalDeviceVulkan12Features features_12{};
  VkPhysicalDeviceVulkan13Features features_13{};
};

/// Instance, device and one queue of the program's own, destroyed with the object.
class HeadlessDevice {
 public:
  static Result<HeadlessDevice> create(const HeadlessDesc&);
  HeadlessDevice(HeadlessDevice&&) noexcept;
  HeadlessDevice& operator=(HeadlessDevice&&) noexcept;
  ~HeadlessDevice();
  DeviceDesc desc() const;
  VkQueue queue() const;
  std::string_view name() const;
  std::string_view driver() const;

 private:
  struct State;
  explicit HeadlessDevice(std::unique_ptr<State>);
  std::unique_ptr<State> state_;
};

}  // namespace umbrage
