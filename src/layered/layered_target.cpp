// Views of the host's images for rendering into any run of layers.
#include <utility>

#include "layered/layered_scene_state.hpp"
#include "layered/layered_target_state.hpp"

namespace umbrage {

LayeredTarget::State::~State() {
  for (const auto* views : {&depth, &color})
    for (VkImageView view : *views) device.vk().vkDestroyImageView(device.handle(), view, device.callbacks());
}

Result<void> LayeredTarget::State::create_views(VkImage image, VkFormat format, VkImageAspectFlags aspect,
                                                std::vector<VkImageView>& out) {
  for (uint32_t layer = 0; layer < desc.layers; ++layer) {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    info.format = format;
    info.subresourceRange = {aspect, 0, 1, layer, desc.layers - layer};
    VkImageView view = VK_NULL_HANDLE;
    const VkResult result = device.vk().vkCreateImageView(device.handle(), &info, device.callbacks(), &view);
    if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateImageView", "layered target");
    out.push_back(view);
  }
  return {};
}

Result<LayeredTarget> LayeredTarget::create(const LayeredScene& scene, const LayeredTargetDesc& desc) {
  const auto invalid = [](std::string text) {
    return Error{ErrorCode::invalid_argument, "LayeredTargetDesc: " + std::move(text)};
  };
  if (!desc.depth) return invalid("depth is VK_NULL_HANDLE");
  if (desc.depth_format != VK_FORMAT_D16_UNORM && desc.depth_format != VK_FORMAT_D32_SFLOAT)
    return invalid("depth_format must be D16_UNORM or D32_SFLOAT");
  if (!desc.width || !desc.height || !desc.layers) return invalid("width, height and layers must be > 0");
  if (desc.color && desc.color_format == VK_FORMAT_UNDEFINED) return invalid("color needs a color_format");
  auto state = std::make_unique<State>(*scene.state_->device);
  state->desc = desc;
  if (auto ok = state->create_views(desc.depth, desc.depth_format, VK_IMAGE_ASPECT_DEPTH_BIT, state->depth); !ok)
    return ok.error();
  if (desc.color)
    if (auto ok = state->create_views(desc.color, desc.color_format, VK_IMAGE_ASPECT_COLOR_BIT, state->color); !ok)
      return ok.error();
  return LayeredTarget(std::move(state));
}

LayeredTarget::LayeredTarget(std::unique_ptr<State> state) : state_(std::move(state)) {}
LayeredTarget::LayeredTarget(LayeredTarget&&) noexcept = default;
LayeredTarget& LayeredTarget::operator=(LayeredTarget&&) noexcept = default;
LayeredTarget::~LayeredTarget() = default;

}  // namespace umbrage
