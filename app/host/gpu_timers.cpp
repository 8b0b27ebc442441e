// Timestamps.
#include "host/gpu_timers.hpp"

#include <array>
#include <cassert>

namespace app {

using umbrage::Result;

Result<GpuTimers> GpuTimers::create(const GpuContext& context) {
  GpuTimers timers;
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(context.physical_device(), &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(context.physical_device(), &count, families.data());
  if (families[context.headless().desc().queue_family].timestampValidBits > 0) {
    timers.ms_per_tick_ = static_cast<double>(context.limits().timestampPeriod) * 1e-6;
  }
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = capacity;
  VkQueryPool pool = VK_NULL_HANDLE;
  if (const VkResult result = context.vk.vkCreateQueryPool(context.device(), &info, nullptr, &pool);
      result != VK_SUCCESS) {
    return vulkan_error("vkCreateQueryPool", result);
  }
  timers.queries_ = {context.device(), pool, context.vk.vkDestroyQueryPool};
  return timers;
}

void GpuTimers::write(const GpuContext& context, VkCommandBuffer commands) {
  assert(written_ < capacity);
  if (ms_per_tick_ > 0) {
    context.vk.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), written_);
  }
  ++written_;
}

void GpuTimers::begin(const GpuContext& context, VkCommandBuffer commands) {
  context.vk.vkCmdResetQueryPool(commands, queries_.get(), 0, capacity);
  written_ = 0;
  names_.clear();
  write(context, commands);
}

void GpuTimers::mark(const GpuContext& context, VkCommandBuffer commands, const char* name) {
  names_.push_back(name);
  write(context, commands);
}

Result<GpuTimers::Times> GpuTimers::read(const GpuContext& context) const {
  std::array<uint64_t, capacity> ticks{};
  if (ms_per_tick_ > 0) {
    const VkResult result =
        context.vk.vkGetQueryPoolResults(context.device(), queries_.get(), 0, written_, sizeof(ticks), ticks.data(),
                                         sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    if (result != VK_SUCCESS) return vulkan_error("vkGetQueryPoolResults", result);
  }
  const auto between = [&](size_t from, size_t to) {
    return static_cast<double>(ticks[to] - ticks[from]) * ms_per_tick_;
  };
  Times times;
  for (size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] != nullptr) times.passes.emplace_back(names_[i], between(i, i + 1));
  }
  times.frame_ms = between(0, written_ - 1);
  return times;
}

}  // namespace app
