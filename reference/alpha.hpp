// The alpha that glTF's MASK mode tests, at one point of a triangle.
#pragma once
#include <cstdint>

#include "import/scene.hpp"

namespace reference {

/// alpha of the finest level at uv (before the texture's own transform), wrapped and filtered as the sampler says. 1
/// where uv is not finite or too large to address. Precondition: the image has width × height × 4 bytes, neither side
/// 0.
float sample_alpha(const app::Texture&, const app::Image&, glm::vec2 uv);

/// Alpha of the material at barycentric (u, v) of a triangle: weights 1−u−v, u, v of its three vertices.
/// image: of material.base_color_texture, or nullptr.
float surface_alpha(const app::Primitive&, const app::Material&, const app::Image* image, uint32_t triangle, float u,
                    float v);

}  // namespace reference
