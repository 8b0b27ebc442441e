// Meshes of a glTF file as triangle lists.
#pragma once
#include <vector>

#include "import/gltf_accessors.hpp"
#include "import/gltf_materials.hpp"

namespace app::gltf {

std::vector<Mesh> import_meshes(const Model&, Accessors&, const std::vector<UvSets>& uv_sets);

}  // namespace app::gltf
