// The node hierarchy of the scene shown, and what hangs on its nodes.
#pragma once
#include <vector>

#include "import/gltf_accessors.hpp"
#include "import/scene.hpp"

namespace app::gltf {

/// Per node of the file its index in Scene::nodes; -1: not in the scene shown.
using NodeMap = std::vector<int>;

/// Cameras and lights in file order.
std::vector<Camera> import_cameras(const Model&);
std::vector<Light> import_lights(const Model&);

/// Fills name, nodes and skins. Meshes, cameras and lights must be in the scene already: nodes are checked against
/// them. Refused: cycles, nodes with two parents, references to nothing, skins whose joints are not in the scene shown.
NodeMap import_nodes(const Model&, Accessors&, Scene&);

}  // namespace app::gltf
