// Pipelines of the host: one layout for all, SPIR-V embedded in the program.
#pragma once
#include "host/gpu_context.hpp"

namespace app {

using Spirv = std::span<const uint32_t>;

/// Sets 0 … n-1 as given, 128 bytes of push constants for every stage.
umbrage::Result<Handle<VkPipelineLayout>> create_pipeline_layout(const GpuContext&,
                                                                 std::span<const VkDescriptorSetLayout> sets);

umbrage::Result<Handle<VkPipeline>> create_compute_pipeline(const GpuContext&, VkPipelineLayout, Spirv,
                                                            const char* name);

enum class Blend : uint8_t { none, premultiplied };
enum class DepthUse : uint8_t { write, test };

/// Depth is D32_SFLOAT with reversed comparison. Viewport, scissor, cull mode and front face are dynamic.
struct GraphicsPipelineDesc {
  const char* name = "";
  Spirv vertex, fragment;
  std::span<const VkFormat> color_formats;
  DepthUse depth = DepthUse::write;
  Blend blend = Blend::none;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkBool32 masked = VK_FALSE;  ///< Specialization constant 0 of the fragment shader.
  uint32_t reads = 0;          ///< Constant 2 of both: what the surface reads.
};
umbrage::Result<Handle<VkPipeline>> create_graphics_pipeline(const GpuContext&, VkPipelineLayout,
                                                             const GraphicsPipelineDesc&);

constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

template <class T>
void push_constants(const GpuContext& context, VkCommandBuffer commands, VkPipelineLayout layout, const T& values) {
  static_assert(sizeof(T) <= 128);
  context.vk.vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_ALL, 0, sizeof(T), &values);
}

/// Groups of `size` that cover `items`.
constexpr uint32_t groups(uint32_t items, uint32_t size) { return (items + size - 1) / size; }

/// One invocation an item, in rows of groups: no count of items passes the device's limit on groups along an axis.
inline void dispatch_items(const GpuContext& context, VkCommandBuffer commands, uint32_t items, uint32_t group_size) {
  constexpr uint32_t row = 1024;
  const uint32_t count = groups(items, group_size);
  context.vk.vkCmdDispatch(commands, count < row ? count : row, groups(count, row), 1);
}

}  // namespace app
