// Clear, rasterise each list, rasterise what was queued, pack if the image has 16 bits, copy.
#include "layered/write_depth.hpp"

#include <algorithm>

namespace umbrage::layered {

namespace {
constexpr uint32_t kRasterizeBatches[] =
#include "shaders/rasterize_batches.comp.inc"
    ;
constexpr uint32_t kRasterizeLarge[] =
#include "shaders/rasterize_large.comp.inc"
    ;
constexpr uint32_t kPackDepth[] =
#include "shaders/pack_depth.comp.inc"
    ;
constexpr uint32_t kQueueRoom = 1u << 18;  // 3 MiB; what finds no room is drawn by one thread
constexpr uint32_t kPackGroups = 4096;

void transition(const gpu::Device& device, VkCommandBuffer commands, const ViewGroup& group, VkImage image,
                bool to_copy) {
  constexpr VkPipelineStageFlags2 kDepthStages =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  constexpr VkAccessFlags2 kDepthAccess =
      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = to_copy ? kDepthStages : VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.srcAccessMask = to_copy ? kDepthAccess : VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.dstStageMask = to_copy ? VK_PIPELINE_STAGE_2_COPY_BIT : kDepthStages;
  barrier.dstAccessMask = to_copy ? VK_ACCESS_2_TRANSFER_WRITE_BIT : kDepthAccess;
  barrier.oldLayout = to_copy ? VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.newLayout = to_copy ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, group.first_layer, group.layer_count};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  device.vk().vkCmdPipelineBarrier2(commands, &info);
}
}  // namespace

Result<DepthWriter> DepthWriter::create(const gpu::PipelineFactory& factory, const LayeredPassSettings& settings,
                                        bool masked) {
  DepthWriter out;
  out.is_reversed_ = settings.depth_order == DepthOrder::larger_is_nearer;
  for (uint32_t with_masks = 0; with_masks < (masked ? 2u : 1u); ++with_masks) {
    const std::initializer_list<gpu::Constant> constants{{0, static_cast<uint32_t>(settings.vertices)},
                                                         {1, static_cast<uint32_t>(settings.culled_faces)},
                                                         {3, settings.selection == CasterSelection::each_view},
                                                         {4, out.is_reversed_},
                                                         {5, with_masks}};
    auto batches = factory.compute(kRasterizeBatches, "rasterize batches", constants);
    if (!batches) return batches.error();
    out.batches_[with_masks] = std::move(*batches);
    auto large = factory.compute(kRasterizeLarge, "rasterize large", constants);
    if (!large) return large.error();
    out.large_[with_masks] = std::move(*large);
  }
  if (settings.depth_format == VK_FORMAT_D16_UNORM) {
    auto pack = factory.compute(kPackDepth, "pack depth");
    if (!pack) return pack.error();
    out.pack_ = std::move(*pack);
  }
  return out;
}

Result<void> DepthWriter::reserve(const gpu::Device& device, gpu::Memory& memory, VkDeviceSize texels, bool is_half,
                                  std::vector<gpu::Buffer>& outgrown) {
  const VkDeviceSize even = texels + texels % 2;
  if (auto ok = gpu::grow(keys_, device, memory, even * sizeof(uint32_t), "depth keys", outgrown); !ok)
    return ok.error();
  if (is_half)
    if (auto ok = gpu::grow(halves_, device, memory, even * sizeof(uint16_t), "packed depth", outgrown); !ok)
      return ok.error();
  if (auto ok =
          gpu::grow(queue_, device, memory, kQueueRoom * sizeof(shared::LargeTriangle), "large triangles", outgrown);
      !ok)
    return ok.error();
  return gpu::grow(queue_count_, device, memory, sizeof(shared::LayeredCount), "large triangle count", outgrown);
}

void DepthWriter::record(gpu::Recorder& recorder, VkCommandBuffer commands, const Group& group) const {
  using enum gpu::Access;
  const gpu::Functions& vk = recorder.device().vk();
  {
    gpu::Pass pass = recorder.pass("clear depth keys");
    pass.write(keys_, transfer_write);
    pass.write(queue_count_, transfer_write);
    pass.read(group.block, transfer_read);
    pass.commands();
    vk.vkCmdFillBuffer(commands, keys_.handle(), 0, VK_WHOLE_SIZE, is_reversed_ ? 0u : 0x3f800000u);
    const VkBufferCopy count{group.empty_count, 0, sizeof(shared::LayeredCount)};
    vk.vkCmdCopyBuffer(commands, group.block.handle(), queue_count_.handle(), 1, &count);
  }
  shared::ComputeWritePush push{.scene = group.scene,
                                .indices = group.indices,
                                .queue_room = kQueueRoom,
                                .first_view = group.views.first_view,
                                .view_count = group.views.view_count,
                                .first_layer = group.views.first_layer,
                                .width = group.target.width,
                                .height = group.target.height};
  {
    gpu::Pass pass = recorder.pass("rasterize batches");
    pass.read(group.geometry), pass.read(group.moving), pass.read(group.visible), pass.read(group.block),
        pass.read(group.block, indirect_read);
    push.keys = pass.write(keys_);
    push.queue = pass.write(queue_);
    push.queue_count = pass.write(queue_count_);
    const VkDeviceAddress listed = pass.read(group.listed) + group.first_listed;
    for (uint32_t list = 0; list < group.list_count; ++list) {
      push.list = listed + VkDeviceSize(list) * group.caster_count * sizeof(uint32_t);
      pass.dispatch_indirect(batches_[list & 1], push, group.block,
                             group.first_count + list * sizeof(shared::LayeredCount));
    }
  }
  {
    gpu::Pass pass = recorder.pass("rasterize large");
    pass.read(group.geometry), pass.read(group.moving), pass.read(group.visible), pass.read(group.block),
        pass.read(queue_);
    pass.read(queue_count_), pass.read(queue_count_, indirect_read);
    pass.write(keys_);
    for (uint32_t list = 0; list < std::min(group.list_count, 2u); ++list)
      pass.dispatch_indirect(large_[list], push, queue_count_, 0);
  }
  copy(recorder, commands, group);
}

void DepthWriter::copy(gpu::Recorder& recorder, VkCommandBuffer commands, const Group& group) const {
  using enum gpu::Access;
  const bool is_half = group.target.depth_format == VK_FORMAT_D16_UNORM;
  const VkDeviceSize texels = VkDeviceSize(group.target.width) * group.target.height * group.views.layer_count;
  if (is_half) {
    gpu::Pass pass = recorder.pass("pack depth");
    const auto words = static_cast<uint32_t>((texels + 1) / 2);
    const shared::PackPush push{.keys = pass.read(keys_), .halves = pass.write(halves_), .words = words};
    pass.dispatch(pack_, push, std::min((words + 255) / 256, kPackGroups));
  }
  const gpu::Buffer& source = is_half ? halves_ : keys_;
  gpu::Pass pass = recorder.pass("copy depth");
  pass.read(source, transfer_read);
  pass.commands();
  transition(recorder.device(), commands, group.views, group.target.depth, true);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, group.views.first_layer, group.views.layer_count};
  region.imageExtent = {group.target.width, group.target.height, 1};
  recorder.device().vk().vkCmdCopyBufferToImage(commands, source.handle(), group.target.depth,
                                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
  transition(recorder.device(), commands, group.views, group.target.depth, false);
}

}  // namespace umbrage::layered
