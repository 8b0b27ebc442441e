// Exclusive prefix sums of 32-bit counts on the device: reduce, then scan. 16 items a thread, because barriers are dear.
#pragma once
#include "gpu/recorder.hpp"

namespace umbrage::gpu {

class PrefixSum {
 public:
  static Result<PrefixSum> create(const PipelineFactory&);
  /// Room for arrays of up to `count` items; a former buffer goes to `retired`.
  Result<void> reserve(const Device&, Memory&, uint32_t count, std::vector<Buffer>& retired);
  /// values[0 … count-1] become exclusive sums; their total is written to total at total_offset.
  void record(Recorder&, const Buffer& values, uint32_t count, const Buffer& total, VkDeviceSize total_offset);
  /// A number of values that the device knows: a word of `buffer`, times `scale`.
  struct DeviceCount {
    const Buffer& buffer;
    VkDeviceSize offset;
    uint32_t scale;
  };
  /// The same for the first `counted` values, at most `capacity`; those behind them are not touched, and cost next to nothing.
  void record(Recorder&, const Buffer& values, const DeviceCount& counted, uint32_t capacity, const Buffer& total,
              VkDeviceSize total_offset);

 private:
  void record(Recorder&, const Buffer& values, const DeviceCount* counted, uint32_t capacity, const Buffer& total,
              VkDeviceSize total_offset);
  Pipeline sum_, blocks_, items_;
  Buffer sums_;
};

}  // namespace umbrage::gpu
