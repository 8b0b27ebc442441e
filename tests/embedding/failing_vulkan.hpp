// Vulkan between the library and the driver: lets the n-th call that can fail do so, and counts what is alive.
#pragma once
#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <map>
#include <string>

namespace embedding::failing_vulkan {

/// For DeviceDesc::get_instance_proc_addr.
PFN_vkVoidFunction VKAPI_PTR get_instance_proc_addr(VkInstance, const char* name);

/// From now on the n-th call (1, 2, …) that returns a VkResult returns `result` and does nothing; 0: none does.
void fail_call(size_t n, VkResult result);
/// Calls that returned a VkResult since fail_call().
size_t calls();
/// The name of the call that failed; empty when none has.
const std::string& failed_call();
/// Objects made and not destroyed, by kind, without those that are freed with their pool. Empty: nothing leaked.
std::map<std::string, int> alive();

}  // namespace embedding::failing_vulkan
