// Sun map, views, sheet: three layered passes at most, each over the same scene.
#include "layered/use_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>

#include "host/descriptors.hpp"
#include "host/layer_images.hpp"
#include "host/layered_geometry.hpp"
#include "host/mirror_ball.hpp"
#include "host/textures.hpp"

namespace app {

using umbrage::Result;

namespace {

constexpr uint32_t kShadeUse[] =
#include "shaders/shade_use.frag.inc"
    ;
constexpr uint32_t kSunSide = 2048;
constexpr uint32_t kNone = 0xffffffffu;

/// As Material of uses.glsl.
struct UseMaterial {
  glm::vec4 base_color{1};
  uint32_t texture_slot = kNone;
  float alpha_cutoff = 0;
};
static_assert(sizeof(UseMaterial) == 24);

/// As Uses of uses.glsl.
struct UseData {
  glm::mat4 sun_from_world{1};
  glm::vec4 to_sun{0};
  glm::vec4 ball{0};
  glm::vec4 eyes[6]{};
  uint64_t materials = 0;
  uint32_t ball_index = kNone;
  uint32_t padding = 0;
};
static_assert(sizeof(UseData) == 208);

Result<Handle<VkSampler>> make_sampler(const GpuContext& gpu, bool compares) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW =
      compares ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
  info.compareEnable = compares;
  info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  VkSampler sampler = VK_NULL_HANDLE;
  const VkResult result = gpu.vk.vkCreateSampler(gpu.device(), &info, nullptr, &sampler);
  if (result != VK_SUCCESS) return vulkan_error("vkCreateSampler", result);
  return Handle<VkSampler>(gpu.device(), sampler, gpu.vk.vkDestroySampler);
}

/// Moves a result's value into place, or hands on its error.
template <class T>
Result<void> take(Result<T> result, std::optional<T>& place) {
  if (!result) return result.error();
  place.emplace(std::move(result).value());
  return {};
}

class UseDrawing {
 public:
  UseDrawing(const UsePictureDesc& desc, const UseScene& view) : desc_(desc), view_(view) {}

  Result<void> create(const Scene& scene, const Pose& pose) {
    auto gpu = GpuContext::create(desc_.device, desc_.validate);
    if (!gpu) return gpu.error();
    gpu_ = std::move(*gpu);
    if (auto made = take(TextureTable::create(*gpu_, scene), textures_); !made) return made;
    LayeredArrays arrays = layered_arrays(scene, pose, &*textures_);
    if (desc_.use == LayeredUse::reflection_cube) {
      data_.ball = mirror_ball(view_);
      data_.ball_index = static_cast<uint32_t>(arrays.materials.size());
      const Primitive ball = ball_primitive(glm::vec3(data_.ball), data_.ball.w);
      arrays.meshes.push_back(layered_mesh(ball, Material{}, ball.positions, {}));
      arrays.instances.push_back(
          {.mesh = static_cast<uint32_t>(arrays.meshes.size() - 1), .host_index = data_.ball_index});
    }
    if (auto made = take(arrays.create(gpu_->headless().desc()), scene_); !made) return made;
    return create_materials(scene, arrays);
  }

  /// One pass of the writer over views into new images.
  Result<LayerImages> draw(const std::vector<glm::mat4>& matrices, LayerImagesDesc images_desc) {
    const bool has_color = images_desc.color_format != VK_FORMAT_UNDEFINED;
    const bool is_atlas = desc_.writer == umbrage::LayeredWriter::atlas;
    images_desc.layers = static_cast<uint32_t>(matrices.size());
    auto images = LayerImages::create(*gpu_, images_desc);
    if (!images) return images.error();
    umbrage::LayeredPassSettings settings{.writer = desc_.writer,
                                          .views = images_desc.layers,
                                          .selection = umbrage::CasterSelection::each_view,
                                          .cull_frustum = true,
                                          .areas = is_atlas};
    // Colour is not for the compute writer.
    if (has_color && desc_.writer == umbrage::LayeredWriter::compute)
      settings.writer = umbrage::LayeredWriter::traditional;
    if (has_color) {
      settings.color_fragment = kShadeUse;
      settings.color_format = images_desc.color_format;
      settings.color_set_layout = set_->layout();
    }
    auto target = umbrage::LayeredTarget::create(*scene_, images->target());
    if (!target) return target.error();
    auto pass = umbrage::LayeredPass::create(*scene_, settings);
    if (!pass) return pass.error();
    std::vector<umbrage::LayeredView> views;
    for (uint32_t i = 0; i < matrices.size(); ++i) views.push_back({.clip_from_world = mat4(matrices[i]), .layer = i});
    if (auto begun = scene_->begin_frame(++serial_); !begun) return begun.error();
    auto commands = gpu_->begin();
    if (!commands) return commands.error();
    scene_->record(*commands);
    const umbrage::LayeredPass::Inputs inputs{.target = *target,
                                              .views = views,
                                              .clear_color = {.float32 = {0.45f, 0.55f, 0.7f, 1}},
                                              .color_set = has_color ? set_->get() : VK_NULL_HANDLE,
                                              .host_data = data_buffer_.address()};
    if (auto prepared = pass->prepare(inputs); !prepared) return prepared.error();
    pass->record(*commands);
    if (auto done = gpu_->submit_and_wait(); !done) return done.error();
    splits_ = pass->splits();
    return images;
  }

  Result<void> draw_sun() {
    const glm::mat4 matrix = sun_matrix(view_, kSunDirection);
    if (auto drawn = take(draw({matrix}, {.width = kSunSide, .height = kSunSide}), sun_); !drawn) return drawn;
    data_.sun_from_world = matrix;
    data_.to_sun = glm::vec4(-glm::normalize(kSunDirection), glm::length(view_.highest - view_.lowest));
    return show(*sun_, VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_ASPECT_DEPTH_BIT, 0, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
  }
  /// The reflection cube map for the mirror ball.
  Result<void> use_reflection(LayerImages&& cube) {
    reflection_.emplace(std::move(cube));
    return show(*reflection_, VK_IMAGE_VIEW_TYPE_CUBE, VK_IMAGE_ASPECT_COLOR_BIT, 1,
                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
  void set_eyes(const std::vector<glm::mat4>& views_from_world) {
    for (size_t i = 0; i < std::min<size_t>(views_from_world.size(), 6); ++i)
      data_.eyes[i] = glm::inverse(views_from_world[i])[3];
  }
  void flush() { data_buffer_.write(std::span<const UseData>(&data_, 1)); }
  GpuContext& gpu() { return *gpu_; }
  uint32_t splits() const { return splits_; }

 private:
  Result<void> create_materials(const Scene& scene, const LayeredArrays& arrays) {
    std::vector<UseMaterial> materials;
    for (const uint32_t index : arrays.materials) {
      const Material& material = scene.materials[index];
      materials.push_back({.base_color = material.base_color,
                           .texture_slot = material.base_color_texture.image < 0
                                               ? kNone
                                               : textures_->slot(material.base_color_texture, ColorSpace::srgb),
                           .alpha_cutoff = material.alpha_mode == AlphaMode::mask ? material.alpha_cutoff : 0});
    }
    auto uploaded = gpu_->upload(std::as_bytes(std::span(materials)), "use materials");
    if (!uploaded) return uploaded.error();
    materials_ = std::move(*uploaded);
    data_.materials = materials_.address();
    auto buffer = gpu_->create_buffer(sizeof(UseData), Memory::upload, "use data");
    if (!buffer) return buffer.error();
    data_buffer_ = std::move(*buffer);
    if (auto made = take(make_sampler(*gpu_, true), compare_sampler_); !made) return made;
    if (auto made = take(make_sampler(*gpu_, false), linear_sampler_); !made) return made;
    const auto slots = static_cast<uint32_t>(textures_->size());
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, std::max(slots, 1u), VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}};
    if (auto made = take(DescriptorSet::create(*gpu_, bindings), set_); !made) return made;
    for (uint32_t i = 0; i < slots; ++i)
      set_->write_image(*gpu_, 2, i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                        {textures_->sampler(i), textures_->view(i), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    return {};
  }
  Result<void> show(const LayerImages& images, VkImageViewType type, VkImageAspectFlags aspect, uint32_t binding,
                    VkImageLayout layout) {
    auto view = images.view(*gpu_, type, aspect);
    if (!view) return view.error();
    auto commands = gpu_->begin();
    if (!commands) return commands.error();
    images.end_drawing(*gpu_, *commands);
    if (auto done = gpu_->submit_and_wait(); !done) return done.error();
    const auto& sampler = binding == 0 ? compare_sampler_ : linear_sampler_;
    set_->write_image(*gpu_, binding, 0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                      {sampler->get(), view->get(), layout});
    views_.push_back(std::move(*view));
    return {};
  }

  const UsePictureDesc& desc_;
  const UseScene& view_;
  std::unique_ptr<GpuContext> gpu_;  // destroyed last
  std::optional<TextureTable> textures_;
  std::optional<umbrage::LayeredScene> scene_;
  std::optional<Handle<VkSampler>> compare_sampler_, linear_sampler_;
  std::optional<DescriptorSet> set_;
  std::optional<LayerImages> sun_, reflection_;
  std::vector<Handle<VkImageView>> views_;
  DeviceBuffer materials_, data_buffer_;
  UseData data_;
  uint64_t serial_ = 0;
  uint32_t splits_ = 0;
};

/// Depth as grey, each layer stretched to what it holds: near is bright, what nothing covers is blue.
std::vector<uint8_t> depth_picture(const std::vector<float>& depths, size_t layer_texels, bool is_perspective) {
  std::vector<uint8_t> rgba(depths.size() * 4, 255);
  const auto shown = [&](float depth) { return is_perspective ? std::log(std::max(1 - depth, 1e-5f)) : -depth; };
  for (size_t first = 0; first < depths.size(); first += layer_texels) {
    float lo = std::numeric_limits<float>::max(), hi = -lo;
    for (size_t i = first; i < first + layer_texels; ++i)
      if (depths[i] < 1) lo = std::min(lo, shown(depths[i])), hi = std::max(hi, shown(depths[i]));
    for (size_t i = first; i < first + layer_texels; ++i) {
      const float grey = depths[i] < 1 ? 40 + 215 * (shown(depths[i]) - lo) / std::max(hi - lo, 1e-6f) : 0;
      rgba[4 * i] = rgba[4 * i + 1] = static_cast<uint8_t>(depths[i] < 1 ? grey : 18);
      rgba[4 * i + 2] = static_cast<uint8_t>(depths[i] < 1 ? grey : 48);
    }
  }
  return rgba;
}

/// Layers side by side, `columns` a row.
void add_sheet(UsePicture& picture, const std::vector<uint8_t>& layers, uint32_t width, uint32_t height,
               uint32_t columns) {
  const auto count = static_cast<uint32_t>(layers.size() / (size_t{4} * width * height));
  const uint32_t rows = (count + columns - 1) / columns, top = picture.height;
  const uint32_t sheet_width = std::max(picture.width, columns * width);
  picture.width = sheet_width;
  picture.height += rows * height;
  picture.rgba.resize(size_t{4} * sheet_width * picture.height, 255);
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t y = 0; y < height; ++y)
      std::memcpy(&picture.rgba[4 * ((size_t{top} + i / columns * height + y) * sheet_width + i % columns * width)],
                  &layers[4 * ((size_t{i} * height + y) * width)], size_t{4} * width);
}

std::vector<uint8_t> as_bytes(const std::vector<std::byte>& bytes) {
  std::vector<uint8_t> out(bytes.size());
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

}  // namespace

Result<UsePicture> draw_use(const Scene& scene, const Pose& pose, const UseScene& view, const UsePictureDesc& desc) {
  const LayeredUseInfo& info = layered_uses()[static_cast<size_t>(desc.use)];
  UseDrawing drawing(desc, view);
  if (auto made = drawing.create(scene, pose); !made) return made.error();
  if (info.has_color)
    if (auto drawn = drawing.draw_sun(); !drawn) return drawn.error();
  const std::vector<glm::mat4> matrices = use_matrices(desc.use, view);
  const bool is_cube =
      desc.use == LayeredUse::cube || desc.use == LayeredUse::cube_array || desc.use == LayeredUse::reflection_cube;
  LayerImagesDesc images_desc{.width = is_cube ? desc.height : desc.width,
                              .height = desc.height,
                              .color_format = info.has_color ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_UNDEFINED,
                              .is_cube = is_cube};
  drawing.flush();
  auto images = drawing.draw(matrices, images_desc);
  if (!images) return images.error();
  UsePicture picture{.views = static_cast<uint32_t>(matrices.size()), .splits = drawing.splits()};
  if (!info.has_color) {
    auto depths = images->read_depth(drawing.gpu());
    if (!depths) return depths.error();
    add_sheet(picture, depth_picture(*depths, size_t{images_desc.width} * desc.height, is_cube), images_desc.width,
              desc.height, info.columns);
  } else {
    auto colors = images->read_color(drawing.gpu());
    if (!colors) return colors.error();
    if (desc.use != LayeredUse::reflection_cube) {
      add_sheet(picture, as_bytes(*colors), images_desc.width, desc.height, info.columns);
    } else {
      // The faces are for the ball in the camera's picture.
      if (auto used = drawing.use_reflection(std::move(*images)); !used) return used.error();
      drawing.set_eyes({view.view_from_world});
      drawing.flush();
      const std::vector<glm::mat4> camera{use_matrices(LayeredUse::reflection, view)[0]};
      auto main =
          drawing.draw(camera, {.width = desc.width, .height = desc.height, .color_format = VK_FORMAT_R8G8B8A8_SRGB});
      if (!main) return main.error();
      auto shown = main->read_color(drawing.gpu());
      if (!shown) return shown.error();
      add_sheet(picture, as_bytes(*shown), desc.width, desc.height, 1);
    }
  }
  if (desc.validate && drawing.gpu().validation_messages() > 0)
    return umbrage::Error{umbrage::ErrorCode::vulkan,
                          "the validation layers reported " + std::to_string(drawing.gpu().validation_messages()) +
                              " messages, listed above; this is a fault of umbrage, please report it"};
  return picture;
}

}  // namespace app
