// Device memory in few large blocks; buffers and images take ranges of them.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu/device.hpp"

namespace umbrage::gpu {

enum class MemoryKind : uint8_t {
  device,    ///< Fast for the device; the host never sees it.
  upload,    ///< Written by the host once, coherent.
  readback,  ///< Read by the host, cached where possible, coherent.
};

/// Last accesses of a resource, from which the next barrier follows (recorder.cpp).
struct SyncState {
  /// A barrier makes a write visible to each of its stages through each of its accesses.
  struct Visible {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
  };
  VkPipelineStageFlags2 write_stages = 0, read_stages = 0;  ///< Of the last write and of the reads since.
  VkAccessFlags2 write_access = 0;
  std::array<Visible, 8> visible{};  ///< To what the last write has been made visible.
  uint32_t visible_count = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  uint64_t resource = 0;  ///< Its name in the hazard log; handles are used again.
};

class Memory;

/// A range of a block. Move-only; gives its range back when destroyed.
class Allocation {
 public:
  Allocation() = default;
  Allocation(Allocation&&) noexcept;
  Allocation& operator=(Allocation&&) noexcept;
  ~Allocation();
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0, size = 0;
  std::byte* mapped = nullptr;

 private:
  friend class Memory;
  Memory* owner_ = nullptr;
  uint32_t block_ = 0;
};

class Memory {
 public:
  explicit Memory(const Device& device) : device_(device) {}
  ~Memory();
  Memory(const Memory&) = delete;
  /// own_block: the range shares its block with nothing (images: bufferImageGranularity never matters).
  Result<Allocation> allocate(const VkMemoryRequirements&, MemoryKind, std::string_view what, bool own_block = false);
  VkDeviceSize bytes_in_use(MemoryKind kind) const { return in_use_[static_cast<size_t>(kind)]; }
  /// A number that no other resource has, for SyncState.
  uint64_t name_resource() { return ++resources_; }

 private:
  friend class Allocation;
  struct Range {
    VkDeviceSize offset, size;
  };
  struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;
    uint32_t type = 0;
    MemoryKind kind = MemoryKind::device;
    bool shared = true;       ///< Holds more than one allocation.
    std::vector<Range> free;  ///< Sorted by offset, never adjacent.
  };
  void release(uint32_t block, VkDeviceSize offset, VkDeviceSize size);
  bool take(uint32_t block, VkDeviceSize size, VkDeviceSize alignment, Allocation& out);
  Result<uint32_t> add_block(VkDeviceSize size, uint32_t type, MemoryKind, std::string_view what);
  const Device& device_;
  std::vector<Block> blocks_;
  VkDeviceSize in_use_[3] = {0, 0, 0};
  uint64_t resources_ = 0;
};

/// A buffer known by its address. Move-only.
class Buffer {
 public:
  static Result<Buffer> create(const Device&, Memory&, VkDeviceSize size, MemoryKind, const char* name);
  Buffer() = default;
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;
  ~Buffer();
  VkBuffer handle() const { return handle_; }
  VkDeviceAddress address() const { return address_; }
  VkDeviceSize size() const { return size_; }
  std::byte* mapped() const { return allocation_.mapped; }
  const char* name() const { return name_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  mutable SyncState sync;

 private:
  const Device* device_ = nullptr;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkDeviceAddress address_ = 0;
  VkDeviceSize size_ = 0;
  const char* name_ = "";
  Allocation allocation_;
};

/// Replaces `target` by a larger buffer if it has fewer than `bytes`; the former one goes to `retired`. Contents are lost.
Result<void> grow(Buffer& target, const Device&, Memory&, VkDeviceSize bytes, const char* name,
                  std::vector<Buffer>& retired);

}  // namespace umbrage::gpu
