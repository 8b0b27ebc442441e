// Animations of a glTF file.
#pragma once
#include <vector>

#include "import/gltf_nodes.hpp"

namespace app::gltf {

/// Channels of nodes in the scene shown; animations without any are left out. scene.nodes and scene.meshes must be
/// filled.
std::vector<Animation> import_animations(const Model&, Accessors&, const NodeMap&, const Scene&);

}  // namespace app::gltf
