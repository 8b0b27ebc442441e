// One copy command per run of edits of a buffer, one region in it per run of neighbouring edits.
#include "gpu/uploader.hpp"

#include <algorithm>
#include <cassert>

namespace umbrage::gpu {

Result<void> GrownBuffer::ensure(const Device& device, Memory& memory, VkDeviceSize bytes, const char* name) {
  if (current_ && current_.size() >= bytes) return {};
  auto made = Buffer::create(device, memory, std::max<VkDeviceSize>({bytes, current_.size() * 2, 4096}),
                             MemoryKind::device, name);
  if (!made) return made.error();
  if (!former_) former_ = std::move(current_);  // else the current one was never filled
  current_ = std::move(*made);
  return {};
}

void GrownBuffer::record(Recorder& recorder, RetireQueue& retired, uint64_t serial) {
  if (!former_) return;
  {
    Pass pass = recorder.pass("grow");
    pass.read(former_, Access::transfer_read);
    pass.write(current_, Access::transfer_write);
    const VkBufferCopy region{0, 0, former_.size()};
    recorder.device().vk().vkCmdCopyBuffer(pass.commands(), former_.handle(), current_.handle(), 1, &region);
  }
  retired.retire(std::move(former_), serial);
  former_ = {};
}

Result<void> Uploader::begin(const Device& device, Memory& memory, VkDeviceSize bytes, const char* name) {
  used_ = 0;
  regions_.clear();
  runs_.clear();
  constexpr VkDeviceSize kKeep = 1 << 20;
  const bool far_too_large = staging_ && staging_.size() > kKeep && staging_.size() / 8 > bytes;
  if (staging_ && staging_.size() >= bytes && !far_too_large) return {};
  staging_ = {};
  auto made = Buffer::create(device, memory, std::max(bytes, kKeep), MemoryKind::upload, name);
  if (!made) return made.error();
  staging_ = std::move(*made);
  return {};
}

std::byte* Uploader::stage(VkDeviceSize bytes, VkDeviceAddress* address) {
  used_ = (used_ + 15) & ~VkDeviceSize(15);
  assert(used_ + bytes <= staging_.size());
  std::byte* room = staging_.mapped() + used_;
  if (address) *address = staging_.address() + used_;
  used_ += bytes;
  return room;
}

void Uploader::copy(const Buffer& target, VkDeviceSize offset, const void* data, VkDeviceSize bytes) {
  if (bytes == 0) return;
  if (runs_.empty() || runs_.back().target != &target)
    runs_.push_back({&target, static_cast<uint32_t>(regions_.size()), 0});
  Run& run = runs_.back();
  if (run.regions > 0) {
    VkBufferCopy& last = regions_.back();
    if (last.dstOffset + last.size == offset &&
        last.srcOffset + last.size == used_) {  // right behind it, whatever the size
      assert(used_ + bytes <= staging_.size());
      std::memcpy(staging_.mapped() + used_, data, bytes);
      last.size += bytes, used_ += bytes;
      return;
    }
  }
  std::byte* room = stage(bytes);
  std::memcpy(room, data, bytes);
  regions_.push_back({static_cast<VkDeviceSize>(room - staging_.mapped()), offset, bytes});
  ++run.regions;
}

void Uploader::record(Recorder& recorder) {
  for (const Run& run : runs_) {
    Pass pass = recorder.pass("upload");
    pass.write(*run.target, Access::transfer_write);
    recorder.device().vk().vkCmdCopyBuffer(pass.commands(), staging_.handle(), run.target->handle(), run.regions,
                                           &regions_[run.first_region]);
  }
  regions_.clear();
  runs_.clear();
}

}  // namespace umbrage::gpu
