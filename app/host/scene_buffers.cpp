// Uploads streams, indices, materials.
#include "host/scene_buffers.hpp"

#include <algorithm>
#include <limits>

#include "host/shaders/host.shared.h"

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {

/// Bytes that become one device buffer; offsets become addresses once it is there. Offset 0 is never handed out.
class StreamArena {
 public:
  template <class T>
  VkDeviceAddress add(const std::vector<T>& values) {
    if (values.empty()) return 0;
    const auto bytes = std::as_bytes(std::span<const T>(values));
    const size_t offset = reserve(bytes.size());
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
    return offset;
  }
  /// Zeros, for streams that are filled piece by piece.
  size_t reserve(size_t size) {
    const size_t offset = bytes_.size();
    bytes_.resize((offset + size + 15) / 16 * 16);
    return offset;
  }
  std::byte* at(size_t offset) { return bytes_.data() + offset; }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_ = std::vector<std::byte>(16);
};

using Deltas = std::vector<glm::vec3> MorphTarget::*;

/// One array [target][vertex]; targets without this attribute stay zero. 0 when none has it.
VkDeviceAddress add_targets(StreamArena& arena, const Primitive& primitive, Deltas deltas) {
  const size_t vertices = primitive.positions.size();
  bool any = false;
  for (const MorphTarget& target : primitive.targets) any = any || !(target.*deltas).empty();
  if (!any) return 0;
  const size_t offset = arena.reserve(primitive.targets.size() * vertices * sizeof(glm::vec3));
  for (size_t t = 0; t < primitive.targets.size(); ++t) {
    const auto& values = primitive.targets[t].*deltas;
    if (!values.empty()) {
      std::memcpy(arena.at(offset + t * vertices * sizeof(glm::vec3)), values.data(),
                  values.size() * sizeof(glm::vec3));
    }
  }
  return offset;
}

void measure(const Primitive& primitive, UploadedPrimitive& uploaded) {
  uploaded.lowest = glm::vec3(std::numeric_limits<float>::max());
  uploaded.highest = -uploaded.lowest;
  for (const glm::vec3& p : primitive.positions) {
    uploaded.lowest = glm::min(uploaded.lowest, p);
    uploaded.highest = glm::max(uploaded.highest, p);
  }
}

uint32_t reads_of(const Primitive& primitive, const Material& material) {
  uint32_t reads = 0;
  if (material.base_color_texture.image >= 0) reads |= gpu::ReadsBaseColorTexture;
  if (material.metallic_roughness_texture.image >= 0) reads |= gpu::ReadsMetallicRoughnessTexture;
  if (material.normal_texture.image >= 0) reads |= gpu::ReadsNormalTexture;
  if (material.emissive_texture.image >= 0) reads |= gpu::ReadsEmissiveTexture;
  if (!primitive.colors.empty()) reads |= gpu::ReadsVertexColors;
  return reads;
}

gpu::GpuTexture gpu_texture(const TextureTable& textures, const Texture& texture, ColorSpace space) {
  return {textures.slot(texture, space), texture.uv_set, texture.uv_transform[0], texture.uv_transform[1],
          texture.uv_transform[2]};
}

}  // namespace

Result<SceneBuffers> SceneBuffers::create(GpuContext& context, const Scene& scene, const TextureTable& textures) {
  SceneBuffers buffers;
  if (auto done = buffers.upload_streams(context, scene); !done) return done.error();
  if (auto done = buffers.upload_materials(context, scene, textures); !done) return done.error();
  return buffers;
}

Result<void> SceneBuffers::upload_streams(GpuContext& context, const Scene& scene) {
  StreamArena arena;
  std::vector<uint32_t> indices;
  std::vector<gpu::GpuPrimitive> table;
  for (const Mesh& mesh : scene.meshes) {
    first_primitive_.push_back(static_cast<uint32_t>(primitives_.size()));
    for (const Primitive& primitive : mesh.primitives) {
      if (indices.size() + primitive.indices.size() > std::numeric_limits<uint32_t>::max()) {
        return Error{ErrorCode::unsupported, "the scene has more than 2^32 indices: split it"};
      }
      UploadedPrimitive uploaded;
      uploaded.vertex_count = static_cast<uint32_t>(primitive.positions.size());
      uploaded.index_count = static_cast<uint32_t>(primitive.indices.size());
      uploaded.first_index = static_cast<uint32_t>(indices.size());
      uploaded.target_count = static_cast<uint32_t>(primitive.targets.size());
      uploaded.positions = arena.add(primitive.positions);
      uploaded.normals = arena.add(primitive.normals);
      uploaded.joints = arena.add(primitive.joints);
      uploaded.joint_weights = arena.add(primitive.weights);
      uploaded.morph_positions = add_targets(arena, primitive, &MorphTarget::positions);
      uploaded.morph_normals = add_targets(arena, primitive, &MorphTarget::normals);
      uploaded.material = primitive.material;
      uploaded.reads = reads_of(primitive, scene.materials[primitive.material]);
      measure(primitive, uploaded);
      table.push_back({arena.add(primitive.tangents), arena.add(primitive.uv[0]), arena.add(primitive.uv[1]),
                       arena.add(primitive.colors), primitive.material, 0});
      indices.insert(indices.end(), primitive.indices.begin(), primitive.indices.end());
      primitives_.push_back(uploaded);
    }
  }
  auto streams = context.upload(arena.bytes(), "vertex streams");
  if (!streams) return streams.error();
  streams_ = std::move(streams).value();
  const auto place = [base = streams_.address()](uint64_t& offset) { offset = offset == 0 ? 0 : base + offset; };
  for (UploadedPrimitive& p : primitives_) {
    for (VkDeviceAddress* stream :
         {&p.positions, &p.normals, &p.joints, &p.joint_weights, &p.morph_positions, &p.morph_normals}) {
      place(*stream);
    }
  }
  for (gpu::GpuPrimitive& p : table) {
    for (uint64_t* stream : {&p.tangents, &p.uv_0, &p.uv_1, &p.colors}) place(*stream);
  }
  auto primitive_table = context.upload(std::as_bytes(std::span(table)), "primitives");
  if (!primitive_table) return primitive_table.error();
  primitive_table_ = std::move(primitive_table).value();
  auto index_buffer = context.upload(std::as_bytes(std::span(indices)), "indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  if (!index_buffer) return index_buffer.error();
  indices_ = std::move(index_buffer).value();
  return {};
}

Result<void> SceneBuffers::upload_materials(GpuContext& context, const Scene& scene, const TextureTable& textures) {
  std::vector<gpu::GpuMaterial> materials;
  for (const Material& m : scene.materials) {
    gpu::GpuMaterial material{};
    material.base_color = m.base_color;
    material.emissive = m.emissive;
    material.metallic = m.metallic;
    material.roughness = m.roughness;
    material.normal_scale = m.normal_scale;
    material.alpha_cutoff = m.alpha_cutoff;
    material.flags = m.unlit ? gpu::MaterialUnlit : 0;
    material.base_color_texture = gpu_texture(textures, m.base_color_texture, ColorSpace::srgb);
    material.metallic_roughness_texture = gpu_texture(textures, m.metallic_roughness_texture, ColorSpace::linear);
    material.normal_texture = gpu_texture(textures, m.normal_texture, ColorSpace::linear);
    material.emissive_texture = gpu_texture(textures, m.emissive_texture, ColorSpace::srgb);
    materials.push_back(material);
  }
  auto table = context.upload(std::as_bytes(std::span(materials)), "materials");
  if (!table) return table.error();
  material_table_ = std::move(table).value();
  return {};
}

std::vector<SceneItem> list_items(const Scene& scene, const Pose& pose, const SceneBuffers& buffers) {
  const std::vector<bool> moving = moving_nodes(scene);
  std::vector<SceneItem> items;
  for (uint32_t i = 0; i < pose.instances.size(); ++i) {
    const PosedInstance& instance = pose.instances[i];
    const uint32_t first = buffers.first_primitive(instance.mesh);
    const auto count = static_cast<uint32_t>(scene.meshes[instance.mesh].primitives.size());
    for (uint32_t p = first; p < first + count; ++p) {
      const UploadedPrimitive& primitive = buffers.primitives()[p];
      if (primitive.index_count == 0) continue;
      const bool skinned = instance.skin >= 0 && primitive.joints != 0;
      const bool morphed = !instance.weights.empty() && primitive.target_count > 0;
      items.push_back({i, p, moving[instance.node], skinned || morphed, primitive.positions, primitive.normals});
    }
  }
  return items;
}

}  // namespace app
