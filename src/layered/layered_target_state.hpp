// What a LayeredTarget owns: a view of each layer and those after it, so that a render pass can begin at any layer.
#pragma once
#include <vector>

#include "gpu/device.hpp"
#include "umbrage/layered_pass.hpp"

namespace umbrage {

struct LayeredTarget::State {
  explicit State(const gpu::Device& owner) : device(owner) {}
  ~State();
  Result<void> create_views(VkImage, VkFormat, VkImageAspectFlags, std::vector<VkImageView>&);
  const gpu::Device& device;
  LayeredTargetDesc desc;
  std::vector<VkImageView> depth, color;  ///< [first layer]
};

}  // namespace umbrage
