// Materials of a glTF file and the texture coordinate sets that they read.
#pragma once
#include <array>
#include <vector>

#include "import/gltf_images.hpp"

namespace app::gltf {

/// Which TEXCOORD_n of the file are Primitive::uv[0] and uv[1] of primitives with a material.
using UvSets = std::array<uint32_t, 2>;

struct Materials {
  std::vector<Material> materials;  ///< In file order, and a default one.
  std::vector<UvSets> uv_sets;      ///< Per material.
};

Materials import_materials(const Model&, Images&);

}  // namespace app::gltf
