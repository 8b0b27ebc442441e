// Host → device: grown buffers keep their content, edits travel through one staging buffer per frame in flight.
#pragma once
#include <cstring>
#include <span>
#include <vector>

#include "gpu/recorder.hpp"

namespace umbrage::gpu {

/// What frames in flight may still read; freed once those have retired.
class RetireQueue {
 public:
  void retire(Buffer&& buffer, uint64_t serial) { entries_.push_back({std::move(buffer), {}, {}, serial}); }
  void retire(Image&& image, uint64_t serial) { entries_.push_back({{}, std::move(image), {}, serial}); }
  void retire(Allocation&& memory, uint64_t serial) { entries_.push_back({{}, {}, std::move(memory), serial}); }
  void collect(uint64_t completed_serial) {
    std::erase_if(entries_, [&](const Entry& entry) { return entry.serial <= completed_serial; });
  }

 private:
  struct Entry {
    Buffer buffer;
    Image image;
    Allocation memory;
    uint64_t serial;
  };
  std::vector<Entry> entries_;
};

/// A device buffer that grows by doubling. What it held is copied over in the next record().
class GrownBuffer {
 public:
  Result<void> ensure(const Device&, Memory&, VkDeviceSize bytes, const char* name);
  /// Copies the former content if the buffer has grown, and retires the former buffer.
  void record(Recorder&, RetireQueue&, uint64_t serial);
  const Buffer& buffer() const { return current_; }

 private:
  Buffer current_, former_;
};

class Uploader {
 public:
  /// Collects copies for one frame. `slot` names the staging buffer: its last frame has retired.
  Result<void> begin(const Device&, Memory&, VkDeviceSize bytes, const char* name);
  /// Room in the staging buffer of the frame, 16-byte aligned; within what begin() was told.
  std::byte* stage(VkDeviceSize bytes, VkDeviceAddress* address = nullptr);
  void copy(const Buffer& target, VkDeviceSize offset, const void* data, VkDeviceSize bytes);
  void record(Recorder&);

 private:
  /// Consecutive copies into one buffer: one command.
  struct Run {
    const Buffer* target;
    uint32_t first_region, regions;
  };
  Buffer staging_;
  VkDeviceSize used_ = 0;
  std::vector<VkBufferCopy> regions_;
  std::vector<Run> runs_;
};

}  // namespace umbrage::gpu
