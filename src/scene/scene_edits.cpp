// Edits of the scene: everything is checked before anything changes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/gpu_scene.hpp"
#include "views/view_math.shared.h"

namespace umbrage::scene {

namespace {
Error stale(const char* what, uint32_t value) {
  return {ErrorCode::stale_id, std::string(what) + " id " + std::to_string(value) + " was removed or never handed out"};
}
Error invalid(std::string text) { return {ErrorCode::invalid_argument, std::move(text)}; }
Error full(const char* what) {
  return {ErrorCode::out_of_memory, std::string("no more than 1048576 ") + what + " at a time"};
}

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
Aabb united(const Aabb& a, const Aabb& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}
bool finite(const Affine& a) {
  return std::all_of(std::begin(a.m), std::end(a.m), [](float x) { return std::isfinite(x); });
}

std::string check_stream(const Stream& stream, uint32_t floats, const char* name) {
  if (stream.address == 0) return {};
  if (stream.address % 4 != 0) return std::string(name) + ": the address must be a multiple of 4";
  if (stream.stride_bytes % 4 != 0 || stream.stride_bytes < 4 * floats)
    return std::string(name) + ": the stride must be a multiple of 4 and at least " + std::to_string(4 * floats) +
           ", it is " + std::to_string(stream.stride_bytes);
  return {};
}

/// MeshDesc::level_errors_m, and the submeshes' levels of it.
std::string check_levels(const MeshDesc& desc) {
  constexpr float kLeastError = std::numeric_limits<float>::min();  // Devices may take less for 0.
  const std::span<const float> errors = desc.level_errors_m;
  if (errors.size() > MaxMeshLevels)
    return "MeshDesc::level_errors_m: " + std::to_string(errors.size()) + " levels; no more than " +
           std::to_string(MaxMeshLevels);
  for (size_t i = 0; i < errors.size(); ++i) {
    if (i == 0 ? errors[i] == 0 : errors[i] > errors[i - 1] && errors[i] >= kLeastError && errors[i] < shared::NoLevels) continue;
    return "MeshDesc::level_errors_m: level " + std::to_string(i) + " is " + std::to_string(errors[i]) +
           "; the first must be 0, each other more than the one before and less than 1e30";
  }
  for (size_t i = 0; i < desc.submeshes.size(); ++i) {
    const Submesh& submesh = desc.submeshes[i];
    if (submesh.first_level > submesh.last_level || submesh.first_level >= std::max<size_t>(errors.size(), 1))
      return "MeshDesc: submesh " + std::to_string(i) + " is of levels " + std::to_string(submesh.first_level) +
             " to " + std::to_string(submesh.last_level) + " of " + std::to_string(std::max<size_t>(errors.size(), 1));
  }
  return {};
}
}  // namespace

Result<MaskId> GpuScene::add_mask(VkImageView view, VkSampler sampler) {
  if (!view) return invalid("add_mask: the image view is VK_NULL_HANDLE");
  if (masks_.count() >= shared::MaxMasks)
    return Error{ErrorCode::out_of_memory, "add_mask: no more than 1024 masks at a time"};
  const uint32_t id = masks_.add({view, sampler});
  if (IdPool<MaskEntry>::slot_of(id) >= shared::MaxMasks) {
    masks_.remove(id);
    return Error{ErrorCode::out_of_memory, "add_mask: the mask array is used up"};
  }
  new_masks_.push_back(IdPool<MaskEntry>::slot_of(id));
  return MaskId{id};
}

Result<void> GpuScene::make_batches(const MeshDesc& desc, const PreparedMesh& prepared, Mesh& mesh) const {
  std::vector<Submesh> submeshes(desc.submeshes.begin(), desc.submeshes.end());
  if (submeshes.empty()) submeshes.push_back({.index_count = static_cast<uint32_t>(desc.indices.size())});
  mesh.batches.reserve(prepared.batches.size());
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const std::span<const float> errors = desc.level_errors_m;
  mesh.bounds = {{kInfinite, kInfinite, kInfinite}, {-kInfinite, -kInfinite, -kInfinite}};
  for (const PreparedBatch& batch : prepared.batches) {
    if (batch.submesh >= submeshes.size())
      return invalid("add_mesh: the prepared bytes name a submesh that the mesh does not have");
    const Submesh& submesh = submeshes[batch.submesh];
    shared::BatchRecord record{};
    record.box_min = {batch.bounds.min.x, batch.bounds.min.y, batch.bounds.min.z};
    record.box_max = {batch.bounds.max.x, batch.bounds.max.y, batch.bounds.max.z};
    record.first_index = static_cast<uint32_t>(mesh.indices.size());
    record.triangle_count = batch.triangle_count;
    record.index_count = 3 * batch.triangle_count;
    record.mask = submesh.mask.value ? IdPool<MaskEntry>::slot_of(submesh.mask.value) : shared::NoIndex;
    record.alpha_cutoff = submesh.alpha_cutoff;
    record.alpha_factor = submesh.alpha_factor;
    const size_t beyond = size_t{submesh.last_level} + 1;  // Hosts may say UINT32_MAX.
    record.least_error_m = submesh.first_level < errors.size() ? errors[submesh.first_level] : 0.0f;
    record.end_error_m = beyond < errors.size() ? errors[beyond] : shared::NoLevels;
    mesh.bounds = united(mesh.bounds, batch.bounds);
    mesh.masked = mesh.masked || submesh.mask.value;
    for (uint32_t i = 0; i < record.index_count; ++i) {
      const uint32_t at = 3 * batch.first_triangle + i;
      const uint32_t local = prepared.wide_indices.empty() ? prepared.local_indices[at] : prepared.wide_indices[at];
      const uint32_t vertex = prepared.vertices[batch.first_vertex + local];
      if (vertex >= desc.positions.size()) return invalid("add_mesh: the prepared bytes were made from another mesh");
      mesh.indices.push_back(vertex);
    }
    mesh.batches.push_back(record);
  }
  return {};
}

Result<MeshId> GpuScene::add_mesh(const MeshDesc& desc) {
  if (meshes_.full()) return full("meshes");
  if (auto text = check_stream(desc.device_positions, 3, "MeshDesc::device_positions"); !text.empty())
    return invalid(text);
  if (auto text = check_stream(desc.device_uvs, 2, "MeshDesc::device_uvs"); !text.empty()) return invalid(text);
  if (!desc.uvs.empty() && desc.uvs.size() != desc.positions.size())
    return invalid("MeshDesc::uvs: " + std::to_string(desc.uvs.size()) + " for " +
                   std::to_string(desc.positions.size()) + " positions");
  bool masked = false;
  for (const Submesh& submesh : desc.submeshes) {
    if (!submesh.mask.value) continue;
    masked = true;
    if (!masks_.find(submesh.mask.value)) return stale("mask", submesh.mask.value);
  }
  if (auto text = check_levels(desc); !text.empty()) return invalid(text);
  if (masked && desc.uvs.empty() && !desc.device_uvs.address) return invalid("MeshDesc: a masked submesh needs uvs");

  const PrepareSettings prepare{.batch_triangles = settings_.batch_triangles};
  std::vector<std::byte> made;
  std::span<const std::byte> bytes = desc.prepared;
  const uint64_t key = prepare_key(desc.positions, desc.indices, desc.submeshes, prepare);
  auto prepared = open_prepared(bytes);
  if (bytes.empty() || !prepared || prepared->key != key) {
    if (!bytes.empty())
      device_.message(Severity::warning, "add_mesh: the prepared bytes were made from other input; prepared anew");
    auto result = prepare_mesh(desc.positions, desc.indices, desc.submeshes, prepare);
    if (!result) return result.error();
    made = std::move(*result);
    prepared = open_prepared(made);
    if (!prepared) return prepared.error();
  }

  Mesh mesh;
  if (auto batches = make_batches(desc, *prepared, mesh); !batches) return batches.error();
  mesh.vertex_count = static_cast<uint32_t>(desc.positions.size());
  mesh.index_count = static_cast<uint32_t>(mesh.indices.size());
  mesh.device_positions = desc.device_positions;
  mesh.device_uvs = desc.device_uvs;
  if (!desc.device_positions.address) mesh.positions.assign(desc.positions.begin(), desc.positions.end());
  if (!desc.device_uvs.address && masked) mesh.uvs.assign(desc.uvs.begin(), desc.uvs.end());
  for (const Submesh& submesh : desc.submeshes)
    if (submesh.mask.value) {
      mesh.masks.push_back(submesh.mask);
      ++masks_.find(submesh.mask.value)->users;
    }
  mesh.first_batch = batch_ranges_.take(static_cast<uint32_t>(mesh.batches.size()));
  mesh.first_index = index_ranges_.take(mesh.index_count);
  for (shared::BatchRecord& batch : mesh.batches) batch.first_index += mesh.first_index;
  const uint32_t id = meshes_.add(std::move(mesh));
  new_meshes_.push_back(id);
  return MeshId{id};
}

Result<InstanceId> GpuScene::add_instance(const InstanceDesc& desc) {
  if (instances_.full()) return full("instances");
  Mesh* mesh = meshes_.find(desc.mesh.value);
  if (!mesh) return stale("mesh", desc.mesh.value);
  if (!finite(desc.world_from_mesh)) return invalid("InstanceDesc::world_from_mesh is not finite");
  if (auto text = check_stream(desc.deformed, 3, "InstanceDesc::deformed"); !text.empty()) return invalid(text);
  Instance instance;
  instance.desc = desc;
  instance.caster_count = desc.casts ? static_cast<uint32_t>(mesh->batches.size()) : 0;
  instance.first_caster = caster_ranges_.take(instance.caster_count);
  const uint32_t id = instances_.add(std::move(instance));
  ++mesh->instances;
  const uint32_t slot = IdPool<Instance>::slot_of(id);
  Instance& added = instances_.at(slot);
  casters_.resize(std::max<size_t>(casters_.size(), caster_ranges_.size()), {shared::NoIndex, 0});
  for (uint32_t i = 0; i < added.caster_count; ++i) casters_[added.first_caster + i] = {slot, mesh->first_batch + i};
  caster_count_ += added.caster_count;
  if (mesh->masked) ++masked_batches_;
  if (added.caster_count) dirty_casters_.push_back({added.first_caster, added.caster_count});
  dirty_instances_.push_back(slot);
  return InstanceId{id};
}

void GpuScene::mark_moved(uint32_t slot) {
  Instance& instance = instances_.at(slot);
  if (instance.moved) return;
  instance.moved = true;
  moved_.push_back(slot);
}

Result<void> GpuScene::check(const LightDesc& light) const {
  if (!finite(light.position) || !finite(light.direction))
    return invalid("LightDesc: position and direction must be finite");
  const bool directed = light.type != LightType::point;
  if (directed && light.direction.x == 0 && light.direction.y == 0 && light.direction.z == 0)
    return invalid("LightDesc::direction must not be zero");
  if (light.type != LightType::directional && !(light.range_m > 0 && std::isfinite(light.range_m)))
    return invalid("LightDesc::range_m must be > 0 and finite");
  if (light.type == LightType::spot && !(light.outer_cone_rad > 0 && light.outer_cone_rad <= 1.5707964f &&
                                         light.inner_cone_rad >= 0 && light.inner_cone_rad <= light.outer_cone_rad))
    return invalid("LightDesc: 0 <= inner_cone_rad <= outer_cone_rad <= pi/2 and outer > 0");
  if (!(light.near_m >= 0) || (light.type != LightType::directional && light.near_m >= light.range_m))
    return invalid("LightDesc::near_m must be >= 0 and less than range_m");
  if (light.faces == 0 || light.faces > shared::AllCubeFaces)
    return invalid("LightDesc::faces must be 1…63: a bit for each cube face that a point light shines through");
  if (!(light.priority >= 0 && std::isfinite(light.priority)))
    return invalid("LightDesc::priority must be >= 0 and finite");
  return {};
}

void GpuScene::fill(HostLight& light) {
  const LightDesc& desc = light.desc;
  shared::LightRecord& record = light.record;
  record.position_ws = {desc.position.x, desc.position.y, desc.position.z};
  record.range_m = desc.range_m;
  record.direction_ws = shared::unit_direction({desc.direction.x, desc.direction.y, desc.direction.z});
  record.type = static_cast<uint32_t>(desc.type);
  record.cos_inner = std::cos(desc.inner_cone_rad);
  record.cos_outer = std::cos(desc.outer_cone_rad);
  record.outer_cone_rad = desc.outer_cone_rad;
  record.near_m = desc.near_m > 0 ? desc.near_m : desc.range_m / 256;
  record.host_index = desc.host_index;
  record.light_mask = desc.light_mask;
  record.faces = desc.type == LightType::point ? desc.faces : shared::AllCubeFaces;
  record.views = desc.type == LightType::directional                                             ? shared::ViewsOrtho
                 : desc.type == LightType::spot && shared::spot_is_one_view(desc.outer_cone_rad) ? shared::ViewsSpot
                                                                                                 : shared::ViewsCube;
}

Result<LightId> GpuScene::add_light(const LightDesc& desc) {
  if (auto valid = check(desc); !valid) return valid.error();
  HostLight light{.desc = desc};
  fill(light);
  const uint32_t id = lights_.add(light);
  if (!id) return full("lights");
  light_changed(IdPool<HostLight>::slot_of(id));
  return LightId{id};
}

void GpuScene::light_changed(uint32_t slot) {
  dirty_lights_.push_back(slot);
  lights_edited_ = true;
}

Result<void> GpuScene::set_lights(std::span<const LightId> ids, std::span<const LightDesc> descs) {
  if (ids.size() != descs.size()) return invalid("set_lights: as many descriptions as ids are needed");
  for (size_t i = 0; i < ids.size(); ++i) {
    if (!lights_.find(ids[i].value)) return stale("light", ids[i].value);
    if (auto valid = check(descs[i]); !valid) return valid.error();
  }
  for (size_t i = 0; i < ids.size(); ++i) {
    HostLight& light = *lights_.find(ids[i].value);
    light.desc = descs[i];
    fill(light);
    light_changed(IdPool<HostLight>::slot_of(ids[i].value));
  }
  return {};
}

Result<void> GpuScene::set_transforms(std::span<const InstanceId> ids, std::span<const Affine> transforms) {
  if (ids.size() != transforms.size()) return invalid("set_transforms: as many transforms as ids are needed");
  for (size_t i = 0; i < ids.size(); ++i) {
    const Instance* instance = instances_.find(ids[i].value);
    if (!instance) return stale("instance", ids[i].value);
    if (instance->desc.mobility == Mobility::fixed)
      return invalid("set_transforms: instance " + std::to_string(ids[i].value) + " was added as Mobility::fixed");
    if (!finite(transforms[i])) return invalid("set_transforms: transform " + std::to_string(i) + " is not finite");
  }
  for (size_t i = 0; i < ids.size(); ++i) {
    const uint32_t slot = IdPool<Instance>::slot_of(ids[i].value);
    instances_.at(slot).desc.world_from_mesh = transforms[i];
    dirty_instances_.push_back(slot);
    mark_moved(slot);
  }
  return {};
}

Result<void> GpuScene::mark_deformed(std::span<const InstanceId> ids) {
  for (const InstanceId id : ids) {
    const Instance* instance = instances_.find(id.value);
    if (!instance) return stale("instance", id.value);
    if (!instance->desc.deformed.address)
      return invalid("mark_deformed: instance " + std::to_string(id.value) + " has no stream of deformed positions");
  }
  for (const InstanceId id : ids) mark_moved(IdPool<Instance>::slot_of(id.value));
  return {};
}

Result<void> GpuScene::remove(MaskId id) {
  const MaskEntry* mask = masks_.find(id.value);
  if (!mask) return stale("mask", id.value);
  if (mask->users) return invalid("remove: mask " + std::to_string(id.value) + " is used by a mesh");
  std::erase(new_masks_, IdPool<MaskEntry>::slot_of(id.value));
  masks_.retire(id.value);
  removed_masks_.push_back({IdPool<MaskEntry>::slot_of(id.value), 0});
  return {};
}

Result<void> GpuScene::remove(MeshId id) {
  Mesh* mesh = meshes_.find(id.value);
  if (!mesh) return stale("mesh", id.value);
  if (mesh->instances) return invalid("remove: mesh " + std::to_string(id.value) + " has instances");
  for (const MaskId mask : mesh->masks) --masks_.find(mask.value)->users;
  batch_ranges_.give_back(mesh->first_batch, static_cast<uint32_t>(mesh->batches.size()));
  index_ranges_.give_back(mesh->first_index, mesh->index_count);
  if (mesh->position_buffer) removed_buffers_.push_back(std::move(mesh->position_buffer));
  if (mesh->uv_buffer) removed_buffers_.push_back(std::move(mesh->uv_buffer));
  std::erase(new_meshes_, id.value);
  meshes_.remove(id.value);
  return {};
}

Result<void> GpuScene::remove(InstanceId id) {
  Instance* instance = instances_.find(id.value);
  if (!instance) return stale("instance", id.value);
  Mesh& mesh = *meshes_.find(instance->desc.mesh.value);
  --mesh.instances;
  if (mesh.masked) --masked_batches_;
  caster_count_ -= instance->caster_count;
  caster_ranges_.give_back(instance->first_caster, instance->caster_count);
  for (uint32_t i = 0; i < instance->caster_count; ++i) casters_[instance->first_caster + i] = {shared::NoIndex, 0};
  if (instance->caster_count) dirty_casters_.push_back({instance->first_caster, instance->caster_count});
  instances_.remove(id.value);
  return {};
}

Result<void> GpuScene::remove(LightId id) {
  if (!lights_.find(id.value)) return stale("light", id.value);
  lights_.remove(id.value);
  light_changed(IdPool<HostLight>::slot_of(id.value));
  return {};
}

}  // namespace umbrage::scene
