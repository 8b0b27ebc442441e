// Which stages a writer has, in which variant; everything else of the pipelines is alike.
#include "layered/layered_pipelines.hpp"

#include <algorithm>

#include "layered/layered_types.shared.h"
#include "layered/patch_spirv.hpp"
#include "layered_shaders.hpp"

namespace umbrage::layered {

namespace {
constexpr uint32_t kListViews[] =
#include "shaders/list_views.task.inc"
    ;
constexpr uint32_t kCutMask[] =
#include "shaders/cut_mask.frag.inc"
    ;

using Words = std::span<const uint32_t>;
using Variants = std::array<Words, 6>;  // plain, mask, color; the same with areas

#define UMB_VARIANTS(stage) \
  Variants { stage##_PLAIN, stage##_MASK, stage##_COLOR, stage##_AREAS, stage##_AREAS_MASK, stage##_AREAS_COLOR }

struct Stages {
  Variants last;  // before the rasteriser
  VkShaderStageFlagBits last_stage;
  Variants first{};  // vertex shader before a geometry shader
};

Stages stages_of(LayeredWriter writer) {
  switch (writer) {
    case LayeredWriter::geometry_invocations:
      return {UMB_VARIANTS(emit_by_invocation), VK_SHADER_STAGE_GEOMETRY_BIT, UMB_VARIANTS(pass_to_geometry)};
    case LayeredWriter::geometry_loop:
      return {UMB_VARIANTS(emit_in_loop), VK_SHADER_STAGE_GEOMETRY_BIT, UMB_VARIANTS(pass_to_geometry)};
    case LayeredWriter::vertex_layer:
      return {UMB_VARIANTS(choose_layer), VK_SHADER_STAGE_VERTEX_BIT};
    case LayeredWriter::multiview:
      return {UMB_VARIANTS(draw_multiview), VK_SHADER_STAGE_VERTEX_BIT};
    case LayeredWriter::mesh:
      return {UMB_VARIANTS(emit_batch), VK_SHADER_STAGE_MESH_BIT_EXT};
    case LayeredWriter::atlas:
      return {UMB_VARIANTS(choose_area), VK_SHADER_STAGE_VERTEX_BIT};
    case LayeredWriter::traditional:
    case LayeredWriter::compute:
      break;
  }
  return {UMB_VARIANTS(draw_view), VK_SHADER_STAGE_VERTEX_BIT};
}

VkShaderStageFlags stages_before_raster(LayeredWriter writer) {
  if (writer == LayeredWriter::mesh) return VK_SHADER_STAGE_TASK_BIT_EXT | VK_SHADER_STAGE_MESH_BIT_EXT;
  const bool geometry = writer == LayeredWriter::geometry_invocations || writer == LayeredWriter::geometry_loop;
  return VK_SHADER_STAGE_VERTEX_BIT | (geometry ? VK_SHADER_STAGE_GEOMETRY_BIT : 0);
}

/// Shader modules that live until the pipeline is made.
class Modules {
 public:
  explicit Modules(const gpu::Device& device) : device_(device) {}
  Modules(const Modules&) = delete;
  ~Modules() {
    for (uint32_t i = 0; i < count_; ++i)
      device_.vk().vkDestroyShaderModule(device_.handle(), stages_[i].module, device_.callbacks());
  }
  Result<void> add(VkShaderStageFlagBits stage, Words words, const VkSpecializationInfo& constants) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = words.size_bytes();
    info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    const VkResult result = device_.vk().vkCreateShaderModule(device_.handle(), &info, device_.callbacks(), &module);
    if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateShaderModule", "layered");
    stages_[count_++] = {
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, stage, module, "main", &constants};
    return {};
  }
  uint32_t count() const { return count_; }
  const VkPipelineShaderStageCreateInfo* stages() const { return stages_.data(); }

 private:
  const gpu::Device& device_;
  std::array<VkPipelineShaderStageCreateInfo, 4> stages_{};
  uint32_t count_ = 0;
};

/// Constants 0…3 of transform.glsl, 4 of emit_by_invocation.geom.
struct Constants {
  explicit Constants(std::array<uint32_t, 5> with) : values(with) {
    for (uint32_t i = 0; i < values.size(); ++i)
      entries[i] = {i, static_cast<uint32_t>(i * sizeof(uint32_t)), sizeof(uint32_t)};
    info = {static_cast<uint32_t>(entries.size()), entries.data(), sizeof values, values.data()};
  }
  Constants(const Constants&) = delete;
  std::array<uint32_t, 5> values;
  std::array<VkSpecializationMapEntry, 5> entries{};
  VkSpecializationInfo info{};
};
/// The stages of a writer, its last one patched to as many views as the pass has.
Result<void> add_stages(Modules& modules, const LayeredPassSettings& settings, const DeviceLimits& limits, bool masked,
                        const Constants& constants) {
  const bool has_color = !settings.color_fragment.empty();
  const size_t variant = (settings.areas ? 3u : 0u) + (has_color ? 2u : masked ? 1u : 0u);
  const Stages stages = stages_of(settings.writer);
  std::vector<uint32_t> patched;
  Words last = stages.last[variant];
  if (settings.writer == LayeredWriter::geometry_invocations) {
    const uint32_t invocations = std::min(settings.views, limits.geometry_invocations);
    const uint32_t rounds = std::min((settings.views + invocations - 1) / invocations, limits.split.loop_views);
    last = patched =
        with_execution_mode(with_execution_mode(last, kInvocations, invocations), kOutputVertices, 3 * rounds);
  }
  if (settings.writer == LayeredWriter::geometry_loop)
    last = patched = with_execution_mode(last, kOutputVertices, 3 * std::min(settings.views, limits.split.loop_views));
  if (settings.writer == LayeredWriter::mesh)
    if (auto ok = modules.add(VK_SHADER_STAGE_TASK_BIT_EXT, kListViews, constants.info); !ok) return ok.error();
  if (!stages.first[variant].empty())
    if (auto ok = modules.add(VK_SHADER_STAGE_VERTEX_BIT, stages.first[variant], constants.info); !ok)
      return ok.error();
  if (auto ok = modules.add(stages.last_stage, last, constants.info); !ok) return ok.error();
  if (!has_color && !masked) return {};
  return modules.add(VK_SHADER_STAGE_FRAGMENT_BIT, has_color ? settings.color_fragment : Words(kCutMask),
                     constants.info);
}

}  // namespace

DeviceLimits device_limits(const gpu::Device& device, VkPhysicalDevice physical, uint32_t components) {
  VkPhysicalDeviceMeshShaderPropertiesEXT mesh{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_PROPERTIES_EXT};
  VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  if (device.capabilities().mesh_shader) v11.pNext = &mesh;
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11};
  device.vk().vkGetPhysicalDeviceProperties2(physical, &all);
  const VkPhysicalDeviceLimits& has = all.properties.limits;
  DeviceLimits limits;
  limits.split.framebuffer_layers = std::max(1u, has.maxFramebufferLayers);
  const uint32_t vertices = std::min(has.maxGeometryOutputVertices, has.maxGeometryTotalOutputComponents / components);
  limits.split.loop_views = std::max(1u, vertices / 3);
  limits.split.multiview_views = std::clamp(v11.maxMultiviewViewCount, 1u, 32u);
  limits.split.mesh_layers = std::max(1u, mesh.maxMeshOutputLayers);
  limits.geometry_invocations = std::max(1u, has.maxGeometryShaderInvocations);
  limits.split.invocation_views = limits.geometry_invocations * limits.split.loop_views;
  limits.task_groups =
      device.capabilities().mesh_shader ? mesh.maxTaskWorkGroupCount[0] : has.maxComputeWorkGroupCount[0];
  return limits;
}

std::string_view missing_feature(LayeredWriter writer, const Capabilities& has) {
  switch (writer) {
    case LayeredWriter::geometry_invocations:
    case LayeredWriter::geometry_loop:
      return has.geometry_shader ? "" : "geometryShader";
    case LayeredWriter::vertex_layer:
      return has.vertex_layer ? "" : "shaderOutputLayer";
    case LayeredWriter::multiview:
      return has.multiview ? "" : "multiview";
    case LayeredWriter::mesh:
      return has.mesh_shader ? "" : "VK_EXT_mesh_shader with taskShader and meshShader";
    case LayeredWriter::traditional:
    case LayeredWriter::atlas:
    case LayeredWriter::compute:
      break;
  }
  return "";
}

LayeredPipelines::~LayeredPipelines() {
  const gpu::Functions& vk = device_.vk();
  for (const Made& made : pipelines_) vk.vkDestroyPipeline(device_.handle(), made.pipeline, device_.callbacks());
  if (layout_) vk.vkDestroyPipelineLayout(device_.handle(), layout_, device_.callbacks());
}

Result<void> LayeredPipelines::create_layout(const gpu::PipelineFactory& factory, const LayeredPassSettings& settings) {
  push_stages_ = stages_before_raster(settings.writer) | VK_SHADER_STAGE_FRAGMENT_BIT;
  const std::array<VkDescriptorSetLayout, 2> sets{factory.mask_set_layout(), settings.color_set_layout};
  const VkPushConstantRange push{push_stages_, 0, gpu::kPushBytes};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = settings.color_set_layout ? 2 : 1;
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &push;
  const VkResult result = device_.vk().vkCreatePipelineLayout(device_.handle(), &info, device_.callbacks(), &layout_);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreatePipelineLayout", "layered");
  return {};
}

Result<void> LayeredPipelines::create_pipeline(const LayeredPassSettings& settings, const DeviceLimits& limits,
                                               bool masked, uint32_t view_mask) {
  const bool has_color = !settings.color_fragment.empty();
  const Constants constants({static_cast<uint32_t>(settings.vertices), static_cast<uint32_t>(settings.culled_faces),
                             settings.cull_frustum, settings.selection == CasterSelection::each_view,
                             std::min(settings.views, limits.geometry_invocations)});
  Modules modules(device_);
  if (auto ok = add_stages(modules, settings, limits, masked, constants); !ok) return ok;
  VkPipelineVertexInputStateCreateInfo vertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.rasterizerDiscardEnable = settings.rasterizer_discard;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
  depth.depthCompareOp =
      settings.depth_order == DepthOrder::larger_is_nearer ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
  VkPipelineColorBlendAttachmentState written{};
  written.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = has_color ? 1 : 0;
  blend.pAttachments = &written;
  const std::array<VkDynamicState, 4> dynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                              VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
  VkPipelineDynamicStateCreateInfo dynamics{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamics.dynamicStateCount = static_cast<uint32_t>(dynamic.size());
  dynamics.pDynamicStates = dynamic.data();
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.viewMask = view_mask;
  rendering.colorAttachmentCount = has_color ? 1 : 0;
  rendering.pColorAttachmentFormats = &settings.color_format;
  rendering.depthAttachmentFormat = settings.depth_format;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = modules.count();
  info.pStages = modules.stages();
  info.pVertexInputState = &vertices;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamics;
  info.layout = layout_;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result = device_.vk().vkCreateGraphicsPipelines(device_.handle(), device_.pipeline_cache(), 1, &info,
                                                                 device_.callbacks(), &pipeline);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateGraphicsPipelines", name_of(settings.writer));
  device_.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline), name_of(settings.writer).data());
  pipelines_.push_back({masked, view_mask, pipeline});
  return {};
}

Result<std::unique_ptr<LayeredPipelines>> LayeredPipelines::create(const gpu::Device& device,
                                                                   const gpu::PipelineFactory& factory,
                                                                   const LayeredPassSettings& settings,
                                                                   const DeviceLimits& limits, bool masked) {
  std::unique_ptr<LayeredPipelines> out(new LayeredPipelines(device));
  if (auto ok = out->create_layout(factory, settings); !ok) return ok.error();
  // Multiview's mask is part of a pipeline: one for full groups, one for the rest.
  std::vector<uint32_t> view_masks{0};
  if (settings.writer == LayeredWriter::multiview) {
    const auto mask_of = [](uint32_t views) { return views >= 32 ? 0xffffffffu : (1u << views) - 1; };
    const uint32_t full = limits.split.multiview_views, rest = settings.views % full;
    view_masks.clear();
    if (settings.views >= full) view_masks.push_back(mask_of(full));
    if (rest) view_masks.push_back(mask_of(rest));
  }
  for (const uint32_t view_mask : view_masks)
    for (const bool with_masks : {false, true}) {
      if (with_masks && !masked) continue;
      if (auto ok = out->create_pipeline(settings, limits, with_masks, view_mask); !ok) return ok.error();
    }
  return out;
}

VkPipeline LayeredPipelines::find(bool masked, uint32_t view_mask) const {
  const auto made = std::find_if(pipelines_.begin(), pipelines_.end(),
                                 [&](const Made& m) { return m.masked == masked && m.view_mask == view_mask; });
  return made == pipelines_.end() ? VK_NULL_HANDLE : made->pipeline;
}

}  // namespace umbrage::layered
