// Lists first, then a rendering an image: what is drawn, and how much, the device alone knows.
#include "raster/layer_writer.hpp"

#include <algorithm>
#include <array>

namespace umbrage::raster {

namespace {
constexpr uint32_t kListClears[] =
#include "shaders/list_layer_clears.comp.inc"
    ;
constexpr uint32_t kClearVertex[] =
#include "shaders/clear_layers.vert.inc"
    ;
constexpr uint32_t kClearWords[] =
#include "shaders/clear_words.comp.inc"
    ;
constexpr uint32_t kListDraws[] =
#include "shaders/list_layer_draws.comp.inc"
    ;
constexpr uint32_t kCastLayerVertex[] =
#include "shaders/cast_layer.vert.inc"
    ;
constexpr uint32_t kMaskFragment[] =
#include "shaders/mask.frag.inc"
    ;
constexpr uint32_t kCastPageVertex[] =
#include "shaders/cast_page.vert.inc"
    ;
constexpr uint32_t kWriteTexel[] =
#include "shaders/write_texel.frag.inc"
    ;
constexpr uint32_t kWriteResidentTexel[] =
#include "shaders/write_resident_texel.frag.inc"
    ;
constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT, kWords = VK_FORMAT_R32G32B32A32_UINT;
constexpr std::array<VkFormat, 10> kAttributes{kFloats, kFloats, kFloats, kFloats, kFloats,
                                               kFloats, kFloats, kWords,  kWords,  kFloats};

/// attachment: null where fragments write what they like.
void begin(const gpu::Functions& vk, VkCommandBuffer commands, const gpu::Image* attachment, uint32_t side) {
  VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = {side, side};
  info.layerCount = 1;
  if (attachment) {
    depth.imageView = attachment->view();
    info.layerCount = attachment->layers();
    info.pDepthAttachment = &depth;
  }
  vk.vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0, 0, float(side), float(side), 0, 1};
  vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  vk.vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}

void fill_zero(gpu::Recorder& recorder, const char* pass_name, std::initializer_list<const gpu::Buffer*> buffers) {
  gpu::Pass pass = recorder.pass(pass_name);
  for (const gpu::Buffer* buffer : buffers) pass.write(*buffer, gpu::Access::transfer_write);
  const VkCommandBuffer commands = pass.commands();
  for (const gpu::Buffer* buffer : buffers)
    recorder.device().vk().vkCmdFillBuffer(commands, buffer->handle(), 0, VK_WHOLE_SIZE, 0);
}

Result<void> make(gpu::Pipeline& target, Result<gpu::Pipeline> made) {
  if (!made) return made.error();
  target = std::move(*made);
  return {};
}
}  // namespace

Result<LayerWriter> LayerWriter::create(const gpu::PipelineFactory& factory, Target target) {
  LayerWriter out;
  out.target_ = target;
  if (auto ok = make(out.list_draws_, factory.compute(kListDraws, "list layer draws")); !ok) return ok.error();
  if (auto ok = target == Target::depth16 ? out.create_for_attachments(factory) : out.create_for_words(factory); !ok)
    return ok.error();
  return out;
}

Result<void> LayerWriter::create_for_attachments(const gpu::PipelineFactory& factory) {
  if (auto ok = make(list_clears_, factory.compute(kListClears, "list layer clears")); !ok) return ok.error();
  const gpu::DepthShaders clear{
      .vertex = kClearVertex, .attachment = VK_FORMAT_D16_UNORM, .compare = VK_COMPARE_OP_ALWAYS};
  if (auto ok = make(clear_, factory.depth(clear, "clear layers")); !ok) return ok.error();
  for (uint32_t masked = 0; masked < 2; ++masked) {
    const gpu::DepthShaders cast{
        .vertex = kCastLayerVertex,
        .fragment = masked ? std::span<const uint32_t>(kMaskFragment) : std::span<const uint32_t>{},
        .instance_attributes = kAttributes,
        .instance_stride_bytes = sizeof(shared::PageInstance),
        .attachment = VK_FORMAT_D16_UNORM};
    const char* name = masked ? "cast into layers, masked" : "cast into layers";
    if (auto ok = make(cast_[masked], factory.depth(cast, name, {{0, masked}})); !ok) return ok.error();
  }
  return {};
}

Result<void> LayerWriter::create_for_words(const gpu::PipelineFactory& factory) {
  if (auto ok = make(clear_, factory.compute(kClearWords, "clear words")); !ok) return ok.error();
  for (uint32_t masked = 0; masked < 2; ++masked) {
    const bool asks = target_ == Target::resident_words;
    const gpu::DepthShaders cast{
        .vertex = kCastPageVertex,
        .fragment = asks ? std::span<const uint32_t>(kWriteResidentTexel) : std::span<const uint32_t>(kWriteTexel),
        .instance_attributes = kAttributes,
        .instance_stride_bytes = sizeof(shared::PageInstance),
        .attachment = VK_FORMAT_UNDEFINED};
    const char* name = masked ? "cast into words, masked" : "cast into words";
    if (auto ok = make(cast_[masked], factory.depth(cast, name, {{0, masked}})); !ok) return ok.error();
  }
  return {};
}

Result<void> LayerWriter::reserve(const gpu::Device& device, gpu::Memory& memory, const store::ImageLayout& layout,
                                  std::vector<gpu::Buffer>& retired) {
  const VkDeviceSize images = layout.images.size();
  VkDeviceSize layers = 0;
  for (const shared::MapImage& image : layout.images) layers += image.layers;
  const struct {
    gpu::Buffer& target;
    VkDeviceSize bytes;
    const char* name;
  } all[] = {
      {layers_, layers * sizeof(uint32_t), "layers to clear"},
      {clears_, images * sizeof(shared::ClearCommand), "layer clears"},
      {clear_counts_, images * sizeof(uint32_t), "layer clear counts"},
      {instances_, VkDeviceSize(kLayerItems) * shared::CubeFaceCount * sizeof(shared::PageInstance), "layer instances"},
      {commands_, 2 * images * kLayerItems * sizeof(shared::DrawCommand), "layer draws"},
      {draw_counts_, 2 * images * sizeof(uint32_t), "layer draw counts"}};
  for (const auto& entry : all)
    if (auto ok = gpu::grow(entry.target, device, memory, entry.bytes, entry.name, retired); !ok) return ok;
  return {};
}

void LayerWriter::record_clear(gpu::Recorder& recorder, const Inputs& in) const {
  gpu::Scope scope(recorder, "clear layers");
  if (target_ != Target::depth16) {
    record_word_clear(recorder, in);
    return;
  }
  fill_zero(recorder, "clear layer clears", {&clears_, &clear_counts_});
  {
    gpu::Pass pass = recorder.pass("list layer clears");
    pass.read(in.maps), pass.read(in.counters, gpu::Access::indirect_read);
    const shared::ListLayersPush push{.frame = pass.read(in.frame),
                                      .commands = pass.write(clears_),
                                      .counts = pass.write(clear_counts_),
                                      .images = in.image_table,
                                      .layers = pass.write(layers_)};
    pass.dispatch_indirect(list_clears_, push, in.counters, offsetof(shared::FrameCounters, map_groups));
  }
  gpu::Pass pass = recorder.pass("clear layers");
  pass.read(clears_, gpu::Access::indirect_read), pass.read(clear_counts_, gpu::Access::indirect_read);
  shared::ClearLayersPush push{.layers = pass.read(layers_, gpu::Access::vertex_read)};
  for (const gpu::Image& image : in.images.images()) pass.image(image, gpu::Access::depth_attachment);
  const VkCommandBuffer commands = pass.commands();
  const gpu::Functions& vk = recorder.device().vk();
  for (uint32_t i = 0; i < in.images.images().size(); ++i) {
    const gpu::Image& image = in.images.images()[i];
    push.image_side = float(image.width());
    begin(vk, commands, &image, image.width());
    pass.bind_graphics(clear_, push);
    vk.vkCmdDrawIndirectCount(commands, clears_.handle(), i * sizeof(shared::ClearCommand), clear_counts_.handle(),
                              i * sizeof(uint32_t), 1, sizeof(shared::ClearCommand));
    vk.vkCmdEndRendering(commands);
  }
}

void LayerWriter::record_word_clear(gpu::Recorder& recorder, const Inputs& in) const {
  gpu::Pass pass = recorder.pass("clear words");
  pass.read(in.maps), pass.read(in.page_bits), pass.read(in.counters, gpu::Access::indirect_read);
  for (const gpu::Image& image : in.images.images()) pass.image(image, gpu::Access::compute_write);
  const shared::ClearWordsPush push{.frame = pass.read(in.frame)};
  pass.dispatch_indirect(clear_, push, in.counters, offsetof(shared::FrameCounters, map_groups));
}

void LayerWriter::list_draws(gpu::Recorder& recorder, const Inputs& in) const {
  fill_zero(recorder, "clear layer draw counts", {&draw_counts_});
  gpu::Pass pass = recorder.pass("list layer draws");
  pass.read(in.maps), pass.read(in.views);
  const shared::ListLayersPush push{.frame = pass.read(in.frame),
                                    .casters = pass.read(in.scene.caster_buffer()),
                                    .instances = pass.read(in.scene.instance_buffer()),
                                    .batches = pass.read(in.scene.batch_buffer()),
                                    .items = pass.read(in.items),
                                    .counts_of_items = pass.read(in.counts),
                                    .drawn = pass.write(instances_),
                                    .commands = pass.write(commands_),
                                    .counts = pass.write(draw_counts_),
                                    .item_capacity = in.item_capacity,
                                    .image_count = static_cast<uint32_t>(in.images.images().size())};
  pass.dispatch(list_draws_, push, (in.item_capacity + shared::RasterThreads - 1) / shared::RasterThreads);
}

void LayerWriter::record(gpu::Recorder& recorder, const Inputs& in) const {
  using enum gpu::Access;
  gpu::Scope scope(recorder, "raster layers");
  list_draws(recorder, in);
  const bool attached = target_ == Target::depth16;
  gpu::Pass pass = recorder.pass("cast into layers");
  pass.read(in.scene.index_buffer(), index_read);
  pass.read(instances_, vertex_attribute_read);
  pass.read(commands_, indirect_read), pass.read(draw_counts_, indirect_read);
  shared::CastPagePush words{.batches = pass.read(in.scene.batch_buffer(), fragment_read),
                             .viewport_size = {in.max_resolution, in.max_resolution}};
  shared::CastPush layers{.batches = words.batches};
  if (!attached) words.frame = pass.read(in.frame, fragment_read), pass.read(in.page_bits, fragment_read);
  for (const gpu::Image& image : in.images.images()) pass.image(image, attached ? depth_attachment : fragment_write);
  const gpu::Functions& vk = recorder.device().vk();
  const VkCommandBuffer commands = pass.commands();
  vk.vkCmdBindIndexBuffer(commands, in.scene.index_buffer().handle(), 0, VK_INDEX_TYPE_UINT32);
  const VkBuffer instances = instances_.handle();
  const VkDeviceSize offset = 0;
  vk.vkCmdBindVertexBuffers(commands, 0, 1, &instances, &offset);
  const auto images = static_cast<uint32_t>(in.images.images().size());
  for (uint32_t i = 0; i < images; ++i) {
    const gpu::Image& image = in.images.images()[i];
    words.image = i;
    layers.viewport_size = {image.width(), image.height()};
    begin(vk, commands, attached ? &image : nullptr, attached ? image.width() : in.max_resolution);
    for (uint32_t masked = 0; masked < (in.scene.has_masked() ? 2u : 1u); ++masked) {
      const uint32_t list = masked * images + i;
      if (attached)
        pass.bind_graphics(cast_[masked], layers);
      else
        pass.bind_graphics(cast_[masked], words);
      vk.vkCmdDrawIndexedIndirectCount(
          commands, commands_.handle(), VkDeviceSize(list) * in.item_capacity * sizeof(shared::DrawCommand),
          draw_counts_.handle(), list * sizeof(uint32_t), in.item_capacity, sizeof(shared::DrawCommand));
    }
    vk.vkCmdEndRendering(commands);
  }
}

}  // namespace umbrage::raster
