// What a frame does with the edits: buffers grow, records travel, boxes and trees follow.
#include "scene/gpu_scene.hpp"

#include <algorithm>
#include <cmath>

#include "scene/scene_push.shared.h"

namespace umbrage::scene {

namespace {
constexpr uint32_t kBoundBatches[] =
#include "shaders/bound_batches.comp.inc"
    ;
constexpr uint32_t kBoundLights[] =
#include "shaders/bound_lights.comp.inc"
    ;
constexpr uint32_t kMaxGroups = 65535;

constexpr VkDeviceSize padded(VkDeviceSize bytes) { return (bytes + 15) & ~VkDeviceSize(15); }

/// Around a box of mesh space; m: the three rows of world_from_mesh.
shared::Box world_box(const float* m, const Aabb& box) {
  const float centre[3] = {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, (box.min.z + box.max.z) / 2};
  const float half[3] = {(box.max.x - box.min.x) / 2, (box.max.y - box.min.y) / 2, (box.max.z - box.min.z) / 2};
  shared::Box world;
  for (int row = 0; row < 3; ++row) {
    float at = m[4 * row + 3], extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
      at += m[4 * row + axis] * centre[axis];
      extent += std::abs(m[4 * row + axis]) * half[axis];
    }
    world.lo[row] = at - extent;
    world.hi[row] = at + extent;
  }
  return world;
}

/// No length grows by more: the square root of the largest row sum of MᵀM, which is exact for turns with one scale an axis.
float stretch_of(const float* m) {
  float most = 1e-30f;
  for (int i = 0; i < 3; ++i) {
    float sum = 0;
    for (int j = 0; j < 3; ++j) sum += std::abs(m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j]);
    most = sum <= 1e30f ? std::max(most, sum) : 1e30f;
  }
  return std::sqrt(most);
}
}  // namespace

Result<ScenePipelines> ScenePipelines::create(const gpu::PipelineFactory& factory) {
  ScenePipelines out;
  auto tree = TreePipelines::create(factory);
  if (!tree) return tree.error();
  out.tree = std::move(*tree);
  auto batches = factory.compute(kBoundBatches, "bound batches");
  if (!batches) return batches.error();
  out.bound_batches = std::move(*batches);
  auto lights = factory.compute(kBoundLights, "bound lights");
  if (!lights) return lights.error();
  out.bound_lights = std::move(*lights);
  return out;
}

void GpuScene::fill(Instance& instance, const Mesh& mesh) const {
  const float* m = instance.desc.world_from_mesh.m;
  shared::InstanceRecord& record = instance.record;
  record.row0 = {m[0], m[1], m[2], m[3]};
  record.row1 = {m[4], m[5], m[6], m[7]};
  record.row2 = {m[8], m[9], m[10], m[11]};
  const Stream own{mesh.position_buffer ? mesh.position_buffer->address() : 0, sizeof(Vec3)};
  const Stream& positions = instance.desc.deformed.address  ? instance.desc.deformed
                            : mesh.device_positions.address ? mesh.device_positions
                                                            : own;
  record.positions = positions.address;
  record.position_stride = positions.stride_bytes / 4;
  record.uvs = mesh.device_uvs.address ? mesh.device_uvs.address : mesh.uv_buffer ? mesh.uv_buffer->address() : 0;
  record.uv_stride = mesh.device_uvs.address ? mesh.device_uvs.stride_bytes / 4 : 2;
  record.light_mask = instance.desc.light_mask;
  record.flags = instance.desc.mobility == Mobility::fixed ? shared::InstanceIsFixed : 0;
  record.box = world_box(m, mesh.bounds);
  record.stretch = instance.desc.deformed.address ? shared::NoLevels : stretch_of(m);
}

Result<void> GpuScene::ensure_buffers() {
  const struct {
    gpu::GrownBuffer& buffer;
    VkDeviceSize bytes;
    const char* name;
  } needs[] = {{light_buffer_, std::max(lights_.slots(), 1u) * sizeof(shared::LightRecord), "lights"},
               {instance_buffer_, std::max(instances_.slots(), 1u) * sizeof(shared::InstanceRecord), "instances"},
               {batch_buffer_, std::max(batch_ranges_.size(), 1u) * sizeof(shared::BatchRecord), "batches"},
               {caster_buffer_, std::max(caster_ranges_.size(), 1u) * sizeof(shared::CasterRecord), "casters"},
               {caster_boxes_, std::max(caster_ranges_.size(), 1u) * sizeof(shared::Box), "caster boxes"},
               {index_buffer_, std::max(index_ranges_.size(), 1u) * sizeof(uint32_t), "indices"},
               {light_order_buffer_, std::max(lights_.slots(), 1u) * sizeof(uint32_t), "light order"}};
  for (const auto& need : needs)
    if (auto grown = need.buffer.ensure(device_, memory_, need.bytes, need.name); !grown) return grown.error();
  const VkDeviceSize light_boxes = std::max(lights_.slots(), 1u) * sizeof(shared::Box);
  if (!light_boxes_ || light_boxes_.size() < light_boxes) {
    auto made = gpu::Buffer::create(device_, memory_, 2 * light_boxes, gpu::MemoryKind::device, "light boxes");
    if (!made) return made.error();
    if (light_boxes_) outgrown_.push_back(std::move(light_boxes_));
    light_boxes_ = std::move(*made);
    lights_edited_ = true;
  }
  if (auto ok = caster_tree_.reserve(device_, memory_, caster_ranges_.size(), outgrown_); !ok) return ok.error();
  if (auto ok = light_tree_.reserve(device_, memory_, lights_.slots(), outgrown_); !ok) return ok.error();
  for (const uint32_t id : new_meshes_) {
    Mesh& mesh = *meshes_.find(id);
    const auto make = [&](std::unique_ptr<gpu::Buffer>& target, VkDeviceSize bytes, const char* name) -> Result<void> {
      if (bytes == 0 || target) return {};
      auto made = gpu::Buffer::create(device_, memory_, bytes, gpu::MemoryKind::device, name);
      if (!made) return made.error();
      target = std::make_unique<gpu::Buffer>(std::move(*made));
      return {};
    };
    if (auto ok = make(mesh.position_buffer, mesh.positions.size() * sizeof(Vec3), "positions"); !ok) return ok.error();
    if (auto ok = make(mesh.uv_buffer, mesh.uvs.size() * sizeof(Vec2), "uvs"); !ok) return ok.error();
  }
  return {};
}

VkDeviceSize GpuScene::staged_bytes() const {
  VkDeviceSize bytes = 16384;  // of the frame itself
  for (const uint32_t id : new_meshes_) {
    const Mesh& mesh = *meshes_.find(id);
    bytes += padded(mesh.positions.size() * sizeof(Vec3)) + padded(mesh.uvs.size() * sizeof(Vec2)) +
             padded(mesh.indices.size() * sizeof(uint32_t)) + padded(mesh.batches.size() * sizeof(shared::BatchRecord));
  }
  bytes += dirty_instances_.size() * padded(sizeof(shared::InstanceRecord));
  bytes += dirty_lights_.size() * padded(sizeof(shared::LightRecord)) + padded(lights_.slots() * sizeof(uint32_t));
  for (const auto& [first, count] : dirty_casters_)
    bytes += padded(count * sizeof(shared::CasterRecord)) + padded(count * sizeof(uint32_t));
  for (const uint32_t slot : moved_)
    if (instances_.alive(slot)) bytes += padded(instances_.at(slot).caster_count * sizeof(uint32_t));
  return bytes;
}

void GpuScene::stage_meshes(gpu::Uploader& uploader) {
  new_geometry_.clear();
  for (const uint32_t id : new_meshes_) {
    Mesh& mesh = *meshes_.find(id);
    if (mesh.position_buffer) {
      uploader.copy(*mesh.position_buffer, 0, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
      new_geometry_.push_back(mesh.position_buffer.get());
    }
    if (mesh.uv_buffer) {
      uploader.copy(*mesh.uv_buffer, 0, mesh.uvs.data(), mesh.uvs.size() * sizeof(Vec2));
      new_geometry_.push_back(mesh.uv_buffer.get());
    }
    uploader.copy(index_buffer_.buffer(), mesh.first_index * sizeof(uint32_t), mesh.indices.data(),
                  mesh.indices.size() * sizeof(uint32_t));
    uploader.copy(batch_buffer_.buffer(), mesh.first_batch * sizeof(shared::BatchRecord), mesh.batches.data(),
                  mesh.batches.size() * sizeof(shared::BatchRecord));
    mesh.positions = {}, mesh.uvs = {}, mesh.indices = {};
  }
  new_meshes_.clear();
}

void GpuScene::stage_records(gpu::Uploader& uploader) {
  const auto sort_unique = [](std::vector<uint32_t>& slots) {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  };
  sort_unique(dirty_instances_);
  for (const uint32_t slot : dirty_instances_) {
    if (!instances_.alive(slot)) continue;
    Instance& instance = instances_.at(slot);
    fill(instance, *meshes_.find(instance.desc.mesh.value));
    uploader.copy(instance_buffer_.buffer(), slot * sizeof(shared::InstanceRecord), &instance.record,
                  sizeof instance.record);
  }
  dirty_instances_.clear();

  sort_unique(dirty_lights_);
  for (const uint32_t slot : dirty_lights_) {
    shared::LightRecord record{};
    record.type = shared::NoIndex;
    if (lights_.alive(slot)) record = lights_.at(slot).record;
    uploader.copy(light_buffer_.buffer(), slot * sizeof(shared::LightRecord), &record, sizeof record);
  }
  dirty_lights_.clear();
  lights_changed_ = lights_edited_;
  if (lights_edited_) {
    // All lights alive, directional ones first: they are in every cluster's list. Then the most important.
    std::vector<uint32_t> order;
    order.reserve(lights_.count());
    for (const bool directional : {true, false}) {
      for (uint32_t slot = 0; slot < lights_.slots(); ++slot)
        if (lights_.alive(slot) && (lights_.at(slot).record.type == shared::LightDirectional) == directional)
          order.push_back(slot);
      if (directional)
        directional_count_ = static_cast<uint32_t>(order.size());
      else
        std::stable_sort(order.begin() + directional_count_, order.end(), [&](uint32_t a, uint32_t b) {
          return lights_.at(a).desc.priority > lights_.at(b).desc.priority;
        });
    }
    uploader.copy(light_order_buffer_.buffer(), 0, order.data(), order.size() * sizeof(uint32_t));
    lights_edited_ = false;
  }
  for (const auto& [first, count] : dirty_casters_)
    uploader.copy(caster_buffer_.buffer(), first * sizeof(shared::CasterRecord), &casters_[first],
                  count * sizeof(shared::CasterRecord));
}

void GpuScene::stage_moved(gpu::Uploader& uploader) {
  moved_count_ = 0;
  for (const auto& range : dirty_casters_) moved_count_ += range.second;
  for (const uint32_t slot : moved_)
    if (instances_.alive(slot) && instances_.at(slot).moved) moved_count_ += instances_.at(slot).caster_count;
  auto* out = reinterpret_cast<uint32_t*>(uploader.stage(moved_count_ * sizeof(uint32_t), &moved_address_));
  const auto append = [&](uint32_t first, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) *out++ = first + i;
  };
  for (const auto& [first, count] : dirty_casters_) append(first, count);
  for (const uint32_t slot : moved_) {
    if (!instances_.alive(slot) || !instances_.at(slot).moved) continue;
    append(instances_.at(slot).first_caster, instances_.at(slot).caster_count);
    instances_.at(slot).moved = false;
  }
  moved_.clear();
  dirty_casters_.clear();
}

Result<void> GpuScene::upload(gpu::Uploader& uploader, gpu::RetireQueue& retired, uint64_t serial,
                              VkDeviceSize bytes_beside) {
  if (auto ok = ensure_buffers(); !ok) return ok.error();
  if (auto ok = uploader.begin(device_, memory_, staged_bytes() + bytes_beside, "staging"); !ok) return ok.error();
  for (gpu::Buffer& buffer : outgrown_) retired.retire(std::move(buffer), serial);
  for (std::unique_ptr<gpu::Buffer>& buffer : removed_buffers_) retired.retire(std::move(*buffer), serial);
  outgrown_.clear();
  removed_buffers_.clear();
  for (RemovedMask& mask : removed_masks_)
    if (mask.serial == 0) mask.serial = serial;
  stage_meshes(uploader);
  stage_records(uploader);
  stage_moved(uploader);
  return {};
}

void GpuScene::collect(uint64_t completed_serial) {
  std::erase_if(removed_masks_, [&](const RemovedMask& mask) {
    const bool unused = mask.serial != 0 && mask.serial <= completed_serial;
    if (unused) masks_.release(mask.slot);
    return unused;
  });
}

void GpuScene::record(gpu::Recorder& recorder, const ScenePipelines& pipelines, gpu::Uploader& uploader,
                      gpu::RetireQueue& retired, uint64_t serial) {
  {
    gpu::Scope scope(recorder, "upload");
    for (gpu::GrownBuffer* buffer : {&light_buffer_, &instance_buffer_, &batch_buffer_, &caster_buffer_, &index_buffer_,
                                     &caster_boxes_, &light_order_buffer_})
      buffer->record(recorder, retired, serial);
    uploader.record(recorder);
    // Written once, so this makes them visible for good.
    constexpr size_t kAtOnce = 24;
    for (std::span<const gpu::Buffer* const> rest = new_geometry_; !rest.empty();
         rest = rest.subspan(std::min(kAtOnce, rest.size())))
      recorder.publish(rest.first(std::min(kAtOnce, rest.size())), {},
                       VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT);
  }
  {
    gpu::Scope scope(recorder, "batch bounds");
    for (uint32_t first = 0; first < moved_count_; first += kMaxGroups) {
      gpu::Pass pass = recorder.pass("bound batches");
      const shared::BoundBatchesPush push{.moved = moved_address_ + first * sizeof(uint32_t),
                                          .casters = pass.read(caster_buffer()),
                                          .instances = pass.read(instance_buffer()),
                                          .batches = pass.read(batch_buffer()),
                                          .indices = pass.read(index_buffer()),
                                          .boxes = pass.write(caster_boxes_.buffer())};
      pass.dispatch(pipelines.bound_batches, push, std::min(moved_count_ - first, kMaxGroups));
    }
  }
  {
    gpu::Scope scope(recorder, "caster tree");
    if (moved_count_ > 0 || !has_trees_)
      caster_tree_.record(recorder, pipelines.tree, caster_boxes_.buffer(), caster_slots());
  }
  gpu::Scope scope(recorder, "light tree");
  if (lights_changed_ && light_slots() > 0) {
    gpu::Pass pass = recorder.pass("bound lights");
    const shared::BoundLightsPush push{
        .lights = pass.read(light_buffer()), .boxes = pass.write(light_boxes_), .count = light_slots()};
    pass.dispatch(pipelines.bound_lights, push, (light_slots() + 63) / 64);
  }
  if (lights_changed_ || !has_trees_) light_tree_.record(recorder, pipelines.tree, light_boxes_, light_slots());
  has_trees_ = true;
}

}  // namespace umbrage::scene
