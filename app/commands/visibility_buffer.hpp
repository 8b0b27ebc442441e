// A small software depth buffer: which surfaces a camera of the scene sees, to put random lights over them.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "commands/surfaces.hpp"
#include "import/scene.hpp"

namespace app {

/// A seen point of a surface.
struct SurfacePoint {
  glm::vec3 position{0};
  glm::vec3 normal{0, 1, 0};  ///< Of the triangle, unit, on the viewer's side.
  float area = 0;             ///< Of the surface that the sample stands for, square metres.
  float depth = 0;            ///< Along the camera's axis.
};

class VisibilityBuffer {
 public:
  static constexpr uint32_t kWidth = 320, kHeight = 180;

  explicit VisibilityBuffer(const PosedCamera& camera);

  /// Draws both sides of its triangles. Blended materials are left out, masked texels as their alpha says.
  void draw(const Scene& scene, const PosedPrimitive& posed);

  /// What is seen at a pixel's centre; nothing for the background.
  std::optional<SurfacePoint> at(uint32_t x, uint32_t y) const;
  /// True when the point lies in the picture and in front of everything drawn there.
  bool sees(const glm::vec3& position_ws) const;
  glm::vec3 toward_camera(const glm::vec3& position_ws) const;

 private:
  struct Vertex {
    glm::dvec3 position{0};  // Camera space, looking along -z.
    glm::dvec2 uv{0};
  };
  struct Projected {
    double x = 0, y = 0;  // Pixels.
    double q = 1;         // Linear over the picture: 1/depth, or 1 when orthographic.
    double depth_q = 0;   // depth · q, likewise linear.
    glm::dvec2 uv_q{0};
  };
  /// Nearer is larger and the value is linear over the picture.
  double depth_key(double depth) const { return camera_.lens.orthographic ? -depth : 1.0 / depth; }
  Projected project(const Vertex& vertex) const;
  void draw_triangle(const Vertex (&triangle)[3], const Scene& scene, const Material& material);
  void fill(const Projected (&corner)[3], const glm::vec3& normal, const Scene& scene, const Material& material);
  /// Points of the pixel's ray: camera space, at this depth.
  glm::dvec3 unproject(double x, double y, double depth) const;

  PosedCamera camera_;
  glm::dmat4 camera_from_world_;
  double half_width_, half_height_;  // Of the picture: at depth 1, or in metres when orthographic.
  std::vector<double> keys_;         // depth_key per pixel.
  std::vector<glm::vec3> normals_;
};

}  // namespace app
