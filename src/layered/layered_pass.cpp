// The public class: settings → pipelines, views → groups, groups → render passes.
#include "umbrage/layered_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "layered/eye_point.hpp"
#include "layered/layered_pass_state.hpp"

namespace umbrage {

namespace {
constexpr uint32_t kSelectCasters[] =
#include "shaders/select_casters.comp.inc"
    ;

Error invalid(std::string text) { return {ErrorCode::invalid_argument, std::move(text)}; }
constexpr VkDeviceSize aligned(VkDeviceSize bytes) { return (bytes + 63) & ~VkDeviceSize(63); }

/// Output components of a geometry shader's vertex, whole locations.
uint32_t components(const LayeredPassSettings& settings, bool has_color, bool masked) {
  return 8 + (settings.areas ? 4 : 0) + (has_color ? 20 : masked ? 8 : 0);
}

Result<void> check(const LayeredPassSettings& settings, const LayeredScene::State& scene) {
  const std::string writer = "LayeredWriter::" + std::string(name_of(settings.writer));
  if (settings.views < 1 || settings.views > shared::MaxLayeredViews)
    return invalid("LayeredPassSettings::views must be 1…256");
  if (settings.depth_format != VK_FORMAT_D16_UNORM && settings.depth_format != VK_FORMAT_D32_SFLOAT)
    return invalid("LayeredPassSettings::depth_format must be D16_UNORM or D32_SFLOAT");
  if (settings.vertices == LayeredVertices::simple && (scene.instances.size() != 1 || !scene.bones.empty()))
    return invalid("LayeredVertices::simple is for scenes of one rigid instance; this one has " +
                   std::to_string(scene.instances.size()));
  const bool skins =
      settings.vertices == LayeredVertices::skinned || settings.vertices == LayeredVertices::skinned_mat3;
  if (!skins && !scene.bones.empty())
    return invalid("the scene has skinned instances: choose LayeredVertices::skinned");
  if (!settings.color_fragment.empty() && settings.color_format == VK_FORMAT_UNDEFINED)
    return invalid("LayeredPassSettings::color_fragment needs a color_format");
  if (const std::string_view feature = layered::missing_feature(settings.writer, scene.device->capabilities());
      !feature.empty())
    return Error{ErrorCode::unsupported, writer + " needs " + std::string(feature) + ", which " + scene.device_name +
                                             " lacks or its host did not enable"};
  if (settings.writer == LayeredWriter::compute && (!settings.color_fragment.empty() || settings.rasterizer_discard))
    return invalid(writer + " draws depth alone, without a rasterizer to discard for");
  if (settings.writer == LayeredWriter::multiview && settings.areas)
    return invalid(writer + " draws whole layers: areas must be false");
  return {};
}
}  // namespace

std::string_view name_of(LayeredWriter writer) {
  constexpr std::array<std::string_view, 8> kNames{
      "traditional", "geometry_invocations", "geometry_loop", "vertex_layer", "multiview", "mesh", "atlas", "compute"};
  return kNames[static_cast<size_t>(writer)];
}

Result<LayeredPass> LayeredPass::create(LayeredScene& scene, const LayeredPassSettings& settings) {
  LayeredScene::State& in = *scene.state_;
  if (auto ok = umbrage::check(settings, in); !ok) return ok.error();
  auto state = std::make_unique<State>(in, settings);
  if (settings.writer == LayeredWriter::atlas) state->settings.areas = true;
  state->is_color = !settings.color_fragment.empty();
  const bool masked = in.has_masked && !state->is_color;
  state->limits =
      layered::device_limits(*in.device, in.physical_device, components(state->settings, state->is_color, masked));
  const uint32_t most = state->uses_draws() ? in.device->limits().max_draw_indirect_count : state->limits.task_groups;
  if (in.caster_count > most)
    return Error{ErrorCode::unsupported, "LayeredWriter::" + std::string(name_of(settings.writer)) + " draws at most " +
                                             std::to_string(most) + " batches on " +
                                             in.device_name + ", the scene has " + std::to_string(in.caster_count)};
  auto select = in.factory->compute(
      kSelectCasters, "select casters",
      {{0, settings.selection == CasterSelection::all}, {1, settings.selection == CasterSelection::each_view}});
  if (!select) return select.error();
  state->select_casters = std::move(*select);
  if (settings.writer == LayeredWriter::compute) {
    auto writer = layered::DepthWriter::create(*in.factory, settings, masked);
    if (!writer) return writer.error();
    state->depth_writer = std::move(*writer);
  } else {
    auto pipelines = layered::LayeredPipelines::create(*in.device, *in.factory, state->settings, state->limits, masked);
    if (!pipelines) return pipelines.error();
    state->pipelines = std::move(*pipelines);
  }
  state->settings.color_fragment = {};
  state->staging.resize(in.slots.size());
  return LayeredPass(std::move(state));
}

Result<void> LayeredPass::State::check(const Inputs& in) const {
  const LayeredTargetDesc& desc = in.target.state_->desc;
  if (in.views.empty() || in.views.size() > settings.views)
    return invalid("LayeredPass::prepare: " + std::to_string(in.views.size()) + " views, the pass is for 1…" +
                   std::to_string(settings.views));
  if (desc.depth_format != settings.depth_format)
    return invalid("LayeredPass::prepare: the target's depth format is not the pass's");
  if (is_color != (desc.color != VK_NULL_HANDLE) || (is_color && desc.color_format != settings.color_format))
    return invalid("LayeredPass::prepare: the target's color is not the pass's");
  if (settings.writer == LayeredWriter::compute && !in.clear)
    return invalid("LayeredPass::prepare: LayeredWriter::compute always clears");
  std::vector<bool> taken(desc.layers);
  for (size_t i = 0; i < in.views.size(); ++i) {
    const LayeredView& view = in.views[i];
    const std::string where = "LayeredPass::prepare: views[" + std::to_string(i) + "]";
    if (view.layer >= desc.layers)
      return invalid(where + ".layer is " + std::to_string(view.layer) + " of " + std::to_string(desc.layers));
    for (const float value : view.clip_from_world.m)
      if (!std::isfinite(value)) return invalid(where + ".clip_from_world is not finite");
    const VkRect2D& area = view.area;
    if (area.offset.x < 0 || area.offset.y < 0 || uint64_t(area.offset.x) + area.extent.width > desc.width ||
        uint64_t(area.offset.y) + area.extent.height > desc.height)
      return invalid(where + ".area leaves the layer");
    const bool is_whole =
        area.extent.width == 0 || (area.extent.width == desc.width && area.extent.height == desc.height);
    if (!is_whole && !settings.areas && settings.writer != LayeredWriter::compute)
      return invalid(where + ".area: the pass was created without areas");
    if (settings.writer == LayeredWriter::multiview && taken[view.layer])
      return invalid(where + ": LayeredWriter::multiview draws one view a layer");
    taken[view.layer] = true;
  }
  return {};
}

void LayeredPass::State::fill_views(const Inputs& in) {
  const LayeredTargetDesc& desc = target->desc;
  std::vector<uint32_t> order(in.views.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return in.views[a].layer < in.views[b].layer; });
  views.clear();
  split.clear();
  for (const uint32_t index : order) {
    const LayeredView& view = in.views[index];
    const VkExtent2D extent = view.area.extent.width ? view.area.extent : VkExtent2D{desc.width, desc.height};
    const layered::EyePoint eye = layered::eye_point(view.clip_from_world, settings.depth_order);
    shared::LayeredViewRecord record{};
    std::memcpy(&record.clip_from_world, view.clip_from_world.m, sizeof view.clip_from_world.m);
    record.eye = eye.eye;
    const float width = static_cast<float>(desc.width), height = static_cast<float>(desc.height);
    record.area_scale = {static_cast<float>(extent.width) / width, static_cast<float>(extent.height) / height};
    record.area_offset = {
        (2.0f * static_cast<float>(view.area.offset.x) + static_cast<float>(extent.width)) / width - 1.0f,
        (2.0f * static_cast<float>(view.area.offset.y) + static_cast<float>(extent.height)) / height - 1.0f};
    record.layer = view.layer;
    record.x = static_cast<uint32_t>(view.area.offset.x), record.y = static_cast<uint32_t>(view.area.offset.y);
    record.width = extent.width, record.height = extent.height;
    record.index = index;
    views.push_back(record);
    split.push_back({view.layer, eye.is_mirrored});
  }
}

Result<void> LayeredPass::State::reserve() {
  at.counts = 0;
  at.empty_count = groups.size() * list_count * sizeof(shared::LayeredCount);
  at.groups = aligned(at.empty_count + sizeof(shared::LayeredCount));
  at.views = aligned(at.groups + groups.size() * sizeof(shared::LayeredGroup));
  at.scene = aligned(at.views + views.size() * sizeof(shared::LayeredViewRecord));
  at.bytes = at.scene + sizeof(shared::LayeredPush);
  const VkDeviceSize rows = VkDeviceSize(groups.size()) * list_count * std::max(scene.caster_count, 1u);
  const gpu::Device& device = *scene.device;
  gpu::Memory& memory = *scene.memory;
  if (auto ok = gpu::grow(block, device, memory, at.bytes, "layered block", outgrown); !ok) return ok.error();
  if (auto ok = gpu::grow(visible, device, memory,
                          VkDeviceSize(std::max(scene.caster_count, 1u)) * shared::ViewWords * sizeof(uint32_t),
                          "visible views", outgrown);
      !ok)
    return ok.error();
  gpu::Buffer& lists = uses_draws() ? draws : listed;
  if (auto ok = gpu::grow(lists, device, memory, rows * (uses_draws() ? sizeof(shared::LayeredDraw) : sizeof(uint32_t)),
                          "layered draws", outgrown);
      !ok)
    return ok.error();
  if (depth_writer) {
    uint32_t layers = 0;
    for (const layered::ViewGroup& group : groups) layers = std::max(layers, group.layer_count);
    const VkDeviceSize texels = VkDeviceSize(target->desc.width) * target->desc.height * layers;
    if (auto ok = depth_writer->reserve(device, memory, texels, settings.depth_format == VK_FORMAT_D16_UNORM, outgrown);
        !ok)
      return ok.error();
  }
  gpu::Buffer& staged = staging[scene.slot];
  if (!staged || staged.size() < at.bytes) {
    auto made = gpu::Buffer::create(device, memory, at.bytes, gpu::MemoryKind::upload, "layered block staging");
    if (!made) return made.error();
    staged = std::move(*made);
  }
  return {};
}

shared::LayeredPush LayeredPass::State::scene_push() const {
  return {.host = host_data,
          .positions = scene.address(scene.positions),
          .normals = scene.address(scene.normals),
          .uvs = scene.address(scene.uvs),
          .skins = scene.address(scene.skins),
          .bones = scene.moving.address() + scene.bones_offset,
          .instances = scene.moving.address(),
          .batches = scene.address(scene.batches),
          .casters = scene.address(scene.casters),
          .views = block.address() + at.views,
          .visible = visible.address(),
          .vertices = scene.address(scene.batch_vertices),
          .triangles = scene.address(scene.batch_triangles)};
}

void LayeredPass::State::fill_block() {
  std::byte* out = staging[scene.slot].mapped();
  const shared::LayeredCount empty{0, 1, 1, 0};
  for (VkDeviceSize offset = at.counts; offset <= at.empty_count; offset += sizeof empty)
    std::memcpy(out + offset, &empty, sizeof empty);
  for (size_t i = 0; i < groups.size(); ++i) {
    const shared::LayeredGroup group{groups[i].first_view, groups[i].view_count};
    std::memcpy(out + at.groups + i * sizeof group, &group, sizeof group);
  }
  std::memcpy(out + at.views, views.data(), views.size() * sizeof views[0]);
  const shared::LayeredPush push = scene_push();
  std::memcpy(out + at.scene, &push, sizeof push);
}

Result<void> LayeredPass::prepare(const Inputs& in) {
  State& s = *state_;
  if (s.scene.serial == 0) return invalid("LayeredPass::prepare: the scene's begin_frame comes first");
  if (auto ok = s.check(in); !ok) return ok.error();
  const LayeredTargetDesc& desc = in.target.state_->desc;
  layered::SplitLimits split_limits = s.limits.split;
  split_limits.compute_layers = static_cast<uint32_t>(
      std::clamp<VkDeviceSize>(layered::DepthWriter::kMaxKeys / (VkDeviceSize(desc.width) * desc.height), 1, 2048));
  s.target = in.target.state_.get();
  s.clear = in.clear, s.clear_color = in.clear_color, s.color_set = in.color_set, s.host_data = in.host_data;
  s.fill_views(in);
  const bool splits_mirrored = s.culls_by_hardware() && s.settings.culled_faces != CulledFaces::none;
  s.groups = layered::split_views(s.settings.writer, split_limits, s.split, splits_mirrored);
  s.list_count = splits_mirrored && s.scene.has_mirrored ? 4 : s.scene.has_masked && !s.is_color ? 2 : 1;
  if (s.settings.writer == LayeredWriter::multiview)
    for (const layered::ViewGroup& group : s.groups)
      if (!s.pipelines->find(false, group.layer_count >= 32 ? 0xffffffffu : (1u << group.layer_count) - 1))
        return invalid(
            "LayeredPass::prepare: LayeredWriter::multiview needs exactly the views it was created for, in consecutive "
            "layers");
  if (s.scene.serial > s.scene.slots.size()) s.retired.collect(s.scene.serial - s.scene.slots.size());
  if (auto ok = s.reserve(); !ok) return ok.error();
  for (gpu::Buffer& buffer : s.outgrown) s.retired.retire(std::move(buffer), s.scene.serial);
  s.outgrown.clear();
  s.fill_block();
  return {};
}

uint32_t LayeredPass::splits() const { return static_cast<uint32_t>(state_->groups.size()); }

void LayeredPass::record(VkCommandBuffer commands) {
  State& s = *state_;
  gpu::Recorder recorder = s.scene.recorder(commands);
  s.select(recorder);
  if (s.depth_writer)
    s.write_depth(recorder, commands);
  else
    s.draw_groups(recorder, commands);
}

LayeredPass::LayeredPass(std::unique_ptr<State> state) : state_(std::move(state)) {}
LayeredPass::LayeredPass(LayeredPass&&) noexcept = default;
LayeredPass& LayeredPass::operator=(LayeredPass&&) noexcept = default;
LayeredPass::~LayeredPass() = default;

}  // namespace umbrage
