// Plain Vulkan through volk; every wait is a full one.
#define VOLK_IMPLEMENTATION
#include "gpu.hpp"

#include <array>
#include <cstring>
#include <utility>

#include "validation_layers.hpp"

namespace umbrage::test {

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS) throw std::runtime_error(std::string(call) + ": " + gpu::result_name(result));
}

namespace {

void barrier(VkCommandBuffer commands) {
  VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
  all.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;
  all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &all;
  vkCmdPipelineBarrier2(commands, &info);
}

void transition(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  change.srcStageMask = change.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  change.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  change.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  change.oldLayout = from, change.newLayout = to;
  change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  change.image = image.handle();
  change.subresourceRange = {image.aspect(), 0, 1, 0, 1};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &change;
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

Image::Image(const Gpu& gpu, VkFormat format, VkImageAspectFlags aspect, uint32_t width, uint32_t height)
    : device_(gpu.desc().device), aspect_(aspect), extent_{width, height, 1} {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = extent_;
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  check(vkCreateImage(device_, &info, nullptr, &handle_), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device_, handle_, &needs);
  VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocation.allocationSize = needs.size;
  const int type = gpu.device().memory_type(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  if (type < 0) throw std::runtime_error("no memory type fits an image of the test");
  allocation.memoryTypeIndex = static_cast<uint32_t>(type);
  check(vkAllocateMemory(device_, &allocation, nullptr, &memory_), "vkAllocateMemory");
  check(vkBindImageMemory(device_, handle_, memory_, 0), "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = handle_;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspect, 0, 1, 0, 1};
  check(vkCreateImageView(device_, &view, nullptr, &view_), "vkCreateImageView");
}

Image::Image(Image&& other) noexcept
    : device_(other.device_),
      handle_(std::exchange(other.handle_, VK_NULL_HANDLE)),
      view_(std::exchange(other.view_, VK_NULL_HANDLE)),
      memory_(std::exchange(other.memory_, VK_NULL_HANDLE)),
      aspect_(other.aspect_),
      extent_(other.extent_) {}

Image::~Image() {
  vkDestroyImageView(device_, view_, nullptr);
  vkDestroyImage(device_, handle_, nullptr);
  vkFreeMemory(device_, memory_, nullptr);
}

Program::Program(const Gpu& gpu, std::span<const uint32_t> spirv, std::span<const VkDescriptorSetLayout> sets)
    : device_(gpu.desc().device) {
  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, gpu::kPushBytes};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = static_cast<uint32_t>(sets.size());
  layout.pSetLayouts = sets.data();
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
  VkShaderModuleCreateInfo words{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  words.codeSize = spirv.size_bytes();
  words.pCode = spirv.data();
  VkShaderModule shader;
  check(vkCreateShaderModule(device_, &words, nullptr, &shader), "vkCreateShaderModule");
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                nullptr,
                0,
                VK_SHADER_STAGE_COMPUTE_BIT,
                shader,
                "main",
                nullptr};
  info.layout = layout_;
  const VkResult made = vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
  vkDestroyShaderModule(device_, shader, nullptr);
  check(made, "vkCreateComputePipelines");
}

Program::~Program() {
  vkDestroyPipeline(device_, pipeline_, nullptr);
  vkDestroyPipelineLayout(device_, layout_, nullptr);
}

Gpu::Gpu() {
  check(volkInitialize(), "volkInitialize");
  const MessageCallback collect = [](void* user, Severity, std::string_view text) {
    static_cast<Gpu*>(user)->messages_.emplace_back(text);
  };
  owner_ = std::make_unique<HeadlessDevice>(take(
      HeadlessDevice::create({.get_instance_proc_addr = vkGetInstanceProcAddr,
                              .validate = true,
                              .message = collect,
                              .message_user = this,
                              .wanted = {.vertex_layer = true, .sparse_residency = true, .shader_residency = true}})));
  keep_validation_layers();
  desc_ = owner_->desc();
  queue_ = owner_->queue();
  volkLoadInstance(desc_.instance);
  volkLoadDevice(desc_.device);
  device_ = take(gpu::Device::create(desc_));
  memory_ = std::make_unique<gpu::Memory>(*device_);
  factory_ = take(gpu::PipelineFactory::create(*device_, 16));

  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = desc_.queue_family;
  check(vkCreateCommandPool(desc_.device, &pool, nullptr, &commands_), "vkCreateCommandPool");
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2}, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16}}};
  VkDescriptorPoolCreateInfo sets{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  sets.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
  sets.maxSets = 2;
  sets.poolSizeCount = static_cast<uint32_t>(sizes.size());
  sets.pPoolSizes = sizes.data();
  check(vkCreateDescriptorPool(desc_.device, &sets, nullptr, &sets_), "vkCreateDescriptorPool");
  const std::array<VkDescriptorSetLayout, 2> layouts{factory_->frame_set_layout(), factory_->mask_set_layout()};
  VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocation.descriptorPool = sets_;
  allocation.descriptorSetCount = 2;
  allocation.pSetLayouts = layouts.data();
  std::array<VkDescriptorSet, 2> made{};
  check(vkAllocateDescriptorSets(desc_.device, &allocation, made.data()), "vkAllocateDescriptorSets");
  frame_set_ = made[0], mask_set_ = made[1];
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  check(vkCreateSampler(desc_.device, &sampler, nullptr, &sampler_), "vkCreateSampler");
}

Gpu::~Gpu() {
  vkDestroySampler(desc_.device, sampler_, nullptr);
  vkDestroyDescriptorPool(desc_.device, sets_, nullptr);
  vkDestroyCommandPool(desc_.device, commands_, nullptr);
  factory_.reset();
  memory_.reset();
  device_.reset();
  owner_.reset();  // the layers name what has been left behind
  for (const std::string& message : messages_) ADD_FAILURE() << "validation: " << message;
}

VkCommandBuffer Gpu::begin() {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = commands_;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands;
  check(vkAllocateCommandBuffers(desc_.device, &info, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo once{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  once.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &once), "vkBeginCommandBuffer");
  return commands;
}

void Gpu::submit(VkCommandBuffer commands, VkFence fence) {
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue_, 1, &info, fence), "vkQueueSubmit");
}

void Gpu::run(const std::function<void(VkCommandBuffer)>& record) {
  VkCommandBuffer commands = begin();
  record(commands);
  submit(commands, VK_NULL_HANDLE);
  check(vkQueueWaitIdle(queue_), "vkQueueWaitIdle");
  vkFreeCommandBuffers(desc_.device, commands_, 1, &commands);
}

gpu::Buffer Gpu::buffer(VkDeviceSize bytes, gpu::MemoryKind kind, const char* name) {
  return take(gpu::Buffer::create(*device_, *memory_, bytes, kind, name));
}

gpu::Buffer Gpu::upload(const void* data, size_t bytes) {
  gpu::Buffer staging = buffer(bytes, gpu::MemoryKind::upload, "test staging");
  gpu::Buffer target = buffer(bytes, gpu::MemoryKind::device, "test data");
  if (bytes == 0) return target;
  std::memcpy(staging.mapped(), data, bytes);
  run([&](VkCommandBuffer commands) {
    const VkBufferCopy all{0, 0, bytes};
    vkCmdCopyBuffer(commands, staging.handle(), target.handle(), 1, &all);
    barrier(commands);
  });
  return target;
}

void Gpu::fill(const Image& image, const void* texels, size_t bytes, VkImageLayout layout) {
  gpu::Buffer staging = buffer(bytes, gpu::MemoryKind::upload, "test texels");
  std::memcpy(staging.mapped(), texels, bytes);
  run([&](VkCommandBuffer commands) {
    transition(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy all{};
    all.imageSubresource = {image.aspect(), 0, 0, 1};
    all.imageExtent = image.extent();
    vkCmdCopyBufferToImage(commands, staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &all);
    transition(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
  });
}

void Gpu::read(const gpu::Buffer& from, VkDeviceSize offset, void* data, size_t bytes) {
  if (offset + bytes > from.size()) throw std::runtime_error(std::string("read beyond the end of ") + from.name());
  const gpu::Buffer target = buffer(bytes, gpu::MemoryKind::readback, "test read-back");
  run([&](VkCommandBuffer commands) {
    barrier(commands);
    const VkBufferCopy part{offset, 0, bytes};
    vkCmdCopyBuffer(commands, from.handle(), target.handle(), 1, &part);
    barrier(commands);
  });
  std::memcpy(data, target.mapped(), bytes);
}

void Gpu::set_mask(uint32_t slot, const Image& image) {
  const VkDescriptorImageInfo info{sampler_, image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = mask_set_;
  write.dstArrayElement = slot;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  write.pImageInfo = &info;
  vkUpdateDescriptorSets(desc_.device, 1, &write, 0, nullptr);
}

gpu::Recorder Gpu::recorder(VkCommandBuffer commands, gpu::HazardLog* log) {
  return {*device_, *factory_, commands, nullptr, frame_set_, mask_set_, log};
}

void GpuTest::TearDown() {
  for (const std::string& message : gpu().take_messages()) ADD_FAILURE() << "validation: " << message;
}

}  // namespace umbrage::test
