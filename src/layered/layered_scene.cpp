// Geometry of a layered scene: checked, cut into batches, uploaded once. Transforms and bones follow every frame they change.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "layered/layered_scene_state.hpp"
#include "umbrage/prepare.hpp"

namespace umbrage {

namespace {
using shared::NoIndex;

Error invalid(std::string text) { return {ErrorCode::invalid_argument, std::move(text)}; }
std::string place(const char* what, size_t index) {
  return std::string("LayeredSceneDesc::") + what + "[" + std::to_string(index) + "]";
}

bool is_finite(const Affine& a) {
  return std::all_of(std::begin(a.m), std::end(a.m), [](float x) { return std::isfinite(x); });
}

void set_rows(shared::LayeredInstanceRecord& record, const Affine& a) {
  const float* m = a.m;
  record.row0 = {m[0], m[1], m[2], m[3]}, record.row1 = {m[4], m[5], m[6], m[7]},
  record.row2 = {m[8], m[9], m[10], m[11]};
  const shared::vec3 x(record.row0), y(record.row1), z(record.row2);
  record.handedness = shared::dot(shared::cross(x, y), z) < 0 ? -1.0f : 1.0f;
}

std::string check_skin(const LayeredSkin& skin) {
  float sum = 0;
  for (int i = 0; i < 4; ++i)
    if (skin.bones[i] != shared::NoBone) sum += skin.weights[i];
  return std::abs(sum - 1) < 0.01f ? std::string() : "its weights sum to " + std::to_string(sum) + ", not 1";
}
}  // namespace

LayeredScene::State::~State() {
  if (!device) return;
  const gpu::Functions& vk = device->vk();
  if (pool) vk.vkDestroyDescriptorPool(device->handle(), pool, device->callbacks());
  if (sampler) vk.vkDestroySampler(device->handle(), sampler, device->callbacks());
}

Result<void> LayeredScene::State::add_mesh(const LayeredMesh& mesh, size_t index, uint32_t mask_count, Geometry& out) {
  const std::string where = place("meshes", index);
  const size_t count = mesh.positions.size();
  if (!mesh.normals.empty() && mesh.normals.size() != count) return invalid(where + ".normals: not one a position");
  if (!mesh.uvs.empty() && mesh.uvs.size() != count) return invalid(where + ".uvs: not one a position");
  if (!mesh.skin.empty() && mesh.skin.size() != count) return invalid(where + ".skin: not one a position");
  for (const Submesh& submesh : mesh.submeshes) {
    if (submesh.mask.value > mask_count)
      return invalid(where + ": a submesh names mask " + std::to_string(submesh.mask.value) + " of " +
                     std::to_string(mask_count));
    if (submesh.mask.value && mesh.uvs.empty()) return invalid(where + ": a masked submesh needs uvs");
  }
  for (size_t v = 0; v < mesh.skin.size(); ++v)
    if (auto text = check_skin(mesh.skin[v]); !text.empty())
      return invalid(where + ".skin[" + std::to_string(v) + "]: " + text);

  std::vector<std::byte> made;
  auto prepared = open_prepared(mesh.prepared);
  if (mesh.prepared.empty() || !prepared ||
      prepared->key != prepare_key(mesh.positions, mesh.indices, mesh.submeshes, {})) {
    auto bytes = prepare_mesh(mesh.positions, mesh.indices, mesh.submeshes, {});
    if (!bytes) return Error{bytes.error().code, where + ": " + bytes.error().message};
    made = std::move(*bytes);
    prepared = open_prepared(made);
    if (!prepared) return prepared.error();
  }

  const auto base = static_cast<uint32_t>(out.positions.size());
  MeshRange range{.first_batch = static_cast<uint32_t>(out.batches.size()),
                  .batch_count = static_cast<uint32_t>(prepared->batches.size()),
                  .is_skinned = !mesh.skin.empty()};
  for (const PreparedBatch& batch : prepared->batches) {
    const Submesh submesh = mesh.submeshes.empty() ? Submesh{} : mesh.submeshes[batch.submesh];
    shared::LayeredBatch record{};
    record.box_min = {batch.bounds.min.x, batch.bounds.min.y, batch.bounds.min.z};
    record.box_max = {batch.bounds.max.x, batch.bounds.max.y, batch.bounds.max.z};
    record.first_index = static_cast<uint32_t>(out.indices.size());
    record.triangle_count = batch.triangle_count;
    record.first_vertex = static_cast<uint32_t>(out.batch_vertices.size());
    record.vertex_count = batch.vertex_count;
    record.first_triangle = static_cast<uint32_t>(out.batch_triangles.size());
    record.mask = submesh.mask.value ? submesh.mask.value - 1 : NoIndex;
    record.alpha_cutoff = submesh.alpha_cutoff;
    record.alpha_factor = submesh.alpha_factor;
    has_masked = has_masked || submesh.mask.value;
    for (uint32_t v = 0; v < batch.vertex_count; ++v)
      out.batch_vertices.push_back(base + prepared->vertices[batch.first_vertex + v]);
    for (uint32_t t = 0; t < batch.triangle_count; ++t) {
      const uint8_t* local = &prepared->local_indices[3 * (batch.first_triangle + t)];
      out.batch_triangles.push_back(local[0] | uint32_t(local[1]) << 8 | uint32_t(local[2]) << 16);
      for (int i = 0; i < 3; ++i) out.indices.push_back(out.batch_vertices[record.first_vertex + local[i]]);
    }
    out.batches.push_back(record);
  }
  meshes.push_back(range);
  out.positions.insert(out.positions.end(), mesh.positions.begin(), mesh.positions.end());
  // An array that any mesh has, all have: elements are found by the vertex alone.
  const auto append = [&](auto& to, const auto& from) {
    if (from.empty()) return;
    to.resize(base);
    to.insert(to.end(), from.begin(), from.end());
  };
  append(out.normals, mesh.normals);
  append(out.uvs, mesh.uvs);
  if (!mesh.skin.empty()) {
    out.skins.resize(base);
    for (const LayeredSkin& skin : mesh.skin) {
      const uint32_t packed =
          skin.bones[0] | uint32_t(skin.bones[1]) << 8 | uint32_t(skin.bones[2]) << 16 | uint32_t(skin.bones[3]) << 24;
      out.skins.push_back({packed, {skin.weights[0], skin.weights[1], skin.weights[2], skin.weights[3]}});
      for (const uint8_t bone : skin.bones)
        if (bone != shared::NoBone) meshes.back().bones = std::max(meshes.back().bones, bone + 1u);
    }
  }
  return {};
}

Result<void> LayeredScene::State::add_instance(const LayeredInstance& instance, size_t index, Geometry& out) {
  const std::string where = place("instances", index);
  if (instance.mesh >= meshes.size())
    return invalid(where + ".mesh: there is no mesh " + std::to_string(instance.mesh));
  if (!is_finite(instance.world_from_mesh)) return invalid(where + ".world_from_mesh is not finite");
  if (instance.bones > shared::NoBone) return invalid(where + ".bones: at most 255");
  const MeshRange& mesh = meshes[instance.mesh];
  if (instance.bones && !mesh.is_skinned) return invalid(where + ": bones, but its mesh has no skin");
  if (instance.bones && instance.bones < mesh.bones)
    return invalid(where + ".bones: " + std::to_string(instance.bones) + ", but the skin of its mesh names bone " +
                   std::to_string(mesh.bones - 1));
  shared::LayeredInstanceRecord record{};
  set_rows(record, instance.world_from_mesh);
  record.first_bone = instance.bones ? static_cast<uint32_t>(bones.size() / 3) : NoIndex;
  record.host_index = instance.host_index;
  has_mirrored = has_mirrored || record.handedness < 0;
  for (uint32_t bone = 0; bone < instance.bones; ++bone) {
    bones.push_back({1, 0, 0, 0});
    bones.push_back({0, 1, 0, 0});
    bones.push_back({0, 0, 1, 0});
  }
  for (uint32_t b = 0; b < mesh.batch_count; ++b) {
    out.casters.push_back({static_cast<uint32_t>(index), mesh.first_batch + b});
    triangles += out.batches[mesh.first_batch + b].triangle_count;
  }
  instances.push_back(record);
  bone_counts.push_back(instance.bones);
  return {};
}

Result<void> LayeredScene::State::create_buffers(const Geometry& in) {
  VkDeviceSize size = 0;
  const auto section = [&](LayeredSection& out, const auto& values) {
    out = {size, values.size() * sizeof(values[0])};
    size += (out.bytes + 255) & ~VkDeviceSize(255);
  };
  section(positions, in.positions), section(normals, in.normals), section(uvs, in.uvs), section(skins, in.skins),
      section(indices, in.indices);
  section(batch_vertices, in.batch_vertices), section(batch_triangles, in.batch_triangles),
      section(batches, in.batches), section(casters, in.casters);
  auto made = gpu::Buffer::create(*device, *memory, size, gpu::MemoryKind::device, "layered geometry");
  if (!made) return made.error();
  geometry = std::move(*made);
  auto staged = gpu::Buffer::create(*device, *memory, size, gpu::MemoryKind::upload, "layered staging");
  if (!staged) return staged.error();
  staging = std::move(*staged);
  const auto write = [&](const LayeredSection& at, const auto& values) {
    if (at.bytes) std::memcpy(staging.mapped() + at.offset, values.data(), at.bytes);
  };
  write(positions, in.positions), write(normals, in.normals), write(uvs, in.uvs), write(skins, in.skins),
      write(indices, in.indices);
  write(batch_vertices, in.batch_vertices), write(batch_triangles, in.batch_triangles), write(batches, in.batches),
      write(casters, in.casters);
  bones_offset = (instances.size() * sizeof instances[0] + 255) & ~size_t(255);
  auto records = gpu::Buffer::create(*device, *memory, bones_offset + bones.size() * sizeof(shared::vec4),
                                     gpu::MemoryKind::device, "layered instances");
  if (!records) return records.error();
  moving = std::move(*records);
  caster_count = static_cast<uint32_t>(in.casters.size());
  return {};
}

Result<void> LayeredScene::State::create_masks(std::span<const LayeredMask> masks) {
  const gpu::Functions& vk = device->vk();
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2},
       {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, std::max(1u, static_cast<uint32_t>(masks.size()))}}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
  info.maxSets = 2;
  info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkResult result = vk.vkCreateDescriptorPool(device->handle(), &info, device->callbacks(), &pool);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateDescriptorPool", "layered");
  const std::array<VkDescriptorSetLayout, 2> layouts{factory->frame_set_layout(), factory->mask_set_layout()};
  VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocation.descriptorPool = pool;
  allocation.descriptorSetCount = static_cast<uint32_t>(layouts.size());
  allocation.pSetLayouts = layouts.data();
  std::array<VkDescriptorSet, 2> sets{};
  result = vk.vkAllocateDescriptorSets(device->handle(), &allocation, sets.data());
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkAllocateDescriptorSets", "layered");
  frame_set = sets[0], mask_set = sets[1];
  VkSamplerCreateInfo linear{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  linear.magFilter = linear.minFilter = VK_FILTER_LINEAR;
  linear.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  linear.maxLod = VK_LOD_CLAMP_NONE;
  result = vk.vkCreateSampler(device->handle(), &linear, device->callbacks(), &sampler);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateSampler", "layered");
  for (uint32_t i = 0; i < masks.size(); ++i) {
    if (!masks[i].view) return invalid(place("masks", i) + ".view is VK_NULL_HANDLE");
    const VkDescriptorImageInfo image{masks[i].sampler ? masks[i].sampler : sampler, masks[i].view,
                                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = mask_set;
    write.dstArrayElement = i;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vk.vkUpdateDescriptorSets(device->handle(), 1, &write, 0, nullptr);
  }
  return {};
}

Result<LayeredScene> LayeredScene::create(const DeviceDesc& device, const LayeredSceneDesc& desc) {
  if (desc.frames_in_flight < 1 || desc.frames_in_flight > 4)
    return invalid("LayeredSceneDesc::frames_in_flight must be 1…4");
  if (desc.masks.size() > shared::MaxMasks) return invalid("LayeredSceneDesc::masks: at most 1024");
  auto state = std::make_unique<State>();
  auto adopted = gpu::Device::create(device);
  if (!adopted) return adopted.error();
  state->device = std::move(*adopted);
  state->physical_device = device.physical_device;
  VkPhysicalDeviceProperties properties;
  state->device->vk().vkGetPhysicalDeviceProperties(device.physical_device, &properties);
  state->device_name = properties.deviceName;
  state->memory = std::make_unique<gpu::Memory>(*state->device);
  auto factory = gpu::PipelineFactory::create(*state->device, std::max(1u, static_cast<uint32_t>(desc.masks.size())));
  if (!factory) return factory.error();
  state->factory = std::move(*factory);

  State::Geometry geometry;
  for (size_t i = 0; i < desc.meshes.size(); ++i)
    if (auto ok = state->add_mesh(desc.meshes[i], i, static_cast<uint32_t>(desc.masks.size()), geometry); !ok)
      return ok.error();
  if (!geometry.normals.empty()) geometry.normals.resize(geometry.positions.size());
  if (!geometry.uvs.empty()) geometry.uvs.resize(geometry.positions.size());
  if (!geometry.skins.empty()) geometry.skins.resize(geometry.positions.size(), {0xffffffffu, {0, 0, 0, 0}});
  for (size_t i = 0; i < desc.instances.size(); ++i)
    if (auto ok = state->add_instance(desc.instances[i], i, geometry); !ok) return ok.error();
  if (auto ok = state->create_masks(desc.masks); !ok) return ok.error();
  if (auto ok = state->create_buffers(geometry); !ok) return ok.error();
  state->slots.resize(desc.frames_in_flight);
  return LayeredScene(std::move(state));
}

Result<void> LayeredScene::set_transform(uint32_t instance, const Affine& world_from_mesh) {
  if (instance >= state_->instances.size())
    return invalid("set_transform: there is no instance " + std::to_string(instance));
  if (!is_finite(world_from_mesh)) return invalid("set_transform: the transform is not finite");
  set_rows(state_->instances[instance], world_from_mesh);
  state_->has_mirrored = state_->has_mirrored || state_->instances[instance].handedness < 0;
  state_->has_moved = true;
  return {};
}

Result<void> LayeredScene::set_bones(uint32_t instance, std::span<const Affine> bones) {
  if (instance >= state_->instances.size())
    return invalid("set_bones: there is no instance " + std::to_string(instance));
  if (bones.size() != state_->bone_counts[instance])
    return invalid("set_bones: instance " + std::to_string(instance) + " has " +
                   std::to_string(state_->bone_counts[instance]) + " bones, not " + std::to_string(bones.size()));
  for (size_t i = 0; i < bones.size(); ++i) {
    if (!is_finite(bones[i])) return invalid("set_bones: bone " + std::to_string(i) + " is not finite");
    const size_t at = 3 * (state_->instances[instance].first_bone + i);
    for (size_t row = 0; row < 3; ++row)
      state_->bones[at + row] = {bones[i].m[4 * row], bones[i].m[4 * row + 1], bones[i].m[4 * row + 2],
                                 bones[i].m[4 * row + 3]};
  }
  state_->has_moved = true;
  return {};
}

Result<void> LayeredScene::begin_frame(uint64_t serial) {
  State& s = *state_;
  if (serial <= s.serial)
    return invalid("begin_frame: serial " + std::to_string(serial) + " is not larger than " + std::to_string(s.serial));
  s.slot = static_cast<uint32_t>(serial % s.slots.size());
  const size_t instance_bytes = s.instances.size() * sizeof s.instances[0],
               bone_bytes = s.bones.size() * sizeof s.bones[0];
  if (auto ok = s.slots[s.slot].uploader.begin(*s.device, *s.memory, instance_bytes + bone_bytes + 64, "layered frame");
      !ok)
    return ok.error();
  s.serial = serial;
  if (s.uploaded_in && serial >= s.uploaded_in + s.slots.size()) s.staging = {};
  if (!s.has_moved) return {};
  s.slots[s.slot].uploader.copy(s.moving, 0, s.instances.data(), instance_bytes);
  s.slots[s.slot].uploader.copy(s.moving, s.bones_offset, s.bones.data(), bone_bytes);
  s.has_moved = false;
  return {};
}

void LayeredScene::record(VkCommandBuffer commands) {
  State& s = *state_;
  gpu::Recorder recorder = s.recorder(commands);
  if (s.uploaded_in == 0 && s.caster_count > 0) {
    gpu::Pass pass = recorder.pass("layered geometry");
    pass.write(s.geometry, gpu::Access::transfer_write);
    const VkBufferCopy whole{0, 0, s.geometry.size()};
    s.device->vk().vkCmdCopyBuffer(pass.commands(), s.staging.handle(), s.geometry.handle(), 1, &whole);
  }
  if (s.uploaded_in == 0) s.uploaded_in = s.serial;
  s.slots[s.slot].uploader.record(recorder);
}

uint32_t LayeredScene::batch_count() const { return state_->caster_count; }
uint64_t LayeredScene::triangle_count() const { return state_->triangles; }
LayeredScene::LayeredScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
LayeredScene::LayeredScene(LayeredScene&&) noexcept = default;
LayeredScene& LayeredScene::operator=(LayeredScene&&) noexcept = default;
LayeredScene::~LayeredScene() = default;

}  // namespace umbrage
