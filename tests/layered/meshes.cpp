// Test geometry.
#include "meshes.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace umbrage::test {

app::LayeredArrays::Mesh torus(float radius, float tube, uint32_t around, uint32_t across) {
  app::LayeredArrays::Mesh mesh;
  for (uint32_t i = 0; i < around; ++i) {
    for (uint32_t j = 0; j < across; ++j) {
      const float u = glm::two_pi<float>() * float(i) / float(around),
                  v = glm::two_pi<float>() * float(j) / float(across);
      const glm::vec3 ring(std::cos(u), 0, std::sin(u));
      const glm::vec3 normal = ring * std::cos(v) + glm::vec3(0, std::sin(v), 0);
      const glm::vec3 p = ring * radius + normal * tube;
      mesh.positions.push_back({p.x, p.y, p.z});
      mesh.normals.push_back({normal.x, normal.y, normal.z});
      mesh.uvs.push_back({8 * float(i) / float(around), float(j) / float(across)});
      const uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      const uint32_t a = i * across + j, b = i1 * across + j, c = i1 * across + j1, d = i * across + j1;
      for (const uint32_t index : {a, d, b, b, d, c}) mesh.indices.push_back(index);
    }
  }
  mesh.submesh.index_count = static_cast<uint32_t>(mesh.indices.size());
  return mesh;
}

app::LayeredArrays::Mesh square(float s) {
  app::LayeredArrays::Mesh mesh;
  mesh.positions = {{-s, 0, -s}, {-s, 0, s}, {s, 0, s}, {s, 0, -s}};
  mesh.normals.assign(4, {0, 1, 0});
  mesh.uvs = {{0, 0}, {0, 4}, {4, 4}, {4, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.submesh.index_count = 6;
  return mesh;
}

std::vector<LayeredView> views_around(uint32_t count, float distance) {
  std::vector<LayeredView> views;
  for (uint32_t i = 0; i < count; ++i) {
    // A spiral of evenly spread directions.
    const float y = 1 - 2 * (float(i) + 0.5f) / float(count), angle = 2.399963f * float(i), r = std::sqrt(1 - y * y);
    const glm::vec3 eye = distance * glm::vec3(r * std::cos(angle), y, r * std::sin(angle));
    const glm::mat4 matrix = glm::perspectiveRH_ZO(0.8f, 1.0f, 0.1f * distance, 3.0f * distance) *
                             glm::lookAtRH(eye, glm::vec3(0), glm::vec3(0.1f, 1, 0.05f));
    views.push_back({.clip_from_world = app::mat4(matrix), .layer = i});
  }
  return views;
}

std::vector<LayeredView> cube_views(const glm::vec3& from, float near, float far) {
  const glm::vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::vec3 ups[] = {{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};
  std::vector<LayeredView> views;
  for (uint32_t i = 0; i < 6; ++i) {
    const glm::mat4 matrix =
        glm::perspectiveRH_ZO(glm::half_pi<float>(), 1.0f, near, far) * glm::lookAtRH(from, from + axes[i], ups[i]);
    views.push_back({.clip_from_world = app::mat4(matrix), .layer = i});
  }
  return views;
}

}  // namespace umbrage::test
