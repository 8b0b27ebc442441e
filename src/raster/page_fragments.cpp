// Items are worked off in windows, so that what the draws need stays small however many items there are.
#include "raster/page_fragments.hpp"

#include <algorithm>
#include <array>

namespace umbrage::raster {

namespace {
constexpr uint32_t kList[] =
#include "shaders/list_page_draws.comp.inc"
    ;
constexpr uint32_t kCastVertex[] =
#include "shaders/cast_page.vert.inc"
    ;
constexpr uint32_t kWriteFragment[] =
#include "shaders/write_page.frag.inc"
    ;

void begin(const gpu::Functions& vk, VkCommandBuffer commands, uint32_t side) {
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, {side, side}};
  info.layerCount = 1;
  vk.vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0, 0, float(side), float(side), 0, 1};
  vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  vk.vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}
}  // namespace

Result<PageFragments> PageFragments::create(const gpu::PipelineFactory& factory) {
  PageFragments out;
  auto list = factory.compute(kList, "list page draws");
  if (!list) return list.error();
  out.list_ = std::move(*list);
  constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT, kWords = VK_FORMAT_R32G32B32A32_UINT;
  constexpr std::array<VkFormat, 10> kAttributes{kFloats, kFloats, kFloats, kFloats, kFloats,
                                                 kFloats, kFloats, kWords,  kWords,  kFloats};
  for (uint32_t masked = 0; masked < 2; ++masked) {
    const gpu::DepthShaders shaders{.vertex = kCastVertex,
                                    .fragment = kWriteFragment,
                                    .instance_attributes = kAttributes,
                                    .instance_stride_bytes = sizeof(shared::PageInstance),
                                    .attachment = VK_FORMAT_UNDEFINED};
    auto made = factory.depth(shaders, masked ? "cast into pages, masked" : "cast into pages", {{0, masked}});
    if (!made) return made.error();
    out.cast_[masked] = std::move(*made);
  }
  return out;
}

Result<void> PageFragments::reserve(const gpu::Device& device, gpu::Memory& memory) {
  const struct {
    gpu::Buffer& target;
    VkDeviceSize bytes;
    const char* name;
  } needs[] = {{instances_, VkDeviceSize(shared::DrawWindow) * shared::CubeFaceCount * sizeof(shared::PageInstance),
                "page instances"},
               {commands_, shared::DrawWindow * sizeof(shared::DrawCommand), "page draws"},
               {draw_count_, sizeof(uint32_t), "page draw count"}};
  for (const auto& need : needs) {
    if (need.target) continue;
    auto made = gpu::Buffer::create(device, memory, need.bytes, gpu::MemoryKind::device, need.name);
    if (!made) return made.error();
    need.target = std::move(*made);
  }
  return {};
}

void PageFragments::record(gpu::Recorder& recorder, const PageWriterInputs& in, uint32_t max_resolution) const {
  for (uint32_t masked = 0; masked < (in.scene.has_masked() ? 2u : 1u); ++masked)
    for (uint32_t first = 0; first < in.item_capacity; first += shared::DrawWindow)
      record_window(recorder, in, max_resolution, masked, first);
}

void PageFragments::record_window(gpu::Recorder& recorder, const PageWriterInputs& in, uint32_t max_resolution,
                                  bool masked, uint32_t first) const {
  const uint32_t window = std::min(shared::DrawWindow, in.item_capacity - first);
  {
    gpu::Pass pass = recorder.pass("list page draws");
    for (const gpu::Buffer* buffer : {&in.maps, &in.views}) pass.read(*buffer);
    const shared::ListDrawsPush push{.frame = pass.read(in.frame),
                                     .casters = pass.read(in.scene.caster_buffer()),
                                     .instances = pass.read(in.scene.instance_buffer()),
                                     .batches = pass.read(in.scene.batch_buffer()),
                                     .items = pass.read(in.items),
                                     .counts = pass.read(in.counts),
                                     .drawn = pass.write(instances_),
                                     .commands = pass.write(commands_),
                                     .draw_count = pass.write(draw_count_),
                                     .masked = masked,
                                     .first = first,
                                     .window = window,
                                     .item_capacity = in.item_capacity};
    pass.dispatch(list_, push, (window + shared::RasterThreads - 1) / shared::RasterThreads);
  }
  using enum gpu::Access;
  gpu::Pass pass = recorder.pass("cast into pages");
  pass.read(in.scene.index_buffer(), index_read);
  pass.read(instances_, vertex_attribute_read);
  pass.read(commands_, indirect_read);
  pass.read(draw_count_, indirect_read);
  for (const gpu::Buffer* buffer : {&in.page_bits, &in.page_first}) pass.read(*buffer, fragment_read);
  pass.write(in.pool, fragment_write);
  const shared::CastPagePush push{.frame = pass.read(in.frame, fragment_read),
                                  .batches = pass.read(in.scene.batch_buffer(), fragment_read),
                                  .viewport_size = {max_resolution, max_resolution}};
  const gpu::Functions& vk = recorder.device().vk();
  const VkCommandBuffer commands = pass.commands();
  begin(vk, commands, max_resolution);
  vk.vkCmdBindIndexBuffer(commands, in.scene.index_buffer().handle(), 0, VK_INDEX_TYPE_UINT32);
  const VkBuffer instances = instances_.handle();
  const VkDeviceSize offset = 0;
  vk.vkCmdBindVertexBuffers(commands, 0, 1, &instances, &offset);
  pass.bind_graphics(cast_[masked], push);
  vk.vkCmdDrawIndexedIndirectCount(commands, commands_.handle(), 0, draw_count_.handle(), 0, window,
                                   sizeof(shared::DrawCommand));
  vk.vkCmdEndRendering(commands);
}

}  // namespace umbrage::raster
