// Vulkan of the stub host, through the loader's prototypes.
#include "stub_host.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace embedding {

namespace {

constexpr uint32_t draw_boxes_spirv[] =
#include "shaders/draw_boxes.vert.inc"
    ;
constexpr uint32_t write_normals_spirv[] =
#include "shaders/write_normals.frag.inc"
    ;
constexpr uint32_t read_visibility_spirv[] =
#include "shaders/read_visibility.comp.inc"
    ;

constexpr vk::Format depth_format = vk::Format::eD32Sfloat, normal_format = vk::Format::eR16G16B16A16Sfloat;

struct DrawPush {
  glm::mat4 clip_from_world;
  glm::vec3 center_ws, half_extent;
};

struct ReadPush {
  vk::DeviceAddress shadows, visibility;
  glm::mat4 world_from_clip;
  float clip_depth_scale, clip_depth_bias, background;
  uint32_t lights;
};

umbrage::Mat4 mat4(const glm::mat4& matrix) {
  umbrage::Mat4 result;
  std::memcpy(result.m, &matrix, sizeof(result.m));
  return result;
}

/// OpenGL's clip depth -w…w as what Vulkan's clipping expects.
glm::mat4 vulkan_clip(const Convention& convention) {
  glm::mat4 halve{1};
  if (convention.opengl_depth) halve[2][2] = halve[3][2] = 0.5f;
  return halve * convention.clip_from_view * convention.view_from_world;
}

vk::UniqueShaderModule make_shader(vk::Device device, std::span<const uint32_t> words) {
  return device.createShaderModuleUnique({.codeSize = words.size_bytes(), .pCode = words.data()});
}

vk::ImageMemoryBarrier2 barrier_of(vk::Image image, vk::ImageAspectFlags aspect, vk::ImageLayout from,
                                   vk::ImageLayout to) {
  return {.srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
          .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
          .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
          .dstAccessMask = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite,
          .oldLayout = from,
          .newLayout = to,
          .image = image,
          .subresourceRange = {aspect, 0, 1, 0, 1}};
}

}  // namespace

StubHost::StubHost(const umbrage::DeviceDesc& desc, VkQueue queue, VkDescriptorSetLayout umbrage_layout)
    : physical_device_(desc.physical_device), device_(desc.device), queue_(queue) {
  using Usage = vk::ImageUsageFlagBits;
  depth_ = make_image(depth_format, Usage::eDepthStencilAttachment | Usage::eSampled, vk::ImageAspectFlagBits::eDepth);
  plain_normal_ = make_image(normal_format, Usage::eColorAttachment | Usage::eSampled, vk::ImageAspectFlagBits::eColor);
  normal_ = make_image(normal_format, Usage::eColorAttachment | Usage::eSampled, vk::ImageAspectFlagBits::eColor);
  make_set();
  const vk::PushConstantRange range{vk::ShaderStageFlagBits::eVertex, 0, sizeof(DrawPush)};
  draw_layout_ = device_.createPipelineLayoutUnique({.pushConstantRangeCount = 1, .pPushConstantRanges = &range});
  make_read_pipeline(umbrage_layout);
  command_pool_ = device_.createCommandPoolUnique({.queueFamilyIndex = desc.queue_family});
}

vk::UniqueDeviceMemory StubHost::allocate(const vk::MemoryRequirements& needed, vk::MemoryPropertyFlags wanted) const {
  const auto memory = physical_device_.getMemoryProperties();
  const vk::MemoryAllocateFlagsInfo flags{.flags = vk::MemoryAllocateFlagBits::eDeviceAddress};
  for (uint32_t type = 0; type < memory.memoryTypeCount; type++)
    if ((needed.memoryTypeBits >> type & 1) && (memory.memoryTypes[type].propertyFlags & wanted) == wanted)
      return device_.allocateMemoryUnique({.pNext = &flags, .allocationSize = needed.size, .memoryTypeIndex = type});
  throw std::runtime_error("no fitting memory type");
}

StubHost::Image StubHost::make_image(vk::Format format, vk::ImageUsageFlags usage, vk::ImageAspectFlags aspect) const {
  Image result;
  result.image = device_.createImageUnique({.imageType = vk::ImageType::e2D,
                                            .format = format,
                                            .extent = {picture_width, picture_height, 1},
                                            .mipLevels = 1,
                                            .arrayLayers = 1,
                                            .usage = usage});
  result.memory = allocate(device_.getImageMemoryRequirements(*result.image), vk::MemoryPropertyFlagBits::eDeviceLocal);
  device_.bindImageMemory(*result.image, *result.memory, 0);
  result.view = device_.createImageViewUnique({.image = *result.image,
                                               .viewType = vk::ImageViewType::e2D,
                                               .format = format,
                                               .subresourceRange = {aspect, 0, 1, 0, 1}});
  return result;
}

void StubHost::make_visibility_buffer(uint32_t lights) {
  const vk::DeviceSize size = sizeof(float) * picture_width * picture_height * (lights + 1);
  visibility_ = device_.createBufferUnique(
      {.size = size, .usage = vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eShaderDeviceAddress});
  visibility_memory_ = allocate(device_.getBufferMemoryRequirements(*visibility_),
                                vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
  device_.bindBufferMemory(*visibility_, *visibility_memory_, 0);
  visibility_values_ = static_cast<float*>(device_.mapMemory(*visibility_memory_, 0, size));
  std::fill_n(visibility_values_, size / sizeof(float), -1.0f);
}

void StubHost::make_set() {
  vk::DescriptorSetLayoutBinding bindings[2];
  for (uint32_t i = 0; i < 2; i++)
    bindings[i] = {i, vk::DescriptorType::eSampledImage, 1, vk::ShaderStageFlagBits::eCompute};
  set_layout_ = device_.createDescriptorSetLayoutUnique({.bindingCount = 2, .pBindings = bindings});
  const vk::DescriptorPoolSize size{vk::DescriptorType::eSampledImage, 2};
  descriptor_pool_ = device_.createDescriptorPoolUnique({.maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size});
  set_ = device_
             .allocateDescriptorSets(
                 {.descriptorPool = *descriptor_pool_, .descriptorSetCount = 1, .pSetLayouts = &*set_layout_})
             .front();
  const vk::DescriptorImageInfo images[] = {
      {.imageView = *depth_.view, .imageLayout = vk::ImageLayout::eDepthReadOnlyOptimal},
      {.imageView = *plain_normal_.view, .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal}};
  const vk::WriteDescriptorSet write{.dstSet = set_,
                                     .descriptorCount = 1,
                                     .descriptorType = vk::DescriptorType::eSampledImage,
                                     .pImageInfo = &images[0]};
  auto second = write;
  second.dstBinding = 1;
  second.pImageInfo = &images[1];
  device_.updateDescriptorSets({write, second}, {});
}

vk::UniquePipeline StubHost::make_draw_pipeline(const Convention& convention) const {
  const auto vertex = make_shader(device_, draw_boxes_spirv), fragment = make_shader(device_, write_normals_spirv);
  const uint32_t encoding = uint32_t(convention.encoding);
  const vk::SpecializationMapEntry entry{.size = sizeof(encoding)};
  const vk::SpecializationInfo constants{
      .mapEntryCount = 1, .pMapEntries = &entry, .dataSize = sizeof(encoding), .pData = &encoding};
  const vk::PipelineShaderStageCreateInfo stages[] = {
      {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex, .pName = "main"},
      {.stage = vk::ShaderStageFlagBits::eFragment,
       .module = *fragment,
       .pName = "main",
       .pSpecializationInfo = &constants}};
  const vk::PipelineVertexInputStateCreateInfo input;
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
  const vk::Viewport area{0, 0, picture_width, picture_height, 0, 1};
  const vk::Rect2D scissor{{0, 0}, {picture_width, picture_height}};
  const vk::PipelineViewportStateCreateInfo viewport{
      .viewportCount = 1, .pViewports = &area, .scissorCount = 1, .pScissors = &scissor};
  const vk::PipelineRasterizationStateCreateInfo raster{.lineWidth = 1};
  const vk::PipelineMultisampleStateCreateInfo samples{.rasterizationSamples = vk::SampleCountFlagBits::e1};
  const vk::PipelineDepthStencilStateCreateInfo depth{
      .depthTestEnable = true,
      .depthWriteEnable = true,
      .depthCompareOp = convention.near_is_one ? vk::CompareOp::eGreater : vk::CompareOp::eLess};
  using Channel = vk::ColorComponentFlagBits;
  const vk::PipelineColorBlendAttachmentState write{.colorWriteMask =
                                                        Channel::eR | Channel::eG | Channel::eB | Channel::eA};
  const vk::PipelineColorBlendAttachmentState writes[] = {write, write};
  const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 2, .pAttachments = writes};
  const vk::Format formats[] = {normal_format, normal_format};
  const vk::PipelineRenderingCreateInfo rendering{
      .colorAttachmentCount = 2, .pColorAttachmentFormats = formats, .depthAttachmentFormat = depth_format};
  return device_
      .createGraphicsPipelineUnique(nullptr, {.pNext = &rendering,
                                              .stageCount = 2,
                                              .pStages = stages,
                                              .pVertexInputState = &input,
                                              .pInputAssemblyState = &assembly,
                                              .pViewportState = &viewport,
                                              .pRasterizationState = &raster,
                                              .pMultisampleState = &samples,
                                              .pDepthStencilState = &depth,
                                              .pColorBlendState = &blend,
                                              .layout = *draw_layout_})
      .value;
}

void StubHost::make_read_pipeline(vk::DescriptorSetLayout umbrage_layout) {
  const vk::PushConstantRange range{vk::ShaderStageFlagBits::eCompute, 0, sizeof(ReadPush)};
  const vk::DescriptorSetLayout sets[] = {*set_layout_, umbrage_layout};
  read_layout_ = device_.createPipelineLayoutUnique(
      {.setLayoutCount = 2, .pSetLayouts = sets, .pushConstantRangeCount = 1, .pPushConstantRanges = &range});
  const auto shader = make_shader(device_, read_visibility_spirv);
  read_ = device_
              .createComputePipelineUnique(
                  nullptr, {.stage = {.stage = vk::ShaderStageFlagBits::eCompute, .module = *shader, .pName = "main"},
                            .layout = *read_layout_})
              .value;
}

void StubHost::to_attachments(vk::CommandBuffer commands) const {
  using enum vk::ImageAspectFlagBits;
  const vk::ImageMemoryBarrier2 barriers[] = {
      barrier_of(*depth_.image, eDepth, vk::ImageLayout::eUndefined, vk::ImageLayout::eDepthAttachmentOptimal),
      barrier_of(*plain_normal_.image, eColor, vk::ImageLayout::eUndefined, vk::ImageLayout::eColorAttachmentOptimal),
      barrier_of(*normal_.image, eColor, vk::ImageLayout::eUndefined, vk::ImageLayout::eColorAttachmentOptimal)};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 3, .pImageMemoryBarriers = barriers});
}

void StubHost::to_sampled(vk::CommandBuffer commands) const {
  using enum vk::ImageAspectFlagBits;
  using enum vk::ImageLayout;
  const vk::ImageMemoryBarrier2 barriers[] = {
      barrier_of(*depth_.image, eDepth, eDepthAttachmentOptimal, eDepthReadOnlyOptimal),
      barrier_of(*plain_normal_.image, eColor, eColorAttachmentOptimal, eShaderReadOnlyOptimal),
      barrier_of(*normal_.image, eColor, eColorAttachmentOptimal, eShaderReadOnlyOptimal)};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 3, .pImageMemoryBarriers = barriers});
}

umbrage::FrameDesc StubHost::describe(const Convention& convention, umbrage::CameraDesc& camera) {
  camera = {.view_from_world = mat4(convention.view_from_world),
            .clip_from_view = mat4(convention.clip_from_view),
            .opengl_depth = convention.opengl_depth,
            .width = picture_width,
            .height = picture_height,
            .depth = *depth_.view,
            .normal = convention.encoding == umbrage::NormalEncoding::none ? VkImageView{} : VkImageView(*normal_.view),
            .normal_encoding = convention.encoding};
  serial_++;
  return {.serial = serial_, .completed_serial = serial_ - 1, .cameras = {&camera, 1}};
}

vk::CommandBuffer StubHost::begin_commands() {
  device_.resetCommandPool(*command_pool_, vk::CommandPoolResetFlagBits::eReleaseResources);
  const vk::CommandBuffer commands =
      device_.allocateCommandBuffers({.commandPool = *command_pool_, .commandBufferCount = 1}).front();
  commands.begin(vk::CommandBufferBeginInfo{});
  return commands;
}

void StubHost::draw(vk::CommandBuffer commands, const Scene& scene, const Convention& convention) {
  draw_ = make_draw_pipeline(convention);
  to_attachments(commands);
  vk::RenderingAttachmentInfo depth{.imageView = *depth_.view,
                                    .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
                                    .loadOp = vk::AttachmentLoadOp::eClear,
                                    .storeOp = vk::AttachmentStoreOp::eStore};
  depth.clearValue.depthStencil.depth = convention.near_is_one ? 0.0f : 1.0f;
  const vk::RenderingAttachmentInfo plain{.imageView = *plain_normal_.view,
                                          .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
                                          .loadOp = vk::AttachmentLoadOp::eClear,
                                          .storeOp = vk::AttachmentStoreOp::eStore};
  auto encoded = plain;
  encoded.imageView = *normal_.view;
  const vk::RenderingAttachmentInfo colors[] = {plain, encoded};
  commands.beginRendering({.renderArea = {{0, 0}, {picture_width, picture_height}},
                           .layerCount = 1,
                           .colorAttachmentCount = 2,
                           .pColorAttachments = colors,
                           .pDepthAttachment = &depth});
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *draw_);
  for (const Box& box : scene.boxes) {
    const DrawPush push{vulkan_clip(convention), box.center_ws, box.half_extent};
    commands.pushConstants(*draw_layout_, vk::ShaderStageFlagBits::eVertex, 0, sizeof(push), &push);
    commands.draw(36, 1, 0, 0);
  }
  commands.endRendering();
  to_sampled(commands);
}

void StubHost::read(vk::CommandBuffer commands, const umbrage::ShadowSystem& system, const Scene& scene,
                    const Convention& convention) {
  make_visibility_buffer(uint32_t(scene.lights.size()));
  const umbrage::ShaderInterface shadows = system.shader_interface(umbrage::CameraId{1});
  const bool opengl = convention.opengl_depth;
  const ReadPush push{.shadows = shadows.frame,
                      .visibility = device_.getBufferAddress({.buffer = *visibility_}),
                      .world_from_clip = glm::inverse(convention.clip_from_view * convention.view_from_world),
                      .clip_depth_scale = opengl ? 2.0f : 1.0f,
                      .clip_depth_bias = opengl ? -1.0f : 0.0f,
                      .background = convention.near_is_one ? 0.0f : 1.0f,
                      .lights = uint32_t(scene.lights.size())};
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *read_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *read_layout_, 0, {set_, shadows.set}, {});
  commands.pushConstants(*read_layout_, vk::ShaderStageFlagBits::eCompute, 0, sizeof(push), &push);
  commands.dispatch(picture_width / 8, picture_height / 8, 1);
  const vk::MemoryBarrier2 to_host{.srcStageMask = vk::PipelineStageFlagBits2::eComputeShader,
                                   .srcAccessMask = vk::AccessFlagBits2::eShaderWrite,
                                   .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                   .dstAccessMask = vk::AccessFlagBits2::eHostRead};
  commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &to_host});
}

void StubHost::submit_and_wait(vk::CommandBuffer commands) {
  commands.end();
  queue_.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &commands});
  device_.waitIdle();
}

Visibility StubHost::render(umbrage::ShadowSystem& system, const Scene& scene, const Convention& convention,
                            const std::function<bool(const umbrage::Error&)>& again) {
  umbrage::CameraDesc camera;
  const umbrage::FrameDesc frame = describe(convention, camera);
  auto begun = system.begin_frame(frame);
  if (!begun && again && again(begun.error())) begun = system.begin_frame(frame);
  if (!begun) throw std::runtime_error(begun.error().message);
  const vk::CommandBuffer commands = begin_commands();
  system.record_scene(commands);
  draw(commands, scene, convention);
  system.record_shadows(commands);
  read(commands, system, scene, convention);
  submit_and_wait(commands);

  Visibility result;
  const size_t lights = scene.lights.size();
  for (uint32_t y = 0; y < picture_height; y++) {
    const size_t row = convention.flipped ? picture_height - 1 - y : y;
    for (size_t pixel = row * picture_width; pixel < (row + 1) * picture_width; pixel++) {
      const float* values = visibility_values_ + pixel * (lights + 1);
      result.of.insert(result.of.end(), values, values + lights);
      if (std::any_of(values, values + lights, [](float visibility) { return visibility >= 0; }))
        result.cone_cosines.push_back(values[lights]);
    }
  }
  return result;
}

}  // namespace embedding
