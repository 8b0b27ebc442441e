// GPU time of the host's passes, from timestamps between them.
#pragma once
#include <vector>

#include "host/gpu_context.hpp"

namespace app {

class GpuTimers {
 public:
  static umbrage::Result<GpuTimers> create(const GpuContext&);
  /// Starts a frame: the first timestamp.
  void begin(const GpuContext&, VkCommandBuffer);
  /// Everything since the timestamp before belongs to `name` (a literal; nullptr: to no pass of the host's).
  void mark(const GpuContext&, VkCommandBuffer, const char* name);

  struct Times {
    double frame_ms = 0;  ///< First to last timestamp.
    std::vector<std::pair<const char*, double>> passes;
  };
  /// After the submission has finished. Zeros on a queue without timestamps.
  umbrage::Result<Times> read(const GpuContext&) const;

 private:
  static constexpr uint32_t capacity = 32;
  void write(const GpuContext&, VkCommandBuffer);
  Handle<VkQueryPool> queries_;
  double ms_per_tick_ = 0;  ///< 0: the queue has no timestamps.
  uint32_t written_ = 0;
  std::vector<const char*> names_;  ///< Of the interval that ends with timestamp i + 1.
};

}  // namespace app
