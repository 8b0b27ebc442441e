// Images, their use as textures, and materials: the part of a scene that says what surfaces look like.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace app {

/// 8-bit RGBA, row 0 at the top, tightly packed.
struct Image {
  std::string name;
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

enum class Wrap : uint8_t { repeat, clamp, mirror };

/// A use of an image. Texture coordinates are transformed as uv' = uv_transform · (u, v, 1) (KHR_texture_transform).
struct Texture {
  int image = -1;       ///< Into Scene::images; -1 = none.
  uint32_t uv_set = 0;  ///< 0 or 1.
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;
  glm::mat3x2 uv_transform{1, 0, 0, 1, 0, 0};  ///< Columns: images of u, v and 1.
};

enum class AlphaMode : uint8_t { opaque, mask, blend };

struct Material {
  std::string name;
  glm::vec4 base_color{1};     ///< Linear.
  Texture base_color_texture;  ///< sRGB-encoded.
  float metallic = 1, roughness = 1;
  Texture metallic_roughness_texture;  ///< Linear: G roughness, B metallic.
  Texture normal_texture;
  float normal_scale = 1;
  glm::vec3 emissive{0};     ///< Linear, KHR_materials_emissive_strength multiplied in.
  Texture emissive_texture;  ///< sRGB-encoded.
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool casts_shadow = true;  ///< A sky around the scene would leave a sun no way in.
  bool unlit = false;        ///< KHR_materials_unlit.
};

}  // namespace app
