// Orders items by state and primitive; writes the instance table and the indirect draws.
#include "host/draw_list.hpp"

#include <algorithm>
#include <array>

namespace app {

using umbrage::Result;

namespace {

/// Boxes of a blended primitive at most: panes of many windows often are one.
constexpr size_t kMostParts = 32;

const Primitive& primitive_of(const Scene& scene, const SceneBuffers& buffers, const Pose& pose,
                              const SceneItem& item) {
  const uint32_t mesh = pose.instances[item.instance].mesh;
  return scene.meshes[mesh].primitives[item.primitive - buffers.first_primitive(mesh)];
}

bool is_mirrored(const glm::mat4& m) { return glm::determinant(glm::mat3(m)) < 0.0f; }

/// What a camera sees, relative to its eye.
class Frustum {
 public:
  explicit Frustum(const glm::mat4& clip_from_offset) {
    const glm::mat4 rows = glm::transpose(clip_from_offset);
    // Reversed depth: near is w - z, far is z.
    planes_ = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[3] - rows[2], rows[2]};
  }
  /// False only for boxes that lie beyond one of the planes, by more than rounding.
  bool meets(const glm::vec3& center, const glm::vec3& half_size) const {
    for (const glm::vec4& plane : planes_) {
      const glm::vec3 normal(plane);
      const float reach = glm::dot(glm::abs(normal), half_size) + 1e-5f * glm::dot(glm::abs(normal), glm::abs(center));
      if (glm::dot(normal, center) + plane.w + reach < 0.0f) return false;
    }
    return true;
  }

 private:
  std::array<glm::vec4, 6> planes_;
};

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
    entry.reads = primitive.reads;
    entry.alpha = material.alpha_mode;
    entry.double_sided = material.double_sided;
    entry.mirrored = is_mirrored(pose.instances[items[i].instance].world_from_mesh);
    entry.moving = items[i].moving;
    entry.unbounded = items[i].deformed;
    entry.mesh_center = 0.5f * (primitive.lowest + primitive.highest);
    entry.mesh_half_size = 0.5f * (primitive.highest - primitive.lowest);
    if (entry.alpha == AlphaMode::blend) {
      entry.parts = static_cast<uint32_t>(list.parts_.size());
      list.parts_.push_back(bounding_parts(primitive_of(scene, buffers, pose, items[i]), kMostParts));
    }
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
  for (uint32_t place = 0; place < entries_.size(); ++place) append(place);
  for (uint32_t place = 0; place < entries_.size(); ++place) write_instance(place, pose, items);
}

void DrawList::append(uint32_t place) {
  const Entry& entry = entries_[place];
  if (entry.alpha == AlphaMode::blend) {
    blended_.push_back({place, entry.index_count, entry.first_index, entry.double_sided, entry.mirrored, {}});
    return;
  }
  const bool masked = entry.alpha == AlphaMode::mask;
  if (ranges_.empty() || ranges_.back().masked != masked || ranges_.back().double_sided != entry.double_sided ||
      ranges_.back().mirrored != entry.mirrored || ranges_.back().reads != entry.reads)
    ranges_.push_back({masked, entry.double_sided, entry.mirrored, entry.reads, place, 0, 0, 0});
  ++ranges_.back().instance_count;
}

void DrawList::select(const CameraMatrices& camera) {
  const Frustum frustum(camera.clip_from_offset);
  draws_.clear();
  for (DrawRange& range : ranges_) {
    nearest_.clear();
    for (uint32_t place = range.first_instance; place < range.first_instance + range.instance_count; ++place) {
      const Entry& entry = entries_[place];
      const glm::vec3 offset = entry.center - camera.eye;
      if (!entry.unbounded && !frustum.meets(offset, entry.half_size)) continue;
      nearest_.emplace_back(-glm::dot(offset, camera.back) - glm::dot(glm::abs(camera.back), entry.half_size), place);
    }
    std::sort(nearest_.begin(), nearest_.end());
    range.first_command = static_cast<uint32_t>(draws_.size());
    range.command_count = static_cast<uint32_t>(nearest_.size());
    for (const auto& [depth, place] : nearest_)
      draws_.push_back({entries_[place].index_count, 1, entries_[place].first_index, 0, place});
  }
  commands_.write(std::span<const VkDrawIndexedIndirectCommand>(draws_));
  find_blended(camera);
}

void DrawList::find_blended(const CameraMatrices& camera) {
  const Frustum frustum(camera.clip_from_offset);
  blended_in_view_ = false;
  blended_boxes_.clear();
  for (const BlendedDraw& draw : blended_) {
    const Entry& entry = entries_[draw.instance];
    if (entry.unbounded) {
      blended_in_view_ = true;
      blended_boxes_.clear();
      return;
    }
    const glm::mat3 linear(entry.world_from_mesh);
    const glm::mat3 extent(glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2]));
    for (const MeshBox& part : parts_[entry.parts]) {
      const glm::vec3 center = glm::vec3(entry.world_from_mesh * glm::vec4(0.5f * (part.lowest + part.highest), 1.0f));
      const glm::vec3 half_size = extent * (0.5f * (part.highest - part.lowest));
      if (!frustum.meets(center - camera.eye, half_size)) continue;
      const glm::vec3 lowest = center - half_size, highest = center + half_size;
      blended_boxes_.push_back({{lowest.x, lowest.y, lowest.z}, {highest.x, highest.y, highest.z}});
      blended_in_view_ = true;
    }
  }
}

void DrawList::write_instance(uint32_t place, const Pose& pose, std::span<const SceneItem> items) {
  Entry& entry = entries_[place];
  const SceneItem& item = items[entry.item];
  const glm::mat4& matrix = pose.instances[item.instance].world_from_mesh;
  const glm::mat4 rows = glm::transpose(matrix);
  const gpu::GpuInstance instance{
      {rows[0], rows[1], rows[2]}, item.positions, item.normals, item.primitive, item.deformed ? 1u : 0u};
  instances_.write(std::span(&instance, 1), place * sizeof(instance));
  entry.center = glm::vec3(matrix * glm::vec4(entry.mesh_center, 1.0f));
  for (int axis = 0; axis < 3; ++axis)
    entry.half_size[axis] = glm::dot(glm::abs(glm::vec3(rows[axis])), entry.mesh_half_size);
  if (entry.alpha != AlphaMode::blend) return;
  entry.world_from_mesh = matrix;
  blended_[place - (entries_.size() - blended_.size())].center = entry.center;
}

}  // namespace app
