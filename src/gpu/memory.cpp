// First-fit ranges in blocks of 32 MiB or of what is asked for, whichever is larger.
#include "gpu/memory.hpp"

#include <algorithm>

namespace umbrage::gpu {

namespace {
constexpr VkDeviceSize kBlockBytes = 32ull << 20;
constexpr VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
  return (value + alignment - 1) / alignment * alignment;
}
}  // namespace

Allocation::Allocation(Allocation&& other) noexcept { *this = std::move(other); }
Allocation& Allocation::operator=(Allocation&& other) noexcept {
  if (this == &other) return *this;
  if (owner_) owner_->release(block_, offset, size);
  memory = other.memory, offset = other.offset, size = other.size, mapped = other.mapped;
  block_ = other.block_, owner_ = std::exchange(other.owner_, nullptr);
  return *this;
}
Allocation::~Allocation() {
  if (owner_) owner_->release(block_, offset, size);
}

Memory::~Memory() {
  for (const Block& block : blocks_)
    if (block.memory) device_.vk().vkFreeMemory(device_.handle(), block.memory, device_.callbacks());
}

Result<uint32_t> Memory::add_block(VkDeviceSize size, uint32_t type, MemoryKind kind, std::string_view what) {
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags};
  info.allocationSize = size;
  info.memoryTypeIndex = type;
  Block block{.size = size, .type = type, .kind = kind, .free = {{0, size}}};
  VkResult result = device_.vk().vkAllocateMemory(device_.handle(), &info, device_.callbacks(), &block.memory);
  if (result != VK_SUCCESS)
    return vulkan_error(result, "vkAllocateMemory", std::to_string(size) + " bytes for " + std::string(what));
  if (kind != MemoryKind::device) {
    void* mapped = nullptr;
    result = device_.vk().vkMapMemory(device_.handle(), block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result != VK_SUCCESS) {
      device_.vk().vkFreeMemory(device_.handle(), block.memory, device_.callbacks());
      return vulkan_error(result, "vkMapMemory", what);
    }
    block.mapped = static_cast<std::byte*>(mapped);
  }
  const auto empty = std::find_if(blocks_.begin(), blocks_.end(), [](const Block& b) { return !b.memory; });
  const auto index = static_cast<uint32_t>(empty - blocks_.begin());
  if (empty == blocks_.end())
    blocks_.push_back(std::move(block));
  else
    *empty = std::move(block);
  return index;
}

bool Memory::take(uint32_t index, VkDeviceSize size, VkDeviceSize alignment, Allocation& out) {
  Block& block = blocks_[index];
  for (auto range = block.free.begin(); range != block.free.end(); ++range) {
    const VkDeviceSize offset = align_up(range->offset, alignment);
    const VkDeviceSize end = range->offset + range->size;
    if (offset + size > end) continue;
    const VkDeviceSize before = offset - range->offset;
    const Range after{offset + size, end - offset - size};
    if (before && after.size) {
      range->size = before;
      block.free.insert(range + 1, after);
    } else if (before) {
      range->size = before;
    } else if (after.size) {
      *range = after;
    } else {
      block.free.erase(range);
    }
    out.memory = block.memory, out.offset = offset, out.size = size;
    out.mapped = block.mapped ? block.mapped + offset : nullptr;
    out.owner_ = this, out.block_ = index;
    in_use_[static_cast<size_t>(block.kind)] += size;
    return true;
  }
  return false;
}

Result<Allocation> Memory::allocate(const VkMemoryRequirements& needs, MemoryKind kind, std::string_view what,
                                    bool own_block) {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const int type = kind == MemoryKind::device
                       ? device_.memory_type(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
                       : device_.memory_type(needs.memoryTypeBits, kHost,
                                             kind == MemoryKind::readback ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : 0);
  if (type < 0) return Error{ErrorCode::unsupported, "no memory type of the device fits " + std::string(what)};

  const VkDeviceSize alignment = std::max<VkDeviceSize>(needs.alignment, 256);
  const VkDeviceSize size = align_up(needs.size, 256);
  // Growing buffers would strand half-empty blocks: only small requests share one.
  const bool shares = !own_block && size <= kBlockBytes / 4;
  Allocation allocation;
  for (uint32_t b = 0; shares && b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    if (!block.memory || !block.shared || block.kind != kind || block.type != static_cast<uint32_t>(type)) continue;
    if (take(b, size, alignment, allocation)) return allocation;
  }
  auto added = add_block(shares ? kBlockBytes : size, static_cast<uint32_t>(type), kind, what);
  if (!added) return added.error();
  blocks_[*added].shared = shares;
  take(*added, size, alignment, allocation);
  return allocation;
}

void Memory::release(uint32_t index, VkDeviceSize offset, VkDeviceSize size) {
  Block& block = blocks_[index];
  in_use_[static_cast<size_t>(block.kind)] -= size;
  auto next = std::find_if(block.free.begin(), block.free.end(), [&](const Range& r) { return r.offset > offset; });
  next = block.free.insert(next, {offset, size});
  if (next + 1 != block.free.end() && next->offset + next->size == (next + 1)->offset) {
    next->size += (next + 1)->size;
    block.free.erase(next + 1);
  }
  if (next != block.free.begin() && (next - 1)->offset + (next - 1)->size == next->offset) {
    (next - 1)->size += next->size;
    next = block.free.erase(next) - 1;
  }
  if (block.free.size() == 1 && block.free[0].size == block.size) {
    device_.vk().vkFreeMemory(device_.handle(), block.memory, device_.callbacks());
    block = {};
  }
}

Result<void> grow(Buffer& target, const Device& device, Memory& memory, VkDeviceSize bytes, const char* name,
                  std::vector<Buffer>& retired) {
  if (target && target.size() >= bytes) return {};
  auto made = Buffer::create(device, memory, std::max<VkDeviceSize>(bytes, 16), MemoryKind::device, name);
  if (!made) return made.error();
  if (target) retired.push_back(std::move(target));
  target = std::move(*made);
  return {};
}

Result<Buffer> Buffer::create(const Device& device, Memory& memory, VkDeviceSize size, MemoryKind kind,
                              const char* name) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = align_up(std::max<VkDeviceSize>(size, 16), 16);
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
               VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
               VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
  Buffer buffer;
  VkResult result = device.vk().vkCreateBuffer(device.handle(), &info, device.callbacks(), &buffer.handle_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateBuffer", name);
  buffer.device_ = &device;
  buffer.name_ = name;
  buffer.size_ = info.size;
  buffer.sync.resource = memory.name_resource();
  VkMemoryRequirements needs;
  device.vk().vkGetBufferMemoryRequirements(device.handle(), buffer.handle_, &needs);
  auto allocation = memory.allocate(needs, kind, name);
  if (!allocation) return allocation.error();
  buffer.allocation_ = std::move(*allocation);
  result = device.vk().vkBindBufferMemory(device.handle(), buffer.handle_, buffer.allocation_.memory,
                                          buffer.allocation_.offset);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkBindBufferMemory", name);
  VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  address.buffer = buffer.handle_;
  buffer.address_ = device.vk().vkGetBufferDeviceAddress(device.handle(), &address);
  device.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(buffer.handle_), name);
  return buffer;
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }
Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(device_, other.device_), std::swap(handle_, other.handle_), std::swap(address_, other.address_);
  std::swap(size_, other.size_), std::swap(name_, other.name_), std::swap(sync, other.sync);
  std::swap(allocation_, other.allocation_);
  return *this;
}
Buffer::~Buffer() {
  if (handle_) device_->vk().vkDestroyBuffer(device_->handle(), handle_, device_->callbacks());
}

}  // namespace umbrage::gpu
