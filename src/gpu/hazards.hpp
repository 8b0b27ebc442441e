// The hazard checker: told of every declared access and every barrier, it finds accesses that no barrier orders. It shares
// no code with the recorder that places the barriers, so that each can be held against the other (tests/gpu/test_hazards.cpp).
#pragma once
#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <string>
#include <vector>

namespace umbrage::gpu {

struct HazardEvent {
  enum class Kind : uint8_t { access, barrier };
  Kind kind = Kind::access;
  uint64_t resource = 0;  ///< SyncState::resource of a buffer or image.
  const char* resource_name = "";
  const char* pass = "";
  uint32_t pass_number = 0;                          ///< Tells passes of the same name apart.
  bool writes = false;                               ///< access: writes (and may read).
  VkPipelineStageFlags2 stages = 0, dst_stages = 0;  ///< access: its stages; barrier: source and destination.
  VkAccessFlags2 access = 0, dst_access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;      ///< Images: that the access needs, or the barrier makes.
  VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< barrier: UNDEFINED gives up the content.
};

using HazardLog = std::vector<HazardEvent>;

struct Hazard {
  std::string text;  ///< "assign clusters writes cluster words after compact clusters read it, unordered".
};

/// All unordered pairs and wrong layouts, in log order. Accesses of one pass among themselves are not compared. A barrier
/// that changes the layout counts as a write between its two sides.
std::vector<Hazard> find_hazards(const HazardLog&);

}  // namespace umbrage::gpu
