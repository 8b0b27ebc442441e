#include "reference/camera_rays.hpp"

#include <cmath>
#include <limits>

namespace reference {

std::vector<Ray> camera_rays(const app::Camera& lens, const glm::mat4& world_from_camera, uint32_t width,
                             uint32_t height) {
  const float half_height = lens.orthographic ? lens.half_height : std::tan(0.5f * lens.fov_y);
  const float aspect = lens.aspect > 0 ? lens.aspect : float(width) / float(height);
  const float half_width = lens.orthographic ? lens.half_width : half_height * aspect;
  std::vector<Ray> rays;
  rays.reserve(size_t(width) * height);
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      // Both kinds of lens: the depth along -Z grows by one per unit of distance, so near and far are depths.
      const float right = (2 * (float(x) + 0.5f) / float(width) - 1) * half_width;
      const float up = (1 - 2 * (float(y) + 0.5f) / float(height)) * half_height;
      const glm::vec3 origin = lens.orthographic ? glm::vec3(right, up, 0) : glm::vec3(0);
      const glm::vec3 direction = lens.orthographic ? glm::vec3(0, 0, -1) : glm::vec3(right, up, -1);
      rays.push_back({glm::vec3(world_from_camera * glm::vec4(origin, 1)), glm::mat3(world_from_camera) * direction,
                      lens.near, lens.far});
    }
  }
  return rays;
}

Gbuffer trace_gbuffer(const RayTracer& tracer, const app::Camera& lens, const glm::mat4& world_from_camera,
                      uint32_t width, uint32_t height) {
  const std::vector<Ray> rays = camera_rays(lens, world_from_camera, width, height);
  std::vector<Hit> hits(rays.size());
  tracer.closest_hits(rays, Faces::as_drawn, hits);
  Gbuffer result{width, height, std::vector<float>(3 * rays.size(), std::numeric_limits<float>::quiet_NaN()),
                 std::vector<float>(3 * rays.size(), 0.0f)};
  for (size_t i = 0; i < hits.size(); ++i) {
    if (!std::isfinite(hits[i].distance)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      result.positions[3 * i + size_t(axis)] = hits[i].position[axis];
      result.normals[3 * i + size_t(axis)] = hits[i].normal[axis];
    }
  }
  return result;
}

}  // namespace reference
