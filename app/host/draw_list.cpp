// Orders items by state and primitive; writes the instance table and the indirect draws.
#include "host/draw_list.hpp"

#include <algorithm>

namespace app {

using umbrage::Result;

namespace {

bool is_mirrored(const glm::mat4& m) { return glm::determinant(glm::mat3(m)) < 0.0f; }

}  // namespace

Result<DrawList> DrawList::create(const GpuContext& context, const Scene& scene, const SceneBuffers& buffers,
                                  const Pose& pose, std::span<const SceneItem> items) {
  DrawList list;
  for (uint32_t i = 0; i < items.size(); ++i) {
    const UploadedPrimitive& primitive = buffers.primitives()[items[i].primitive];
    const Material& material = scene.materials[primitive.material];
    Entry entry;
    entry.item = i;
    entry.primitive = items[i].primitive;
    entry.index_count = primitive.index_count;
    entry.first_index = primitive.first_index;
    entry.alpha = material.alpha_mode;
    entry.double_sided = material.double_sided;
    entry.mirrored = is_mirrored(pose.instances[items[i].instance].world_from_mesh);
    entry.moving = items[i].moving;
    entry.center = 0.5f * (primitive.lowest + primitive.highest);
    list.entries_.push_back(entry);
  }
  const size_t count = std::max<size_t>(items.size(), 1);
  auto instances = context.create_buffer(count * sizeof(gpu::GpuInstance), Memory::upload, "instances");
  if (!instances) return instances.error();
  list.instances_ = std::move(instances).value();
  auto commands = context.create_buffer(count * sizeof(VkDrawIndexedIndirectCommand), Memory::upload, "draws",
                                        VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  if (!commands) return commands.error();
  list.commands_ = std::move(commands).value();
  list.build(pose, items);
  return list;
}

void DrawList::update(const Pose& pose, std::span<const SceneItem> items) {
  bool reorder = false;
  for (uint32_t place = 0; place < entries_.size(); ++place) {
    Entry& entry = entries_[place];
    if (!entry.moving) continue;
    const bool mirrored = is_mirrored(pose.instances[items[entry.item].instance].world_from_mesh);
    reorder = reorder || mirrored != entry.mirrored;
    entry.mirrored = mirrored;
    write_instance(place, pose, items);
  }
  if (reorder) build(pose, items);
}

void DrawList::build(const Pose& pose, std::span<const SceneItem> items) {
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.order() < b.order(); });
  ranges_.clear();
  blended_.clear();
  draws_.clear();
  for (uint32_t place = 0; place < entries_.size(); ++place) append_draw(place);
  for (uint32_t place = 0; place < entries_.size(); ++place) write_instance(place, pose, items);
  commands_.write(std::span<const VkDrawIndexedIndirectCommand>(draws_));
}

void DrawList::append_draw(uint32_t place) {
  const Entry& entry = entries_[place];
  if (entry.alpha == AlphaMode::blend) {
    blended_.push_back({place, entry.index_count, entry.first_index, entry.double_sided, entry.mirrored, {}});
    return;
  }
  const bool masked = entry.alpha == AlphaMode::mask;
  const bool same_range = !ranges_.empty() && ranges_.back().masked == masked &&
                          ranges_.back().double_sided == entry.double_sided &&
                          ranges_.back().mirrored == entry.mirrored;
  if (!same_range)
    ranges_.push_back({masked, entry.double_sided, entry.mirrored, static_cast<uint32_t>(draws_.size()), 0});
  if (same_range && entries_[place - 1].primitive == entry.primitive) {
    ++draws_.back().instanceCount;
    return;
  }
  draws_.push_back({entry.index_count, 1, entry.first_index, 0, place});
  ++ranges_.back().command_count;
}

void DrawList::write_instance(uint32_t place, const Pose& pose, std::span<const SceneItem> items) {
  const Entry& entry = entries_[place];
  const SceneItem& item = items[entry.item];
  const glm::mat4& matrix = pose.instances[item.instance].world_from_mesh;
  const glm::mat4 rows = glm::transpose(matrix);
  const gpu::GpuInstance instance{
      {rows[0], rows[1], rows[2]}, item.positions, item.normals, item.primitive, item.deformed ? 1u : 0u};
  instances_.write(std::span(&instance, 1), place * sizeof(instance));
  if (entry.alpha == AlphaMode::blend) {
    const size_t first_blended = entries_.size() - blended_.size();
    blended_[place - first_blended].center = glm::vec3(matrix * glm::vec4(entry.center, 1.0f));
  }
}

}  // namespace app
