// Pipelines are made when a system is created, never while recording (embedding promise 9).
#include "gpu/pipeline.hpp"

#include <array>
#include <utility>

namespace umbrage::gpu {

namespace {
struct Specialization {
  explicit Specialization(std::initializer_list<Constant> constants) {
    for (const Constant& constant : constants) {
      entries[info.mapEntryCount] = {constant.id, static_cast<uint32_t>(info.mapEntryCount * sizeof(uint32_t)),
                                     sizeof(uint32_t)};
      values[info.mapEntryCount++] = constant.value;
    }
    info.pMapEntries = entries.data();
    info.dataSize = info.mapEntryCount * sizeof(uint32_t);
    info.pData = values.data();
  }
  std::array<VkSpecializationMapEntry, 8> entries{};
  std::array<uint32_t, 8> values{};
  VkSpecializationInfo info{};
};
}  // namespace

Pipeline::Pipeline(Pipeline&& other) noexcept { *this = std::move(other); }
Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
  std::swap(device_, other.device_), std::swap(handle_, other.handle_), std::swap(bind_point_, other.bind_point_);
  return *this;
}
Pipeline::~Pipeline() {
  if (handle_) device_->vk().vkDestroyPipeline(device_->handle(), handle_, device_->callbacks());
}

Result<std::unique_ptr<PipelineFactory>> PipelineFactory::create(const Device& device, uint32_t max_masks,
                                                                 uint32_t storage_images) {
  std::unique_ptr<PipelineFactory> factory(new PipelineFactory(device));
  const Functions& vk = device.vk();
  const std::array<VkDescriptorSetLayoutBinding, 3> images{
      {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},  // host's depth
       {1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},  // host's normals
       {2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, storage_images, VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
        nullptr}}};
  constexpr VkDescriptorBindingFlags kPartly = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
  const std::array<VkDescriptorBindingFlags, 3> image_flags{0, kPartly, kPartly};
  VkDescriptorSetLayoutBindingFlagsCreateInfo flags{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
  flags.bindingCount = static_cast<uint32_t>(image_flags.size());
  flags.pBindingFlags = image_flags.data();
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &flags};
  set.bindingCount = static_cast<uint32_t>(images.size());
  set.pBindings = images.data();
  VkResult result = vk.vkCreateDescriptorSetLayout(device.handle(), &set, device.callbacks(), &factory->frame_set_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateDescriptorSetLayout", "frame");

  const VkDescriptorSetLayoutBinding masks{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, max_masks,
                                           VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  const VkDescriptorBindingFlags mask_flags = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT |
                                              VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT |
                                              VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT;
  flags.bindingCount = 1;
  flags.pBindingFlags = &mask_flags;
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
  set.bindingCount = 1;
  set.pBindings = &masks;
  result = vk.vkCreateDescriptorSetLayout(device.handle(), &set, device.callbacks(), &factory->mask_set_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateDescriptorSetLayout", "masks");

  const std::array<VkDescriptorSetLayout, 2> sets{factory->frame_set_, factory->mask_set_};
  const VkPushConstantRange push{
      VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, kPushBytes};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = static_cast<uint32_t>(sets.size());
  layout.pSetLayouts = sets.data();
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &push;
  result = vk.vkCreatePipelineLayout(device.handle(), &layout, device.callbacks(), &factory->layout_);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreatePipelineLayout", "");
  return factory;
}

PipelineFactory::~PipelineFactory() {
  const Functions& vk = device_.vk();
  if (layout_) vk.vkDestroyPipelineLayout(device_.handle(), layout_, device_.callbacks());
  if (mask_set_) vk.vkDestroyDescriptorSetLayout(device_.handle(), mask_set_, device_.callbacks());
  if (frame_set_) vk.vkDestroyDescriptorSetLayout(device_.handle(), frame_set_, device_.callbacks());
}

Result<VkShaderModule> PipelineFactory::module(std::span<const uint32_t> spirv, const char* name) const {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = spirv.size_bytes();
  info.pCode = spirv.data();
  VkShaderModule handle = VK_NULL_HANDLE;
  const VkResult result = device_.vk().vkCreateShaderModule(device_.handle(), &info, device_.callbacks(), &handle);
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateShaderModule", name);
  return handle;
}

Result<Pipeline> PipelineFactory::compute(std::span<const uint32_t> spirv, const char* name,
                                          std::initializer_list<Constant> constants) const {
  auto shader = module(spirv, name);
  if (!shader) return shader.error();
  const Specialization specialization(constants);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = *shader;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization.info;
  info.layout = layout_;
  Pipeline pipeline;
  const VkResult result = device_.vk().vkCreateComputePipelines(device_.handle(), device_.pipeline_cache(), 1, &info,
                                                                device_.callbacks(), &pipeline.handle_);
  device_.vk().vkDestroyShaderModule(device_.handle(), *shader, device_.callbacks());
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateComputePipelines", name);
  pipeline.device_ = &device_;
  device_.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline.handle_), name);
  return pipeline;
}

Result<Pipeline> PipelineFactory::depth(const DepthShaders& shaders, const char* name,
                                        std::initializer_list<Constant> constants) const {
  auto vertex = module(shaders.vertex, name);
  if (!vertex) return vertex.error();
  VkShaderModule fragment = VK_NULL_HANDLE;
  if (!shaders.fragment.empty()) {
    auto made = module(shaders.fragment, name);
    if (!made) {
      device_.vk().vkDestroyShaderModule(device_.handle(), *vertex, device_.callbacks());
      return made.error();
    }
    fragment = *made;
  }
  const Specialization specialization(constants);
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  stages[0] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
               nullptr,
               0,
               VK_SHADER_STAGE_VERTEX_BIT,
               *vertex,
               "main",
               &specialization.info};
  stages[1] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
               nullptr,
               0,
               VK_SHADER_STAGE_FRAGMENT_BIT,
               fragment,
               "main",
               &specialization.info};
  const VkVertexInputBindingDescription binding{0, shaders.instance_stride_bytes, VK_VERTEX_INPUT_RATE_INSTANCE};
  std::array<VkVertexInputAttributeDescription, 12> attributes{};
  for (uint32_t i = 0; i < shaders.instance_attributes.size(); ++i)
    attributes[i] = {i, 0, shaders.instance_attributes[i], 16 * i};
  VkPipelineVertexInputStateCreateInfo vertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  vertices.vertexBindingDescriptionCount = shaders.instance_attributes.empty() ? 0 : 1;
  vertices.pVertexBindingDescriptions = &binding;
  vertices.vertexAttributeDescriptionCount = static_cast<uint32_t>(shaders.instance_attributes.size());
  vertices.pVertexAttributeDescriptions = attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.cullMode = VK_CULL_MODE_NONE;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = depth.depthWriteEnable = shaders.attachment != VK_FORMAT_UNDEFINED;
  depth.depthCompareOp = shaders.compare;
  const std::array<VkDynamicState, 2> dynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamics{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamics.dynamicStateCount = static_cast<uint32_t>(dynamic.size());
  dynamics.pDynamicStates = dynamic.data();
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.depthAttachmentFormat = shaders.attachment;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = fragment ? 2 : 1;
  info.pStages = stages.data();
  info.pVertexInputState = &vertices;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pDynamicState = &dynamics;
  info.layout = layout_;
  Pipeline pipeline;
  const VkResult result = device_.vk().vkCreateGraphicsPipelines(device_.handle(), device_.pipeline_cache(), 1, &info,
                                                                 device_.callbacks(), &pipeline.handle_);
  device_.vk().vkDestroyShaderModule(device_.handle(), *vertex, device_.callbacks());
  if (fragment) device_.vk().vkDestroyShaderModule(device_.handle(), fragment, device_.callbacks());
  if (result != VK_SUCCESS) return vulkan_error(result, "vkCreateGraphicsPipelines", name);
  pipeline.device_ = &device_;
  pipeline.bind_point_ = VK_PIPELINE_BIND_POINT_GRAPHICS;
  device_.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline.handle_), name);
  return pipeline;
}

}  // namespace umbrage::gpu
