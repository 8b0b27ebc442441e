// Camera matrices, light tables, ambient light.
#include "host/frame_data.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

namespace {

/// Ambient light stands in for what bounces: this share of the mean irradiance within the lights' reach.
constexpr float ambient_share = 0.1f;
/// With a sun comes a sky: of the sun's luminance from everywhere, bluer than the sun.
constexpr glm::vec3 sky_share{0.034f, 0.041f, 0.054f};
/// A scene without lights is shown by this ambient irradiance alone.
constexpr glm::vec3 ambient_without_lights{1.0f};

/// 1/d² averages to 3/r² over a ball of radius r. Lights count by the volume of the scene that they light; where their
/// volumes together exceed the scene's they overlap and add up.
glm::vec3 ambient_irradiance(std::span<const ActiveLight> lights, const SceneExtent& extent) {
  if (lights.empty()) return ambient_without_lights;
  const glm::vec3 center = 0.5f * (extent.lowest + extent.highest);
  const float scene_radius = 0.5f * glm::length(extent.highest - extent.lowest);
  glm::vec3 directional{0}, sum{0};
  float volume = 0;
  for (const ActiveLight& light : lights) {
    const glm::vec3 intensity = light.color * light.intensity;
    if (light.kind == LightKind::directional) {
      directional += intensity * 0.25f;  // A sphere's cross section over its surface.
      continue;
    }
    const float share_of_sphere = light.kind == LightKind::point ? 1.0f : 0.5f * (1.0f - std::cos(light.outer_cone));
    const float reach = std::min(light.range, std::max(scene_radius, glm::length(light.position - center)));
    const float inside = std::min(reach, scene_radius);
    const float lit = share_of_sphere * inside * inside * inside;
    sum += lit * 3.0f / std::max(reach * reach, 1e-9f) * intensity;
    volume += lit;
  }
  const float lit_volume = std::min(volume, scene_radius * scene_radius * scene_radius);
  const glm::vec3 mean = directional + sum / std::max(lit_volume, 1e-20f);
  // Bounces wash colour out: half of it is the mean's grey.
  const float grey = (mean.r + mean.g + mean.b) / 3.0f;
  const float sun = glm::dot(directional * 4.0f, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  return ambient_share * glm::mix(mean, glm::vec3(grey), 0.5f) + sky_share * sun;
}

gpu::GpuLight gpu_light(const ActiveLight& light) {
  gpu::GpuLight made{};
  made.position_ws = light.position;
  made.type = light.kind == LightKind::point  ? gpu::LightPoint
              : light.kind == LightKind::spot ? gpu::LightSpot
                                              : gpu::LightDirectional;
  made.direction_ws = glm::normalize(light.direction);
  made.range_m = light.range;
  made.intensity = light.color * light.intensity;
  made.cos_inner = std::cos(light.inner_cone);
  made.cos_outer = std::cos(light.outer_cone);
  made.faces = light.kind == LightKind::point ? light.faces : umbrage::LightDesc().faces;
  return made;
}

float distance_to_far_corner(const glm::vec3& eye, const SceneExtent& extent) {
  return glm::length(glm::max(glm::abs(extent.lowest - eye), glm::abs(extent.highest - eye)));
}

/// Scale of x and y, with y down as Vulkan has it.
glm::vec2 lens_scale(const Camera& lens, float picture_aspect) {
  if (lens.orthographic) {
    const float lens_aspect = lens.half_width / lens.half_height;
    const float half_height = picture_aspect < lens_aspect ? lens.half_width / picture_aspect : lens.half_height;
    return {1.0f / (half_height * picture_aspect), -1.0f / half_height};
  }
  float half_height = std::tan(0.5f * lens.fov_y);
  if (lens.aspect > picture_aspect) half_height *= lens.aspect / picture_aspect;
  return {1.0f / (half_height * picture_aspect), -1.0f / half_height};
}

/// (a, b, c, d): depth = (a z + b) / (d - c z), z negative before the camera.
glm::vec4 lens_depth(const Camera& lens, float far) {
  if (lens.orthographic) return {1.0f / (far - lens.near), far / (far - lens.near), 0, 1};
  if (std::isinf(far)) return {0, lens.near, 1, 0};
  return {lens.near / (far - lens.near), lens.near * far / (far - lens.near), 1, 0};
}

Result<void> check_lens(const Camera& lens) {
  const bool sound = lens.orthographic ? lens.half_width > 0 && lens.half_height > 0 && lens.far > lens.near
                                       : lens.fov_y > 0 && lens.fov_y < std::numbers::pi_v<float> && lens.near > 0 &&
                                             lens.far > lens.near;
  if (sound && std::isfinite(lens.near)) return {};
  return Error{ErrorCode::invalid_argument, "camera \"" + lens.name + "\" has no usable lens: field of view " +
                                                std::to_string(lens.fov_y) + " rad, near " + std::to_string(lens.near) +
                                                ", far " + std::to_string(lens.far)};
}

}  // namespace

SceneExtent measure_extent(const Pose& pose, const SceneBuffers& buffers, std::span<const SceneItem> items) {
  SceneExtent extent;
  extent.lowest = glm::vec3(std::numeric_limits<float>::max());
  extent.highest = -extent.lowest;
  for (const SceneItem& item : items) {
    const UploadedPrimitive& primitive = buffers.primitives()[item.primitive];
    const glm::mat4& matrix = pose.instances[item.instance].world_from_mesh;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p(corner & 1 ? primitive.highest.x : primitive.lowest.x,
                        corner & 2 ? primitive.highest.y : primitive.lowest.y,
                        corner & 4 ? primitive.highest.z : primitive.lowest.z);
      const glm::vec3 world(matrix * glm::vec4(p, 1.0f));
      extent.lowest = glm::min(extent.lowest, world);
      extent.highest = glm::max(extent.highest, world);
    }
  }
  if (items.empty()) extent.lowest = extent.highest = glm::vec3(0);
  return extent;
}

Result<CameraMatrices> camera_matrices(const ViewCamera& camera, uint32_t width, uint32_t height,
                                       const SceneExtent& extent) {
  if (auto sound = check_lens(camera.lens); !sound) return sound.error();
  CameraMatrices m;
  m.right = glm::normalize(glm::vec3(camera.world_from_camera[0]));
  m.up = glm::normalize(glm::vec3(camera.world_from_camera[1]));
  m.back = glm::normalize(glm::vec3(camera.world_from_camera[2]));
  m.eye = glm::vec3(camera.world_from_camera[3]);
  const glm::mat3 world_from_view(m.right, m.up, m.back);
  const glm::mat3 view_turn = glm::transpose(world_from_view);
  m.view_from_world = glm::mat4(view_turn);
  m.view_from_world[3] = glm::vec4(-(view_turn * m.eye), 1.0f);

  const bool endless_ortho = camera.lens.orthographic && std::isinf(camera.lens.far);
  const float far =
      endless_ortho ? std::max(distance_to_far_corner(m.eye, extent), camera.lens.near + 1.0f) : camera.lens.far;
  m.lens_scale = lens_scale(camera.lens, static_cast<float>(width) / static_cast<float>(height));
  m.lens_depth = lens_depth(camera.lens, far);
  m.clip_from_view = glm::mat4(0.0f);
  m.clip_from_view[0][0] = m.lens_scale.x;
  m.clip_from_view[1][1] = m.lens_scale.y;
  m.clip_from_view[2][2] = m.lens_depth.x;
  m.clip_from_view[3][2] = m.lens_depth.y;
  m.clip_from_view[2][3] = -m.lens_depth.z;
  m.clip_from_view[3][3] = m.lens_depth.w;
  m.clip_from_offset = m.clip_from_view * glm::mat4(view_turn);
  return m;
}

Result<FrameData> FrameData::create(const GpuContext& context, uint32_t max_lights, const SceneExtent& extent) {
  FrameData data;
  data.extent_ = extent;
  data.max_lights_ = max_lights;
  struct Wanted {
    DeviceBuffer* buffer;
    VkDeviceSize bytes;
    Memory memory;
    const char* name;
    VkBufferUsageFlags usage;
  };
  const Wanted all[] = {
      {&data.frame_buffer_, sizeof(gpu::GpuFrame), Memory::upload, "frame", 0},
      {&data.lights_, std::max(max_lights, 1u) * sizeof(gpu::GpuLight), Memory::upload, "lights", 0},
      {&data.counters_, sizeof(gpu::GpuCounters), Memory::device, "counters", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
      {&data.counters_read_back_, sizeof(gpu::GpuCounters), Memory::read_back, "counters read back", 0},
  };
  for (const Wanted& wanted : all) {
    auto buffer = context.create_buffer(wanted.bytes, wanted.memory, wanted.name, wanted.usage);
    if (!buffer) return buffer.error();
    *wanted.buffer = std::move(buffer).value();
  }
  data.frame_.lights = data.lights_.address();
  data.frame_.counters = data.counters_.address();
  return data;
}

Result<void> FrameData::set_lights(std::span<const ActiveLight> lights) {
  if (lights.size() > max_lights_) {
    return Error{ErrorCode::invalid_argument, std::to_string(lights.size()) +
                                                  " lights in a frame: the renderer was made for " +
                                                  std::to_string(max_lights_) + " (RendererDesc::max_lights)"};
  }
  std::vector<gpu::GpuLight> table;
  table.reserve(lights.size());
  for (const ActiveLight& light : lights) table.push_back(gpu_light(light));
  lights_.write(std::span<const gpu::GpuLight>(table));
  frame_.light_count = static_cast<uint32_t>(lights.size());
  frame_.ambient = ambient_irradiance(lights, extent_);
  return {};
}

void FrameData::set_camera(const CameraMatrices& m, const ViewCamera& camera, const Targets& targets) {
  frame_.clip_from_offset = m.clip_from_offset;
  frame_.eye_ws = m.eye;
  frame_.right_ws = m.right;
  frame_.up_ws = m.up;
  frame_.back_ws = m.back;
  frame_.orthographic = camera.lens.orthographic ? 1u : 0u;
  frame_.lens_scale = m.lens_scale;
  frame_.lens_depth = m.lens_depth;
  frame_.width = targets.width();
  frame_.height = targets.height();
  const float farthest = distance_to_far_corner(m.eye, extent_);
  const float to_box = glm::length(glm::max(glm::max(extent_.lowest - m.eye, m.eye - extent_.highest), 0.0f));
  const float nearest = std::max({camera.lens.near, to_box, farthest / 32.0f});
  frame_.shown_depth_m = {nearest, std::max(farthest, 1.01f * nearest)};
}

void FrameData::record_clear(const GpuContext& context, VkCommandBuffer commands) const {
  context.vk.vkCmdFillBuffer(commands, counters_.get(), 0, VK_WHOLE_SIZE, 0);
  memory_barrier(context, commands, transfer_write, compute_access);
}

void FrameData::record_read_back(const GpuContext& context, VkCommandBuffer commands) const {
  memory_barrier(context, commands, compute_write, transfer_read);
  const VkBufferCopy all{0, 0, sizeof(gpu::GpuCounters)};
  context.vk.vkCmdCopyBuffer(commands, counters_.get(), counters_read_back_.get(), 1, &all);
  memory_barrier(context, commands, transfer_write, host_read);
  memory_barrier(context, commands, compute_write, host_read);  // umbrage's counts of taps
}

const gpu::GpuCounters& FrameData::read_counters() const {
  return *reinterpret_cast<const gpu::GpuCounters*>(counters_read_back_.mapped());
}

umbrage::CameraDesc umbrage_camera(const CameraMatrices& m, const Targets& targets, const OtherReceivers& others) {
  umbrage::CameraDesc desc;
  std::memcpy(desc.view_from_world.m, &m.view_from_world, sizeof(desc.view_from_world.m));
  std::memcpy(desc.clip_from_view.m, &m.clip_from_view, sizeof(desc.clip_from_view.m));
  desc.width = targets.width();
  desc.height = targets.height();
  desc.depth = targets[Target::depth].view();
  desc.depth_layout = layout_of(ImageUse::depth_read);
  desc.normal = targets[Target::geometric_normal].view();
  desc.normal_layout = layout_of(ImageUse::sampled);
  desc.normal_encoding = umbrage::NormalEncoding::octahedral_snorm;
  desc.other_receivers = others.any;
  desc.other_receivers_ws = others.boxes;
  return desc;
}

}  // namespace app
