// The smallest host: a box on a plane, one light, seen from above. It draws depth, lets umbrage record, asks for the
// visibility of every pixel in a compute shader and prints how much of the picture lies in shadow.
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <umbrage/umbrage.hpp>
#include <vulkan/vulkan.hpp>

namespace {

constexpr uint32_t draw_depth_spirv[] =
#include "draw_depth.vert.inc"
    ;
constexpr uint32_t count_shadow_spirv[] =
#include "count_shadow.comp.inc"
    ;

constexpr uint32_t picture_size = 512;
constexpr float eye_height_m = 10.0f, near_m = 0.1f;

// A plane of 20 m by 20 m and a box of 2 m on it; what the device reads of them, and the counter that it writes.
struct Shared {
  umbrage::Vec3 positions[12] = {{-10, 0, -10}, {10, 0, -10}, {10, 0, 10}, {-10, 0, 10}, {-1, 0, -1}, {1, 0, -1},
                                 {1, 0, 1},     {-1, 0, 1},   {-1, 2, -1}, {1, 2, -1},   {1, 2, 1},   {-1, 2, 1}};
  uint32_t indices[36] = {0, 1, 2,  0, 2,  3, 8, 9, 10, 8, 10, 11, 4, 5, 9, 4, 9, 8,
                          5, 6, 10, 5, 10, 9, 6, 7, 11, 6, 11, 10, 7, 4, 8, 7, 8, 11};
  uint32_t pixels_in_shadow = 0;
};
constexpr Shared scene;

// Column-major. The camera is at (0, eye_height_m, 0), looks straight down with world z downwards in the picture, and
// sees 90 degrees; depth is reversed and infinite: near_m / distance.
constexpr umbrage::Mat4 view_from_world{{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, -eye_height_m, 1}};
constexpr umbrage::Mat4 clip_from_view{{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 0, near_m, 0}};
constexpr umbrage::Mat4 clip_from_world{{1, 0, 0, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0, near_m, eye_height_m}};

/// The push constants of count_shadow.comp.
struct CountPush {
  vk::DeviceAddress shadows, counter;
  float eye_height, near_plane;
};

void check(const umbrage::Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

template <class T>
T take(umbrage::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}

/// What the host itself needs: a buffer, a depth image, two pipelines.
class Host {
 public:
  Host(const umbrage::DeviceDesc& desc, vk::DescriptorSetLayout umbrage_layout)
      : physical_device_(desc.physical_device), device_(desc.device) {
    make_buffer();
    make_depth_image();
    make_depth_set();
    make_draw_pipeline();
    make_count_pipeline(umbrage_layout);
  }
  vk::ImageView depth_view() const { return *depth_view_; }
  uint32_t pixels_in_shadow() const { return shared_->pixels_in_shadow; }
  void draw_depth(vk::CommandBuffer) const;
  void count_shadow(vk::CommandBuffer, const umbrage::ShaderInterface&) const;

 private:
  void make_buffer();
  void make_depth_image();
  void make_depth_set();
  void make_draw_pipeline();
  void make_count_pipeline(vk::DescriptorSetLayout umbrage_layout);
  vk::UniqueDeviceMemory allocate(const vk::MemoryRequirements&, vk::MemoryPropertyFlags) const;
  void depth_barrier(vk::CommandBuffer, vk::ImageLayout from, vk::ImageLayout to) const;

  vk::PhysicalDevice physical_device_;
  vk::Device device_;
  vk::UniqueDeviceMemory buffer_memory_, depth_memory_;
  vk::UniqueBuffer buffer_;
  Shared* shared_ = nullptr;
  vk::UniqueImage depth_;
  vk::UniqueImageView depth_view_;
  vk::UniqueDescriptorSetLayout set_layout_;
  vk::UniqueDescriptorPool pool_;
  vk::DescriptorSet set_;
  vk::UniquePipelineLayout draw_layout_, count_layout_;
  vk::UniquePipeline draw_, count_;
};

vk::UniqueDeviceMemory Host::allocate(const vk::MemoryRequirements& needed, vk::MemoryPropertyFlags wanted) const {
  const auto memory = physical_device_.getMemoryProperties();
  const vk::MemoryAllocateFlagsInfo flags{.flags = vk::MemoryAllocateFlagBits::eDeviceAddress};
  for (uint32_t type = 0; type < memory.memoryTypeCount; type++)
    if ((needed.memoryTypeBits >> type & 1) && (memory.memoryTypes[type].propertyFlags & wanted) == wanted)
      return device_.allocateMemoryUnique({.pNext = &flags, .allocationSize = needed.size, .memoryTypeIndex = type});
  throw std::runtime_error("no fitting memory type");
}

void Host::make_buffer() {
  using enum vk::BufferUsageFlagBits;
  buffer_ = device_.createBufferUnique(
      {.size = sizeof(Shared), .usage = eVertexBuffer | eIndexBuffer | eStorageBuffer | eShaderDeviceAddress});
  buffer_memory_ = allocate(device_.getBufferMemoryRequirements(*buffer_),
                            vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
  device_.bindBufferMemory(*buffer_, *buffer_memory_, 0);
  shared_ = static_cast<Shared*>(device_.mapMemory(*buffer_memory_, 0, sizeof(Shared)));
  std::memcpy(shared_, &scene, sizeof(Shared));
}

void Host::make_depth_image() {
  depth_ = device_.createImageUnique(
      {.imageType = vk::ImageType::e2D,
       .format = vk::Format::eD32Sfloat,
       .extent = {picture_size, picture_size, 1},
       .mipLevels = 1,
       .arrayLayers = 1,
       .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled});
  depth_memory_ = allocate(device_.getImageMemoryRequirements(*depth_), vk::MemoryPropertyFlagBits::eDeviceLocal);
  device_.bindImageMemory(*depth_, *depth_memory_, 0);
  depth_view_ = device_.createImageViewUnique({.image = *depth_,
                                               .viewType = vk::ImageViewType::e2D,
                                               .format = vk::Format::eD32Sfloat,
                                               .subresourceRange = {vk::ImageAspectFlagBits::eDepth, 0, 1, 0, 1}});
}

void Host::make_depth_set() {
  const vk::DescriptorSetLayoutBinding binding{0, vk::DescriptorType::eSampledImage, 1,
                                               vk::ShaderStageFlagBits::eCompute};
  set_layout_ = device_.createDescriptorSetLayoutUnique({.bindingCount = 1, .pBindings = &binding});
  const vk::DescriptorPoolSize size{vk::DescriptorType::eSampledImage, 1};
  pool_ = device_.createDescriptorPoolUnique({.maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size});
  set_ =
      device_.allocateDescriptorSets({.descriptorPool = *pool_, .descriptorSetCount = 1, .pSetLayouts = &*set_layout_})
          .front();
  const vk::DescriptorImageInfo image{.imageView = *depth_view_, .imageLayout = vk::ImageLayout::eDepthReadOnlyOptimal};
  const vk::WriteDescriptorSet write{
      .dstSet = set_, .descriptorCount = 1, .descriptorType = vk::DescriptorType::eSampledImage, .pImageInfo = &image};
  device_.updateDescriptorSets(write, {});
}

void Host::make_draw_pipeline() {
  const vk::PushConstantRange range{vk::ShaderStageFlagBits::eVertex, 0, sizeof(clip_from_world)};
  draw_layout_ = device_.createPipelineLayoutUnique({.pushConstantRangeCount = 1, .pPushConstantRanges = &range});

  const auto shader =
      device_.createShaderModuleUnique({.codeSize = sizeof(draw_depth_spirv), .pCode = draw_depth_spirv});
  const vk::PipelineShaderStageCreateInfo stage{
      .stage = vk::ShaderStageFlagBits::eVertex, .module = *shader, .pName = "main"};
  const vk::VertexInputBindingDescription binding{.stride = sizeof(umbrage::Vec3)};
  const vk::VertexInputAttributeDescription attribute{.format = vk::Format::eR32G32B32Sfloat};
  const vk::PipelineVertexInputStateCreateInfo input{.vertexBindingDescriptionCount = 1,
                                                     .pVertexBindingDescriptions = &binding,
                                                     .vertexAttributeDescriptionCount = 1,
                                                     .pVertexAttributeDescriptions = &attribute};
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
  const vk::Viewport area{0, 0, picture_size, picture_size, 0, 1};
  const vk::Rect2D scissor{{0, 0}, {picture_size, picture_size}};
  const vk::PipelineViewportStateCreateInfo viewport{
      .viewportCount = 1, .pViewports = &area, .scissorCount = 1, .pScissors = &scissor};
  const vk::PipelineRasterizationStateCreateInfo raster{.lineWidth = 1};
  const vk::PipelineMultisampleStateCreateInfo samples{.rasterizationSamples = vk::SampleCountFlagBits::e1};
  const vk::PipelineDepthStencilStateCreateInfo depth{
      .depthTestEnable = true, .depthWriteEnable = true, .depthCompareOp = vk::CompareOp::eGreater};
  const vk::PipelineRenderingCreateInfo rendering{.depthAttachmentFormat = vk::Format::eD32Sfloat};
  draw_ = device_
              .createGraphicsPipelineUnique(nullptr, {.pNext = &rendering,
                                                      .stageCount = 1,
                                                      .pStages = &stage,
                                                      .pVertexInputState = &input,
                                                      .pInputAssemblyState = &assembly,
                                                      .pViewportState = &viewport,
                                                      .pRasterizationState = &raster,
                                                      .pMultisampleState = &samples,
                                                      .pDepthStencilState = &depth,
                                                      .layout = *draw_layout_})
              .value;
}

/// Set 0 is the host's: depth. Set 1 is umbrage's, as UMBRAGE_SET says in the shader.
void Host::make_count_pipeline(vk::DescriptorSetLayout umbrage_layout) {
  const vk::PushConstantRange range{vk::ShaderStageFlagBits::eCompute, 0, sizeof(CountPush)};
  const vk::DescriptorSetLayout sets[] = {*set_layout_, umbrage_layout};
  count_layout_ = device_.createPipelineLayoutUnique(
      {.setLayoutCount = 2, .pSetLayouts = sets, .pushConstantRangeCount = 1, .pPushConstantRanges = &range});
  const auto shader =
      device_.createShaderModuleUnique({.codeSize = sizeof(count_shadow_spirv), .pCode = count_shadow_spirv});
  count_ = device_
               .createComputePipelineUnique(
                   nullptr, {.stage = {.stage = vk::ShaderStageFlagBits::eCompute, .module = *shader, .pName = "main"},
                             .layout = *count_layout_})
               .value;
}

void Host::depth_barrier(vk::CommandBuffer commands, vk::ImageLayout from, vk::ImageLayout to) const {
  const vk::ImageMemoryBarrier2 barrier{
      .srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
      .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
      .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
      .dstAccessMask = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite,
      .oldLayout = from,
      .newLayout = to,
      .image = *depth_,
      .subresourceRange = {vk::ImageAspectFlagBits::eDepth, 0, 1, 0, 1}};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

void Host::draw_depth(vk::CommandBuffer commands) const {
  depth_barrier(commands, vk::ImageLayout::eUndefined, vk::ImageLayout::eDepthAttachmentOptimal);
  const vk::RenderingAttachmentInfo attachment{.imageView = *depth_view_,
                                               .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
                                               .loadOp = vk::AttachmentLoadOp::eClear,
                                               .storeOp = vk::AttachmentStoreOp::eStore};
  commands.beginRendering(
      {.renderArea = {{0, 0}, {picture_size, picture_size}}, .layerCount = 1, .pDepthAttachment = &attachment});
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *draw_);
  commands.pushConstants(*draw_layout_, vk::ShaderStageFlagBits::eVertex, 0, sizeof(clip_from_world), &clip_from_world);
  commands.bindVertexBuffers(0, *buffer_, {offsetof(Shared, positions)});
  commands.bindIndexBuffer(*buffer_, offsetof(Shared, indices), vk::IndexType::eUint32);
  commands.drawIndexed(std::size(scene.indices), 1, 0, 0, 0);
  commands.endRendering();
  depth_barrier(commands, vk::ImageLayout::eDepthAttachmentOptimal, vk::ImageLayout::eDepthReadOnlyOptimal);
}

void Host::count_shadow(vk::CommandBuffer commands, const umbrage::ShaderInterface& shadows) const {
  const auto counter = device_.getBufferAddress({.buffer = *buffer_}) + offsetof(Shared, pixels_in_shadow);
  const CountPush push{shadows.frame, counter, eye_height_m, near_m};
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *count_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *count_layout_, 0, {set_, shadows.set}, {});
  commands.pushConstants(*count_layout_, vk::ShaderStageFlagBits::eCompute, 0, sizeof(push), &push);
  commands.dispatch(picture_size / 8, picture_size / 8, 1);
  const vk::MemoryBarrier2 to_host{.srcStageMask = vk::PipelineStageFlagBits2::eComputeShader,
                                   .srcAccessMask = vk::AccessFlagBits2::eShaderWrite,
                                   .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                   .dstAccessMask = vk::AccessFlagBits2::eHostRead};
  commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &to_host});
}

void run() {
  // A host with a device of its own gives that to ShadowSystem::create instead: see umbrage::requirements().
  const auto headless = take(umbrage::HeadlessDevice::create({.get_instance_proc_addr = vkGetInstanceProcAddr}));
  const umbrage::DeviceDesc desc = headless.desc();
  auto system = take(umbrage::ShadowSystem::create(desc, {.budget_mib = 32}));
  const auto mesh = take(system.add_mesh({.positions = scene.positions, .indices = scene.indices}));
  take(system.add_instance({.mesh = mesh}));
  take(system.add_light({.position = {4, 6, 0}, .range_m = 20}));
  const Host host(desc, system.descriptor_set_layout());

  const vk::Device device = desc.device;
  const auto pool = device.createCommandPoolUnique({.queueFamilyIndex = desc.queue_family});
  const vk::CommandBuffer commands =
      device.allocateCommandBuffers({.commandPool = *pool, .commandBufferCount = 1}).front();

  // A frame: begin, record the scene, draw depth, record the shadows, shade.
  const umbrage::CameraDesc camera{.view_from_world = view_from_world,
                                   .clip_from_view = clip_from_view,
                                   .width = picture_size,
                                   .height = picture_size,
                                   .depth = host.depth_view()};
  check(system.begin_frame({.serial = 1, .cameras = {&camera, 1}}));
  commands.begin(vk::CommandBufferBeginInfo{});
  system.record_scene(commands);
  host.draw_depth(commands);
  system.record_shadows(commands);
  host.count_shadow(commands, system.shader_interface(camera.id));
  commands.end();
  vk::Queue(headless.queue()).submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &commands});
  device.waitIdle();

  // The box's shadow, less what the box hides of it, covers 7.31 of the 400 square metres in sight: 1.83 %.
  const double share = double(host.pixels_in_shadow()) / (picture_size * picture_size);
  std::printf("%.2f %% of the picture is in shadow\n", 100.0 * share);
}

}  // namespace

int main() {
  try {
    run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "minimal: error: %s\n", error.what());
    return 1;
  }
}
