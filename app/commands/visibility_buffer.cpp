// A small software depth buffer.
#include "commands/visibility_buffer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {
namespace {

constexpr double kBackground = std::numeric_limits<double>::lowest();
constexpr double kDefaultAspect = 16.0 / 9.0;

int wrapped(double coordinate, uint32_t size, Wrap wrap) {
  const double texel = std::floor(coordinate * size);
  if (!std::isfinite(texel)) return 0;
  const double period = wrap == Wrap::mirror ? 2.0 * size : size;
  double local = wrap == Wrap::clamp ? std::clamp(texel, 0.0, size - 1.0) : texel - period * std::floor(texel / period);
  if (local >= size) local = period - 1 - local;  // The mirrored half.
  return std::clamp(static_cast<int>(local), 0, static_cast<int>(size) - 1);
}

/// Alpha at the nearest texel; 1 without a texture.
float sampled_alpha(const Scene& scene, const Texture& texture, const glm::dvec2& uv) {
  if (texture.image < 0) return 1;
  const Image& image = scene.images[static_cast<size_t>(texture.image)];
  if (image.rgba.empty()) return 1;
  const glm::dvec2 at = glm::dmat3x2(texture.uv_transform) * glm::dvec3(uv, 1);
  const int x = wrapped(at.x, image.width, texture.wrap_u), y = wrapped(at.y, image.height, texture.wrap_v);
  const size_t texel = static_cast<size_t>(y) * image.width + static_cast<size_t>(x);
  return static_cast<float>(image.rgba[4 * texel + 3]) / 255.0f;
}

}  // namespace

VisibilityBuffer::VisibilityBuffer(const PosedCamera& camera)
    : camera_(camera),
      camera_from_world_(glm::inverse(glm::dmat4(camera.world_from_camera))),
      keys_(size_t(kWidth) * kHeight, kBackground),
      normals_(keys_.size()) {
  const Camera& lens = camera.lens;
  const double aspect = lens.aspect > 0 ? double(lens.aspect) : kDefaultAspect;
  half_height_ = lens.orthographic ? double(lens.half_height) : std::tan(0.5 * double(lens.fov_y));
  half_width_ = lens.orthographic ? double(lens.half_width) : half_height_ * aspect;
}

void VisibilityBuffer::draw(const Scene& scene, const PosedPrimitive& posed) {
  const Primitive& primitive = *posed.primitive;
  const Material& material = scene.materials[primitive.material];
  if (material.alpha_mode == AlphaMode::blend) return;
  const std::vector<glm::vec2>& uvs = primitive.uv[std::min(material.base_color_texture.uv_set, 1u)];
  for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    Vertex triangle[3];
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint32_t index = primitive.indices[i + corner];
      triangle[corner].position = glm::dvec3(camera_from_world_ * glm::dvec4(glm::dvec3(posed.positions[index]), 1));
      if (!uvs.empty()) triangle[corner].uv = glm::dvec2(uvs[index]);
    }
    draw_triangle(triangle, scene, material);
  }
}

void VisibilityBuffer::draw_triangle(const Vertex (&triangle)[3], const Scene& scene, const Material& material) {
  const double near = std::max(double(camera_.lens.near), 1e-6);
  const glm::dvec3 across =
      glm::cross(triangle[1].position - triangle[0].position, triangle[2].position - triangle[0].position);
  const double twice_area = glm::length(across);
  if (!(twice_area > 0) || !std::isfinite(twice_area)) return;
  glm::dvec3 normal = across / twice_area;
  const glm::dvec3 toward = camera_.lens.orthographic ? glm::dvec3(0, 0, 1) : -triangle[0].position;
  if (glm::dot(normal, toward) < 0) normal = -normal;
  const glm::vec3 normal_ws(glm::dmat3(camera_.world_from_camera) * normal);

  // Cut off what is nearer than the near plane: at most four corners remain.
  Projected kept[4];
  size_t count = 0;
  for (size_t i = 0; i < 3; ++i) {
    const Vertex &from = triangle[i], &to = triangle[(i + 1) % 3];
    const double from_depth = -from.position.z, to_depth = -to.position.z;
    if (from_depth >= near) kept[count++] = project(from);
    if ((from_depth >= near) == (to_depth >= near)) continue;
    const double u = (near - from_depth) / (to_depth - from_depth);
    Vertex cut{glm::mix(from.position, to.position, u), glm::mix(from.uv, to.uv, u)};
    cut.position.z = -near;
    kept[count++] = project(cut);
  }
  for (size_t i = 2; i < count; ++i) fill({kept[0], kept[i - 1], kept[i]}, normal_ws, scene, material);
}

VisibilityBuffer::Projected VisibilityBuffer::project(const Vertex& vertex) const {
  const double depth = -vertex.position.z;
  const double q = camera_.lens.orthographic ? 1.0 : 1.0 / depth;
  return {.x = (0.5 + 0.5 * vertex.position.x * q / half_width_) * kWidth,
          .y = (0.5 - 0.5 * vertex.position.y * q / half_height_) * kHeight,
          .q = q,
          .depth_q = depth * q,
          .uv_q = vertex.uv * q};
}

void VisibilityBuffer::fill(const Projected (&corner)[3], const glm::vec3& normal, const Scene& scene,
                            const Material& material) {
  const Projected &a = corner[0], &b = corner[1], &c = corner[2];
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (!(std::abs(area) > 0) || !std::isfinite(area)) return;
  const auto first = [](double low, uint32_t size) {
    return static_cast<uint32_t>(std::clamp(low, 0.0, double(size)));
  };
  const uint32_t x_begin = first(std::floor(std::min({a.x, b.x, c.x})), kWidth);
  const uint32_t y_begin = first(std::floor(std::min({a.y, b.y, c.y})), kHeight);
  const uint32_t x_end = first(std::ceil(std::max({a.x, b.x, c.x})), kWidth);
  const uint32_t y_end = first(std::ceil(std::max({a.y, b.y, c.y})), kHeight);
  for (uint32_t y = y_begin; y < y_end; ++y) {
    for (uint32_t x = x_begin; x < x_end; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double wb = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
      const double wc = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
      const double wa = 1 - wb - wc;
      if (wa < 0 || wb < 0 || wc < 0) continue;
      const double q = wa * a.q + wb * b.q + wc * c.q;
      const double depth = (wa * a.depth_q + wb * b.depth_q + wc * c.depth_q) / q;
      double& key = keys_[size_t(y) * kWidth + x];
      if (depth_key(depth) <= key || depth > double(camera_.lens.far)) continue;
      if (material.alpha_mode == AlphaMode::mask) {
        const glm::dvec2 uv = (wa * a.uv_q + wb * b.uv_q + wc * c.uv_q) / q;
        if (sampled_alpha(scene, material.base_color_texture, uv) * material.base_color.a < material.alpha_cutoff)
          continue;
      }
      key = depth_key(depth);
      normals_[size_t(y) * kWidth + x] = normal;
    }
  }
}

glm::dvec3 VisibilityBuffer::unproject(double x, double y, double depth) const {
  const double scale = camera_.lens.orthographic ? 1.0 : depth;
  return {(2 * x / kWidth - 1) * half_width_ * scale, (1 - 2 * y / kHeight) * half_height_ * scale, -depth};
}

std::optional<SurfacePoint> VisibilityBuffer::at(uint32_t x, uint32_t y) const {
  const size_t pixel = size_t(y) * kWidth + x;
  const double key = keys_[pixel];
  if (key == kBackground) return std::nullopt;
  const double depth = camera_.lens.orthographic ? -key : 1.0 / key;
  const glm::dvec3 position = unproject(x + 0.5, y + 0.5, depth);
  const glm::vec3 position_ws(glm::dmat4(camera_.world_from_camera) * glm::dvec4(position, 1));
  // The pixel's cross-section there, spread over a tilted surface, but at most tenfold.
  const double scale = camera_.lens.orthographic ? 1.0 : depth;
  const double section = 4 * half_width_ * half_height_ * scale * scale / (double(kWidth) * kHeight);
  const double cosine = std::max(double(glm::dot(normals_[pixel], toward_camera(position_ws))), 0.1);
  return SurfacePoint{position_ws, normals_[pixel], static_cast<float>(section / cosine), static_cast<float>(depth)};
}

bool VisibilityBuffer::sees(const glm::vec3& position_ws) const {
  const Vertex vertex{glm::dvec3(camera_from_world_ * glm::dvec4(glm::dvec3(position_ws), 1)), {}};
  const double depth = -vertex.position.z;
  if (depth <= double(camera_.lens.near)) return false;
  const Projected at = project(vertex);
  if (!(at.x >= 0 && at.x < kWidth && at.y >= 0 && at.y < kHeight)) return false;
  return depth_key(depth) > keys_[static_cast<size_t>(at.y) * kWidth + static_cast<size_t>(at.x)];
}

glm::vec3 VisibilityBuffer::toward_camera(const glm::vec3& position_ws) const {
  if (camera_.lens.orthographic) return glm::normalize(glm::vec3(camera_.world_from_camera[2]));
  return glm::normalize(glm::vec3(camera_.world_from_camera[3]) - position_ws);
}

}  // namespace app
