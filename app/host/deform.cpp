// Morph targets and skins.
#include "host/deform.hpp"

#include <algorithm>

namespace app {

using umbrage::Result;

namespace {
constexpr uint32_t deform_vertices[] =
#include "shaders/deform_vertices.comp.inc"
    ;
constexpr uint32_t group_size = 64;
}  // namespace

Result<Deformer> Deformer::create(const GpuContext& context, VkPipelineLayout layout, const Pose& pose,
                                  const SceneBuffers& buffers, std::span<SceneItem> items) {
  Deformer deformer;
  auto pipeline = create_compute_pipeline(context, layout, deform_vertices, "deform vertices");
  if (!pipeline) return pipeline.error();
  deformer.pipeline_ = std::move(pipeline).value();
  if (auto made = deformer.create_buffers(context, pose, buffers, items); !made) return made.error();
  return deformer;
}

Result<void> Deformer::create_buffers(const GpuContext& context, const Pose& pose, const SceneBuffers& buffers,
                                      std::span<SceneItem> items) {
  VkDeviceSize stream_bytes = 0;
  size_t input_bytes = 0;
  for (uint32_t i = 0; i < items.size(); ++i) {
    if (!items[i].deformed) continue;
    const UploadedPrimitive& primitive = buffers.primitives()[items[i].primitive];
    const PosedInstance& instance = pose.instances[items[i].instance];
    Job job;
    job.item = i;
    if (instance.skin >= 0 && primitive.joints != 0) {
      job.joint_count = pose.joint_matrices[static_cast<size_t>(instance.skin)].size();
    }
    job.weight_count = std::min<size_t>(instance.weights.size(), primitive.target_count);
    job.joints_at = input_bytes;
    job.weights_at = job.joints_at + job.joint_count * sizeof(glm::mat4);
    input_bytes = job.weights_at + job.weight_count * sizeof(float);
    job.push.out_positions = stream_bytes;
    job.push.out_normals = stream_bytes + primitive.vertex_count * sizeof(glm::vec3);
    stream_bytes += 2 * primitive.vertex_count * sizeof(glm::vec3);
    jobs_.push_back(job);
  }
  if (jobs_.empty()) return {};
  auto streams = context.create_buffer(stream_bytes, Memory::device, "deformed streams");
  if (!streams) return streams.error();
  streams_ = std::move(streams).value();
  auto inputs = context.create_buffer(std::max<size_t>(input_bytes, 16), Memory::upload, "joints and weights");
  if (!inputs) return inputs.error();
  inputs_ = std::move(inputs).value();
  last_inputs_.resize(input_bytes);
  inputs_.write(std::span<const std::byte>(last_inputs_));

  for (Job& job : jobs_) {
    SceneItem& item = items[job.item];
    const UploadedPrimitive& primitive = buffers.primitives()[item.primitive];
    job.push.positions = primitive.positions;
    job.push.normals = primitive.normals;
    job.push.joints = job.joint_count > 0 ? primitive.joints : 0;
    job.push.joint_weights = primitive.joint_weights;
    job.push.joint_matrices = inputs_.address() + job.joints_at;
    job.push.morph_positions = primitive.morph_positions;
    job.push.morph_normals = primitive.morph_normals;
    job.push.morph_weights = inputs_.address() + job.weights_at;
    job.push.vertex_count = primitive.vertex_count;
    job.push.target_count = static_cast<uint32_t>(job.weight_count);
    item.positions = job.push.out_positions += streams_.address();
    item.normals = job.push.out_normals += streams_.address();
  }
  return {};
}

std::span<const uint32_t> Deformer::update(const Pose& pose, std::span<const SceneItem> items) {
  changed_items_.clear();
  const auto take = [this](size_t at, const void* values, size_t bytes) {
    if (bytes == 0 || std::memcmp(last_inputs_.data() + at, values, bytes) == 0) return false;
    std::memcpy(last_inputs_.data() + at, values, bytes);
    std::memcpy(inputs_.mapped() + at, values, bytes);
    return true;
  };
  for (Job& job : jobs_) {
    const PosedInstance& instance = pose.instances[items[job.item].instance];
    if (take(job.weights_at, instance.weights.data(), job.weight_count * sizeof(float))) job.pending = true;
    if (job.joint_count > 0) {
      const auto& joints = pose.joint_matrices[static_cast<size_t>(instance.skin)];
      if (take(job.joints_at, joints.data(), job.joint_count * sizeof(glm::mat4))) job.pending = true;
    }
    if (job.pending) changed_items_.push_back(job.item);
  }
  return changed_items_;
}

void Deformer::record(const GpuContext& context, VkCommandBuffer commands, VkPipelineLayout layout) {
  if (changed_items_.empty()) return;
  context.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  for (Job& job : jobs_) {
    if (!std::exchange(job.pending, false)) continue;
    push_constants(context, commands, layout, job.push);
    dispatch_items(context, commands, job.push.vertex_count, group_size);
  }
  memory_barrier(context, commands, compute_write, any_shader_read);
}

}  // namespace app
