// Flat normals and mending of normals.
#include "import/mesh_normals.hpp"

#include <cmath>
#include <cstddef>

namespace app {
namespace {

/// In double: products of large coordinates overflow floats, those of small ones vanish.
glm::dvec3 area_normal(const Primitive& primitive, size_t first_index) {
  const glm::dvec3 a = primitive.positions[primitive.indices[first_index]];
  const glm::dvec3 b = primitive.positions[primitive.indices[first_index + 1]];
  const glm::dvec3 c = primitive.positions[primitive.indices[first_index + 2]];
  return glm::cross(b - a, c - a);
}

/// Triangles without area have no normal of their own: any serves, they are never seen.
glm::vec3 unit_or_up(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0, 0, 1);
}

template <class T>
void gather(std::vector<T>& array, const std::vector<uint32_t>& indices) {
  if (array.empty()) return;
  std::vector<T> gathered(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) gathered[i] = array[indices[i]];
  array = std::move(gathered);
}

}  // namespace

void make_flat_normals(Primitive& primitive) {
  std::vector<glm::vec3> normals(primitive.indices.size());
  for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    normals[i] = normals[i + 1] = normals[i + 2] = unit_or_up(area_normal(primitive, i));
  }
  gather(primitive.positions, primitive.indices);
  for (auto& uv : primitive.uv) gather(uv, primitive.indices);
  gather(primitive.colors, primitive.indices);
  gather(primitive.joints, primitive.indices);
  gather(primitive.weights, primitive.indices);
  for (MorphTarget& target : primitive.targets) {
    gather(target.positions, primitive.indices);
    target.normals.clear();
  }
  primitive.normals = std::move(normals);
  primitive.tangents.clear();
  for (size_t i = 0; i < primitive.indices.size(); ++i) primitive.indices[i] = static_cast<uint32_t>(i);
}

void mend_normals(Primitive& primitive) {
  bool all_good = true;
  std::vector<glm::dvec3> mended;
  for (glm::vec3& normal : primitive.normals) {
    const double length = glm::length(glm::dvec3(normal));
    if (length > 0) {
      normal = glm::vec3(glm::dvec3(normal) / length);
    } else {
      all_good = false;
    }
  }
  if (all_good) return;
  mended.resize(primitive.normals.size());
  for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    const glm::dvec3 normal = area_normal(primitive, i);
    for (size_t k = 0; k < 3; ++k) mended[primitive.indices[i + k]] += normal;
  }
  for (size_t v = 0; v < mended.size(); ++v) {
    if (primitive.normals[v] == glm::vec3(0)) primitive.normals[v] = unit_or_up(mended[v]);
  }
}

}  // namespace app
