// What umbrage needs of a device, as one table that is checked, listed and enabled from.
#include <algorithm>
#include <cstring>

#include "gpu/device.hpp"

namespace umbrage {

namespace {
struct Table {
  Requirements& out;
  void require(bool supported, std::string_view name, std::string_view purpose) {
    out.checks.push_back({name, true, supported, purpose});
    out.supported = out.supported && supported;
  }
  /// needed: by the settings.
  void capability(bool& flag, bool supported, std::string_view name, std::string_view purpose, bool needed = false) {
    out.checks.push_back({name, needed, supported, purpose});
    flag = supported;
    out.supported = out.supported && (supported || !needed);
  }
};

struct Supported {
  VkPhysicalDeviceFeatures2 base{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
};

void list_features(Table& table, const Supported& has) {
  Requirements& out = table.out;
#define UMB_NEED(source, target, feature, purpose)      \
  table.require(has.source feature, #feature, purpose); \
  out.target feature = VK_TRUE;
  UMB_NEED(base.features., features.features., shaderInt64, "buffer addresses in shaders")
  UMB_NEED(base.features., features.features., multiDrawIndirect, "one draw for all shadow casters")
  UMB_NEED(base.features., features.features., drawIndirectFirstInstance, "which caster a draw belongs to")
  UMB_NEED(base.features., features.features., fragmentStoresAndAtomics, "shadow texels written by fragment shaders")
  UMB_NEED(base.features., features.features., shaderClipDistance, "views side by side in one depth image")
  UMB_NEED(v12., features_12., bufferDeviceAddress, "buffers by address")
  UMB_NEED(v12., features_12., scalarBlockLayout, "structs shared by C++ and shaders")
  UMB_NEED(v12., features_12., drawIndirectCount, "draw counts that stay on the device")
  UMB_NEED(v12., features_12., descriptorIndexing, "alpha masks in one array")
  UMB_NEED(v12., features_12., runtimeDescriptorArray, "alpha masks in one array")
  UMB_NEED(v12., features_12., shaderSampledImageArrayNonUniformIndexing, "alpha masks in one array")
  UMB_NEED(v12., features_12., descriptorBindingPartiallyBound, "alpha masks in one array")
  UMB_NEED(v12., features_12., descriptorBindingSampledImageUpdateAfterBind, "masks added between frames")
  UMB_NEED(v12., features_12., descriptorBindingUpdateUnusedWhilePending, "masks added between frames")
  UMB_NEED(v13., features_13., synchronization2, "barriers")
  UMB_NEED(v13., features_13., dynamicRendering, "depth passes")
  UMB_NEED(v13., features_13., maintenance4, "SPIR-V 1.6 workgroup sizes")
#undef UMB_NEED
}

/// What a store needs of the optional features.
Capabilities needs(const StaticSettings& settings) {
  const bool sparse = settings.store == Store::hardware_sparse;
  return {.vertex_layer =
              settings.store == Store::physical_pool || (sparse && settings.sparse_texels == SparseTexels::depth16),
          .sparse_residency = sparse};
}

void require_sparse_images(Table& table, const gpu::Functions& vk, VkPhysicalDevice physical, SparseTexels texels) {
  constexpr std::string_view purpose = "hardware sparse store, O13";
  const bool words =
      gpu::sparse_page(vk, physical, VK_FORMAT_R32_UINT, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT)
          .has_value();
  const bool depth = gpu::sparse_page(vk, physical, VK_FORMAT_D16_UNORM,
                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)
                         .has_value();
  if (texels == SparseTexels::words) table.require(words, "sparse R32_UINT storage images", purpose);
  if (texels == SparseTexels::depth16) table.require(depth, "sparse D16_UNORM depth attachments", purpose);
  if (texels == SparseTexels::automatic)
    table.require(words || depth, "sparse R32_UINT storage images or D16_UNORM depth attachments", purpose);
}

void list_capabilities(Table& table, const Supported& has, const std::vector<VkExtensionProperties>& extensions,
                       const Capabilities& wanted) {
  const auto offers = [&](const char* name) {
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
  };
  Capabilities& can = table.out.available;
  table.capability(can.geometry_shader, has.base.features.geometryShader, "geometryShader", "layered rendering, R2");
  table.capability(can.vertex_layer, has.v12.shaderOutputLayer, "shaderOutputLayer",
                   "physical pool, O12; layered rendering from the vertex shader", wanted.vertex_layer);
  table.capability(can.multiview, has.v11.multiview, "multiview", "layered rendering by multiview");
  table.capability(can.mesh_shader, offers("VK_EXT_mesh_shader"), "VK_EXT_mesh_shader",
                   "layered rendering by mesh shaders");
  table.capability(can.sparse_residency,
                   has.base.features.sparseBinding && has.base.features.sparseResidencyImage2D &&
                       has.base.features.shaderStorageImageArrayDynamicIndexing &&
                       has.v12.shaderStorageImageArrayNonUniformIndexing,
                   "sparseResidencyImage2D", "hardware sparse store, O13", wanted.sparse_residency);
  table.capability(can.shader_residency, has.base.features.shaderResourceResidency, "shaderResourceResidency",
                   "hardware sparse store: what is not bound is not written, O15");
  table.capability(can.ray_query, offers("VK_KHR_ray_query"), "VK_KHR_ray_query", "ray-traced shadows");
  table.capability(can.ray_tracing_pipeline, offers("VK_KHR_ray_tracing_pipeline"), "VK_KHR_ray_tracing_pipeline",
                   "ray-traced shadows");
}
}  // namespace

namespace gpu {
void enable_capabilities(const Capabilities& wanted, Requirements& out) {
  VkPhysicalDeviceFeatures& base = out.features.features;
  if (wanted.vertex_layer) out.features_12.shaderOutputLayer = VK_TRUE;
  if (wanted.shader_residency) base.shaderResourceResidency = VK_TRUE;
  if (wanted.sparse_residency) {
    base.sparseBinding = base.sparseResidencyImage2D = base.shaderStorageImageArrayDynamicIndexing = VK_TRUE;
    out.features_12.shaderStorageImageArrayNonUniformIndexing = VK_TRUE;
  }
}
}  // namespace gpu

const void* Requirements::chain() {
  features.pNext = &features_11;
  features_11.pNext = &features_12;
  features_12.pNext = &features_13;
  features_13.pNext = nullptr;
  return &features;
}

Result<Requirements> requirements(VkInstance instance, VkPhysicalDevice physical, PFN_vkGetInstanceProcAddr get,
                                  const StaticSettings& settings) {
  if (!instance || !physical || !get)
    return Error{ErrorCode::invalid_argument,
                 "requirements: instance, physical device and vkGetInstanceProcAddr are all needed"};
  if (auto valid = validate(Settings{.fixed = settings}); !valid) return valid.error();
  gpu::Functions vk;
  if (const char* missing = vk.load_instance(instance, get))
    return Error{ErrorCode::unsupported, std::string("the instance does not offer ") + missing};

  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
  vk.vkGetPhysicalDeviceProperties2(physical, &properties);
  const VkPhysicalDeviceProperties& device = properties.properties;
  if (device.apiVersion < VK_API_VERSION_1_3)
    return Error{ErrorCode::unsupported, std::string(device.deviceName) + ": Vulkan 1.3 is needed, the device offers " +
                                             std::to_string(VK_API_VERSION_MAJOR(device.apiVersion)) + "." +
                                             std::to_string(VK_API_VERSION_MINOR(device.apiVersion))};
  Supported has;
  has.base.pNext = &has.v11, has.v11.pNext = &has.v12, has.v12.pNext = &has.v13;
  vk.vkGetPhysicalDeviceFeatures2(physical, &has.base);
  uint32_t count = 0;
  vk.vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  const VkResult listed = vk.vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
  if (listed != VK_SUCCESS && listed != VK_INCOMPLETE)
    return gpu::vulkan_error(listed, "vkEnumerateDeviceExtensionProperties", device.deviceName);
  extensions.resize(count);

  Requirements out{};
  out.supported = true;
  out.features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  out.features_11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  out.features_12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  out.features_13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  out.device_name = device.deviceName;
  out.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  Table table{out};
  list_features(table, has);
  table.require(device.limits.maxPushConstantsSize >= 128, "maxPushConstantsSize >= 128", "one push struct per shader");
  table.require(device.limits.maxComputeSharedMemorySize >= 16384, "maxComputeSharedMemorySize >= 16384",
                "cluster assignment, sorting");
  table.require(device.limits.maxComputeWorkGroupInvocations >= 256, "maxComputeWorkGroupInvocations >= 256",
                "traversal");
  table.require(device.limits.maxClipDistances >= 4, "maxClipDistances >= 4", "views side by side in one depth image");
  table.require(device.limits.maxDrawIndirectCount >= (1u << 16), "maxDrawIndirectCount >= 65536",
                "one draw for all shadow casters");
  const Capabilities wanted = needs(settings);
  list_capabilities(table, has, extensions, wanted);
  if (settings.store == Store::hardware_sparse) require_sparse_images(table, vk, physical, settings.sparse_texels);
  gpu::enable_capabilities(wanted, out);
  std::stable_partition(out.checks.begin(), out.checks.end(),
                        [](const RequirementCheck& check) { return check.required; });
  return out;
}

}  // namespace umbrage
