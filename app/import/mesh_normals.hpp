// Normals for primitives whose file has none, or has some of no length.
#pragma once
#include "import/scene.hpp"

namespace app {

/// Gives every triangle vertices of its own with the triangle's normal, as glTF asks for where normals are missing.
/// Tangents go.
void make_flat_normals(Primitive&);
/// Unit length for all normals; those of no length become that of the triangles around the vertex.
void mend_normals(Primitive&);

}  // namespace app
