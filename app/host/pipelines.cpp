// Pipeline creation.
#include "host/pipelines.hpp"

#include <vector>

namespace app {

using umbrage::Error;
using umbrage::Result;

namespace {

Result<Handle<VkShaderModule>> create_module(const GpuContext& context, Spirv words) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = words.size_bytes();
  info.pCode = words.data();
  VkShaderModule module = VK_NULL_HANDLE;
  const VkResult result = context.vk.vkCreateShaderModule(context.device(), &info, nullptr, &module);
  if (result != VK_SUCCESS) return vulkan_error("vkCreateShaderModule", result);
  return Handle<VkShaderModule>(context.device(), module, context.vk.vkDestroyShaderModule);
}

/// Specialization constants 0, 1 and 2; shaders without them do not mind.
struct Constants {
  Constants(VkBool32 masked, uint32_t shadow_store, uint32_t reads) : values{masked, shadow_store, reads} {}
  Constants(const Constants&) = delete;
  const uint32_t values[3];
  static constexpr VkSpecializationMapEntry entries[] = {
      {0, 0, sizeof(uint32_t)}, {1, sizeof(uint32_t), sizeof(uint32_t)}, {2, 2 * sizeof(uint32_t), sizeof(uint32_t)}};
  const VkSpecializationInfo info{3, entries, sizeof(values), values};
};

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, VkShaderModule module) {
  VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage = stage;
  info.module = module;
  info.pName = "main";
  return info;
}

Handle<VkPipeline> own_pipeline(const GpuContext& context, VkPipeline pipeline, const char* name) {
  context.name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline), name);
  return {context.device(), pipeline, context.vk.vkDestroyPipeline};
}

Error pipeline_error(const char* call, VkResult result, const char* name) {
  Error error = vulkan_error(call, result);
  error.message += std::string(": pipeline ") + name;
  return error;
}

VkPipelineColorBlendAttachmentState blend_state(Blend blend) {
  VkPipelineColorBlendAttachmentState state{};
  state.colorWriteMask =
      VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  state.blendEnable = blend == Blend::premultiplied ? VK_TRUE : VK_FALSE;
  state.srcColorBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  return state;
}

/// The parts of VkGraphicsPipelineCreateInfo that point at each other.
struct FixedState {
  VkPipelineVertexInputStateCreateInfo vertex_input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
};

constexpr VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                             VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};

FixedState fixed_state(const GraphicsPipelineDesc& desc) {
  FixedState state;
  state.assembly.topology = desc.topology;
  state.viewport.viewportCount = 1;
  state.viewport.scissorCount = 1;
  state.raster.lineWidth = 1.0f;
  state.samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  state.depth.depthTestEnable = VK_TRUE;
  state.depth.depthWriteEnable = desc.depth == DepthUse::write ? VK_TRUE : VK_FALSE;
  state.depth.depthCompareOp = VK_COMPARE_OP_GREATER;
  state.dynamic.dynamicStateCount = static_cast<uint32_t>(std::size(dynamic_states));
  state.dynamic.pDynamicStates = dynamic_states;
  return state;
}

}  // namespace

Result<Handle<VkPipelineLayout>> create_pipeline_layout(const GpuContext& context,
                                                        std::span<const VkDescriptorSetLayout> sets) {
  const VkPushConstantRange push{VK_SHADER_STAGE_ALL, 0, 128};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = static_cast<uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &push;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  const VkResult result = context.vk.vkCreatePipelineLayout(context.device(), &info, nullptr, &layout);
  if (result != VK_SUCCESS) return vulkan_error("vkCreatePipelineLayout", result);
  return Handle<VkPipelineLayout>(context.device(), layout, context.vk.vkDestroyPipelineLayout);
}

Result<Handle<VkPipeline>> create_compute_pipeline(const GpuContext& context, VkPipelineLayout layout, Spirv words,
                                                   const char* name) {
  auto module = create_module(context, words);
  if (!module) return module.error();
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stage_info(VK_SHADER_STAGE_COMPUTE_BIT, module->get());
  const Constants constants(VK_FALSE, context.shadow_store, 0);
  info.stage.pSpecializationInfo = &constants.info;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      context.vk.vkCreateComputePipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
  if (result != VK_SUCCESS) return pipeline_error("vkCreateComputePipelines", result, name);
  return own_pipeline(context, pipeline, name);
}

Result<Handle<VkPipeline>> create_graphics_pipeline(const GpuContext& context, VkPipelineLayout layout,
                                                    const GraphicsPipelineDesc& desc) {
  auto vertex = create_module(context, desc.vertex);
  if (!vertex) return vertex.error();
  auto fragment = create_module(context, desc.fragment);
  if (!fragment) return fragment.error();
  VkPipelineShaderStageCreateInfo stages[] = {stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex->get()),
                                              stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment->get())};
  const Constants constants(desc.masked, context.shadow_store, desc.reads);
  for (VkPipelineShaderStageCreateInfo& stage : stages) stage.pSpecializationInfo = &constants.info;

  const FixedState state = fixed_state(desc);
  const std::vector<VkPipelineColorBlendAttachmentState> attachments(desc.color_formats.size(),
                                                                     blend_state(desc.blend));
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = static_cast<uint32_t>(attachments.size());
  blend.pAttachments = attachments.data();
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = static_cast<uint32_t>(desc.color_formats.size());
  rendering.pColorAttachmentFormats = desc.color_formats.data();
  rendering.depthAttachmentFormat = depth_format;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &state.vertex_input;
  info.pInputAssemblyState = &state.assembly;
  info.pViewportState = &state.viewport;
  info.pRasterizationState = &state.raster;
  info.pMultisampleState = &state.samples;
  info.pDepthStencilState = &state.depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &state.dynamic;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      context.vk.vkCreateGraphicsPipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
  if (result != VK_SUCCESS) return pipeline_error("vkCreateGraphicsPipelines", result, desc.name);
  return own_pipeline(context, pipeline, desc.name);
}

}  // namespace app
