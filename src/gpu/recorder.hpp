// Records passes. A pass names each resource it touches once, in the call that yields its address; barriers, debug marker
// and GPU timer follow from that.
#pragma once
#include <array>
#include <cstring>
#include <span>

#include "gpu/hazards.hpp"
#include "gpu/image.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/timers.hpp"

namespace umbrage::gpu {

enum class Access : uint8_t {
  compute_read,
  compute_write,  // write: reads and writes
  vertex_read,
  vertex_attribute_read,
  fragment_read,
  geometry_read,   // all stages before the rasteriser
  fragment_write,  // reads and writes
  indirect_read,
  index_read,
  transfer_read,
  transfer_write,
  depth_attachment,
  host_read,
};

class Recorder;
struct AccessInfo;
struct Barrier;

/// The commands between two sets of barriers. Declare accesses first, then record; a pass ends when the next begins.
class Pass {
 public:
  /// Declares a read by compute (or by `access`) and yields the buffer's address for a push constant.
  VkDeviceAddress read(const Buffer&, Access = Access::compute_read);
  VkDeviceAddress write(const Buffer&, Access = Access::compute_write);
  /// Images: declares the access; the transition follows.
  void image(const Image&, Access);

  template <class Push>
  void dispatch(const Pipeline& pipeline, const Push& push, uint32_t x, uint32_t y = 1, uint32_t z = 1) {
    bind(pipeline, &push, sizeof(Push));
    dispatch_bound(x, y, z);
  }
  /// `arguments` must have been declared with read(…, Access::indirect_read).
  template <class Push>
  void dispatch_indirect(const Pipeline& pipeline, const Push& push, const Buffer& arguments, VkDeviceSize offset) {
    bind(pipeline, &push, sizeof(Push));
    dispatch_indirect_bound(arguments, offset);
  }
  /// For graphics and transfers: flushes the barriers and hands out the command buffer.
  VkCommandBuffer commands();
  template <class Push>
  void bind_graphics(const Pipeline& pipeline, const Push& push) {
    bind(pipeline, &push, sizeof(Push));
  }

 private:
  friend class Recorder;
  Pass(Recorder&, const char* name);
  void declare(const Buffer&, const AccessInfo&);
  void declare(const Image&, const AccessInfo&);
  void log(const SyncState&, const char* resource_name, const AccessInfo&, const Barrier&) const;
  void flush();
  void bind(const Pipeline&, const void* push, size_t size);
  void dispatch_bound(uint32_t x, uint32_t y, uint32_t z);
  void dispatch_indirect_bound(const Buffer& arguments, VkDeviceSize offset);

  Recorder& recorder_;
  const char* name_;
  uint32_t number_;  ///< In the hazard log.
  std::array<VkBufferMemoryBarrier2, 40> buffers_;
  std::array<VkImageMemoryBarrier2, 32> images_;
  uint32_t buffer_count_ = 0, image_count_ = 0;
};

/// Times and labels what is recorded while it lives: one entry of the frame's pass list.
class Scope {
 public:
  Scope(Recorder&, const char* name);
  ~Scope();
  Scope(const Scope&) = delete;

 private:
  Recorder& recorder_;
};

class Recorder {
 public:
  /// frame_set and mask_set are bound for compute and graphics whenever a pipeline is bound.
  Recorder(const Device& device, const PipelineFactory& factory, VkCommandBuffer commands, FrameTimers* timers,
           VkDescriptorSet frame_set, VkDescriptorSet mask_set, HazardLog* log)
      : device_(device),
        factory_(factory),
        commands_(commands),
        timers_(timers),
        sets_{frame_set, mask_set},
        log_(log) {}
  Pass pass(const char* name) { return {*this, name}; }
  /// From the next pipeline on.
  void use_frame_set(VkDescriptorSet set) {
    if (set != sets_[0]) sets_[0] = set, sets_bound_ = {};
  }
  const Device& device() const { return device_; }
  /// Makes contents visible to stages outside of the library.
  void publish(std::span<const Buffer* const>, std::span<const Image* const>, VkPipelineStageFlags2 stages);

 private:
  friend class Pass;
  friend class Scope;
  const Device& device_;
  const PipelineFactory& factory_;
  VkCommandBuffer commands_;
  FrameTimers* timers_;
  std::array<VkDescriptorSet, 2> sets_;
  HazardLog* log_;
  std::array<bool, 2> sets_bound_{};
};

}  // namespace umbrage::gpu
