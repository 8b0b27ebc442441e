// Scopes do not nest; beyond kMaxScopes they go untimed.
#include "gpu/timers.hpp"

#include <utility>

namespace umbrage::gpu {

Result<FrameTimers> FrameTimers::create(const Device& device) {
  FrameTimers timers;
  if (device.limits().timestamp_period_ns <= 0) return timers;
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * kMaxScopes;
  const VkResult result = device.vk().vkCreateQueryPool(device.handle(), &info, device.callbacks(), &timers.pool_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateQueryPool", "timers");
  timers.device_ = &device;
  return timers;
}

FrameTimers::FrameTimers(FrameTimers&& other) noexcept { *this = std::move(other); }
FrameTimers& FrameTimers::operator=(FrameTimers&& other) noexcept {
  std::swap(device_, other.device_), std::swap(pool_, other.pool_);
  std::swap(names_, other.names_), std::swap(count_, other.count_);
  return *this;
}
FrameTimers::~FrameTimers() {
  if (pool_) device_->vk().vkDestroyQueryPool(device_->handle(), pool_, device_->callbacks());
}

void FrameTimers::reset(VkCommandBuffer commands) {
  count_ = 0;
  if (pool_) device_->vk().vkCmdResetQueryPool(commands, pool_, 0, 2 * kMaxScopes);
}

void FrameTimers::begin(VkCommandBuffer commands, const char* name) {
  if (!pool_ || count_ >= kMaxScopes) return;
  names_[count_] = name;
  device_->vk().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, 2 * count_);
}

void FrameTimers::end(VkCommandBuffer commands) {
  if (!pool_ || count_ >= kMaxScopes) return;
  device_->vk().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, 2 * count_ + 1);
  ++count_;
}

uint32_t FrameTimers::read(std::span<PassTime, kMaxScopes> out) const {
  if (!pool_ || count_ == 0) return 0;
  std::array<uint64_t, 2 * kMaxScopes> ticks{};
  const VkResult result = device_->vk().vkGetQueryPoolResults(device_->handle(), pool_, 0, 2 * count_, sizeof ticks,
                                                              ticks.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT);
  if (result != VK_SUCCESS) return 0;
  for (uint32_t i = 0; i < count_; ++i)
    out[i] = {names_[i],
              static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]) * device_->limits().timestamp_period_ns * 1e-6};
  return count_;
}

}  // namespace umbrage::gpu
