// GPU times of a frame's scopes: two timestamps each, read when the frame has retired.
#pragma once
#include <array>
#include <span>

#include "gpu/device.hpp"
#include "umbrage/stats.hpp"

namespace umbrage::gpu {

class FrameTimers {
 public:
  static constexpr uint32_t kMaxScopes = 48;
  static Result<FrameTimers> create(const Device&);
  FrameTimers() = default;
  FrameTimers(FrameTimers&&) noexcept;
  FrameTimers& operator=(FrameTimers&&) noexcept;
  ~FrameTimers();
  /// First command of a frame.
  void reset(VkCommandBuffer);
  void begin(VkCommandBuffer, const char* name);
  void end(VkCommandBuffer);
  /// Precondition: the frame's submission has completed. Returns how many entries were written.
  uint32_t read(std::span<PassTime, kMaxScopes> out) const;

 private:
  const Device* device_ = nullptr;
  VkQueryPool pool_ = VK_NULL_HANDLE;  ///< Null where the queue has no timestamps: everything is a no-op.
  std::array<const char*, kMaxScopes> names_{};
  uint32_t count_ = 0;
};

}  // namespace umbrage::gpu
