// Depth first, which umbrage marks receivers from; then colour, of the nearest surfaces alone.
#include "host/reflection_cube.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace app {

using umbrage::Result;

namespace {

constexpr uint32_t shade_reflection[] =
#include "shaders/shade_reflection.frag.inc"
    ;

/// Where Vulkan's cube map faces look. Their t runs down where glm's y runs up: these ups make both the same.
constexpr std::array<glm::vec3, 6> kAxes{glm::vec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
constexpr std::array<glm::vec3, 6> kUps{glm::vec3(0, -1, 0), {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};

Result<Handle<VkSampler>> make_sampler(const GpuContext& context) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkSampler made = VK_NULL_HANDLE;
  const VkResult result = context.vk.vkCreateSampler(context.device(), &info, nullptr, &made);
  if (result != VK_SUCCESS) return vulkan_error("vkCreateSampler", result);
  return Handle<VkSampler>(context.device(), made, context.vk.vkDestroySampler);
}

/// Moves a result's value into place, or hands on its error.
template <class T>
Result<void> take(Result<T> result, T& place) {
  if (!result) return result.error();
  place = std::move(result).value();
  return {};
}
template <class T>
Result<void> take(Result<T> result, std::optional<T>& place) {
  if (!result) return result.error();
  place.emplace(std::move(result).value());
  return {};
}

}  // namespace

Result<std::unique_ptr<ReflectionCube>> ReflectionCube::create(GpuContext& context, const Scene& scene,
                                                               const Pose& pose, const TextureTable& textures,
                                                               const MirrorBall& ball, float scene_diagonal_m) {
  LayeredArrays arrays =
      layered_arrays(scene, pose, &textures, {.glowing = true, .without_mesh = static_cast<int>(ball.mesh)});
  // The shader finds materials in the renderer's own table.
  for (umbrage::LayeredInstance& instance : arrays.instances)
    instance.host_index = arrays.materials[instance.host_index];
  auto geometry = arrays.create(context.headless().desc());
  if (!geometry) return geometry.error();
  std::unique_ptr<ReflectionCube> made(new ReflectionCube(ball, std::move(arrays), std::move(*geometry)));
  made->place_views(scene_diagonal_m);
  if (auto ok = made->create_depth(context); !ok) return ok.error();
  if (auto ok = made->create_set(context, textures); !ok) return ok.error();
  if (auto ok = made->create_color(context); !ok) return ok.error();
  return made;
}

void ReflectionCube::place_views(float scene_diagonal_m) {
  // The ball lies before the near planes.
  const float near = 1.02f * ball_.radius / std::sqrt(3.0f), far = glm::max(scene_diagonal_m, 4 * near);
  clip_from_view_ = glm::perspectiveRH_ZO(glm::half_pi<float>(), 1.0f, near, far);
  for (uint32_t i = 0; i < kFaces; ++i) {
    view_from_world_[i] = glm::lookAtRH(ball_.center, ball_.center + kAxes[i], kUps[i]);
    views_[i] = {.clip_from_world = mat4(clip_from_view_ * view_from_world_[i]), .layer = i};
  }
}

Result<ReflectionCube::Layers> ReflectionCube::create_layers(GpuContext& context, const LayerImagesDesc& desc,
                                                             umbrage::LayeredPassSettings settings) {
  settings.writer = context.headless().desc().enabled.vertex_layer ? umbrage::LayeredWriter::vertex_layer
                                                                   : umbrage::LayeredWriter::traditional;
  settings.views = kFaces;
  settings.selection = umbrage::CasterSelection::each_view;
  auto images = LayerImages::create(context, desc);
  if (!images) return images.error();
  auto target = umbrage::LayeredTarget::create(scene_, images->target());
  if (!target) return target.error();
  auto pass = umbrage::LayeredPass::create(scene_, settings);
  if (!pass) return pass.error();
  return Layers{std::move(*images), std::move(*target), std::move(*pass)};
}

Result<void> ReflectionCube::create_depth(GpuContext& context) {
  if (auto made = take(create_layers(context, {.width = kSide, .height = kSide, .layers = kFaces}, {}), depth_); !made)
    return made;
  for (uint32_t i = 0; i < kFaces; ++i)
    if (auto made = take(depth_->images.layer_view(context, i, VK_IMAGE_ASPECT_DEPTH_BIT), depth_views_[i]); !made)
      return made;
  return take(depth_->images.view(context, VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_IMAGE_ASPECT_DEPTH_BIT), all_depths_view_);
}

Result<void> ReflectionCube::create_set(const GpuContext& context, const TextureTable& textures) {
  const auto slots = static_cast<uint32_t>(textures.size());
  const VkDescriptorSetLayoutBinding bindings[] = {
      {0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
      {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, std::max(slots, 1u), VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}};
  if (auto made = take(DescriptorSet::create(context, bindings), set_); !made) return made;
  set_.write_image(context, 0, 0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                   {VK_NULL_HANDLE, all_depths_view_.get(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL});
  for (uint32_t i = 0; i < slots; ++i)
    set_.write_image(context, 1, i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                     {textures.sampler(i), textures.view(i), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  if (auto made = take(make_sampler(context), sampler_); !made) return made;
  return take(context.create_buffer(sizeof(gpu::GpuReflection), Memory::upload, "reflection"), data_);
}

Result<void> ReflectionCube::create_color(GpuContext& context) {
  const VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;  // as the picture's
  umbrage::LayeredPassSettings settings;
  settings.color_fragment = shade_reflection;
  settings.color_format = format;
  settings.color_set_layout = set_.layout();
  const LayerImagesDesc images{
      .width = kSide, .height = kSide, .layers = kFaces, .color_format = format, .is_cube = true};
  if (auto made = take(create_layers(context, images, settings), color_); !made) return made;
  return take(color_->images.view(context, VK_IMAGE_VIEW_TYPE_CUBE, VK_IMAGE_ASPECT_COLOR_BIT), color_view_);
}

std::array<umbrage::CameraDesc, ReflectionCube::kFaces> ReflectionCube::cameras(uint32_t first) const {
  std::array<umbrage::CameraDesc, kFaces> cameras;
  for (uint32_t i = 0; i < kFaces; ++i)
    cameras[i] = {.id = umbrage::CameraId{first + i},
                  .view_from_world = mat4(view_from_world_[i]),
                  .clip_from_view = mat4(clip_from_view_),
                  .width = kSide,
                  .height = kSide,
                  .depth = depth_views_[i].get()};
  return cameras;
}

Result<void> ReflectionCube::begin_frame(const Pose& pose, uint64_t serial) {
  for (uint32_t i = 0; i < arrays_.instances.size(); ++i) {
    const umbrage::Affine now = affine_rows(pose.instances[arrays_.posed[i]].world_from_mesh);
    umbrage::Affine& known = arrays_.instances[i].world_from_mesh;
    if (std::memcmp(&known, &now, sizeof now) == 0) continue;
    known = now;
    if (auto set = scene_.set_transform(i, now); !set) return set;
  }
  if (auto begun = scene_.begin_frame(serial); !begun) return begun;
  if (auto ready = depth_->pass.prepare({.target = depth_->target, .views = views_}); !ready) return ready;
  return color_->pass.prepare(
      {.target = color_->target, .views = views_, .color_set = set_.get(), .host_data = data_.address()});
}

void ReflectionCube::record_depth(const GpuContext& context, VkCommandBuffer commands) {
  scene_.record(commands);
  depth_->images.begin_drawing(context, commands);
  depth_->pass.record(commands);
  depth_->images.end_drawing(context, commands);
}

void ReflectionCube::record_color(const GpuContext& context, VkCommandBuffer commands, VkDeviceAddress frame,
                                  const std::array<VkDeviceAddress, kFaces>& shadows) {
  gpu::GpuReflection data{.frame = frame, .shadows = {}, .eye_ws = ball_.center, .padding = 0};
  std::copy(shadows.begin(), shadows.end(), data.shadows);
  data_.write(std::span<const gpu::GpuReflection>(&data, 1));
  color_->images.begin_drawing(context, commands);
  color_->pass.record(commands);
  color_->images.end_drawing(context, commands);
}

}  // namespace app
