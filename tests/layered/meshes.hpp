// Closed meshes with known fronts, and views around them.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/layered_geometry.hpp"

namespace umbrage::test {

/// A torus around y: closed, fronts outside. Normals and uvs too.
app::LayeredArrays::Mesh torus(float radius, float tube, uint32_t around, uint32_t across);
/// A square in the xz plane, facing up.
app::LayeredArrays::Mesh square(float half_side);

/// Perspective views from points on a sphere towards the origin; view i of layer i.
std::vector<LayeredView> views_around(uint32_t count, float distance);
/// Six faces of a cube map.
std::vector<LayeredView> cube_views(const glm::vec3& from, float near, float far);

}  // namespace umbrage::test
