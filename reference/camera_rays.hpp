// What a camera sees, by rays: a G-buffer to hold the renderer's against, or to trace shadows for without a renderer.
#pragma once
#include <vector>

#include "reference/ray_tracer.hpp"

namespace reference {

struct Gbuffer {
  uint32_t width = 0, height = 0;
  std::vector<float> positions, normals;  ///< As SurfaceImage; normals are 0 where nothing is.
  SurfaceImage view() const { return {width, height, positions, normals}; }
};

/// One ray through each pixel's centre, row 0 at the top, from the near plane to the far plane of the lens.
/// world_from_camera is rigid; the camera looks along -Z. An aspect of 0 is that of the picture.
std::vector<Ray> camera_rays(const app::Camera& lens, const glm::mat4& world_from_camera, uint32_t width,
                             uint32_t height);

/// Nearest hits of camera_rays; back faces of single-sided materials are not there.
Gbuffer trace_gbuffer(const RayTracer&, const app::Camera& lens, const glm::mat4& world_from_camera, uint32_t width,
                      uint32_t height);

}  // namespace reference
