#include "reference/alpha.hpp"

#include <cmath>

namespace reference {
namespace {

constexpr float largest_texel = 1e9f;  // beyond it texel numbers leave 32-bit integers

uint32_t wrap(app::Wrap mode, int64_t texel, uint32_t size) {
  const int64_t n = size;
  switch (mode) {
    case app::Wrap::clamp:
      return static_cast<uint32_t>(texel < 0 ? 0 : texel >= n ? n - 1 : texel);
    case app::Wrap::mirror: {
      const int64_t period = ((texel % (2 * n)) + 2 * n) % (2 * n);
      return static_cast<uint32_t>(period < n ? period : 2 * n - 1 - period);
    }
    case app::Wrap::repeat:
      break;
  }
  return static_cast<uint32_t>(((texel % n) + n) % n);
}

template <class Element>
Element interpolate(const std::vector<Element>& values, const app::Primitive& primitive, uint32_t triangle, float u,
                    float v) {
  const uint32_t* corner = &primitive.indices[3 * size_t(triangle)];
  return values[corner[0]] * (1 - u - v) + values[corner[1]] * u + values[corner[2]] * v;
}

}  // namespace

float sample_alpha(const app::Texture& texture, const app::Image& image, glm::vec2 uv) {
  const glm::vec2 transformed = texture.uv_transform * glm::vec3(uv, 1);
  const glm::vec2 texel = transformed * glm::vec2(image.width, image.height);
  if (!(std::abs(texel.x) < largest_texel && std::abs(texel.y) < largest_texel)) return 1;
  const auto alpha = [&](int64_t x, int64_t y) {
    const size_t row = wrap(texture.wrap_v, y, image.height), column = wrap(texture.wrap_u, x, image.width);
    return float(image.rgba[4 * (row * image.width + column) + 3]) / 255;
  };
  if (texture.nearest) return alpha(int64_t(std::floor(texel.x)), int64_t(std::floor(texel.y)));
  const glm::vec2 corner = glm::floor(texel - 0.5f);
  const glm::vec2 weight = texel - 0.5f - corner;
  const int64_t x = int64_t(corner.x), y = int64_t(corner.y);
  const float top = glm::mix(alpha(x, y), alpha(x + 1, y), weight.x);
  const float bottom = glm::mix(alpha(x, y + 1), alpha(x + 1, y + 1), weight.x);
  return glm::mix(top, bottom, weight.y);
}

float surface_alpha(const app::Primitive& primitive, const app::Material& material, const app::Image* image,
                    uint32_t triangle, float u, float v) {
  float alpha = material.base_color.a;
  if (image) {
    const std::vector<glm::vec2>& coordinates = primitive.uv[material.base_color_texture.uv_set];
    const glm::vec2 uv = coordinates.empty() ? glm::vec2(0) : interpolate(coordinates, primitive, triangle, u, v);
    alpha *= sample_alpha(material.base_color_texture, *image, uv);
  }
  if (!primitive.colors.empty()) alpha *= interpolate(primitive.colors, primitive, triangle, u, v).a;
  return alpha;
}

}  // namespace reference
