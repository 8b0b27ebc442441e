// Boxes around parts of a primitive, where one around all of it would mostly hold air.
#pragma once
#include <vector>

#include "import/scene.hpp"

namespace app {

struct MeshBox {
  glm::vec3 lowest{0}, highest{0};  ///< Mesh space.
};

/// At most so many, which together hold every triangle.
std::vector<MeshBox> bounding_parts(const Primitive&, size_t most);

}  // namespace app
