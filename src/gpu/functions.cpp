// Fills the function table through the host's vkGetInstanceProcAddr.
#include "gpu/functions.hpp"

namespace umbrage::gpu {

const char* Functions::load_instance(VkInstance instance, PFN_vkGetInstanceProcAddr get) {
#define UMB_LOAD(name)                                       \
  name = reinterpret_cast<PFN_##name>(get(instance, #name)); \
  if (!(name)) return #name;
  UMB_INSTANCE_FUNCTIONS(UMB_LOAD)
#undef UMB_LOAD
  return nullptr;
}

const char* Functions::load_device(VkDevice device, bool debug_utils, bool mesh_shader) {
#define UMB_LOAD(name)                                                     \
  name = reinterpret_cast<PFN_##name>(vkGetDeviceProcAddr(device, #name)); \
  if (!(name)) return #name;
  UMB_DEVICE_FUNCTIONS(UMB_LOAD)
  if (mesh_shader) { UMB_MESH_FUNCTIONS(UMB_LOAD) }
  if (debug_utils) { UMB_DEBUG_FUNCTIONS(UMB_LOAD) }
#undef UMB_LOAD
  return nullptr;
}

}  // namespace umbrage::gpu
