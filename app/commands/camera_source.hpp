// Where a frame's camera comes from: a path, the command line, the scene, or a framing of the whole scene.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "commands/camera_path.hpp"
#include "commands/surfaces.hpp"
#include "host/renderer.hpp"
#include "import/scene.hpp"
#include "umbrage/result.hpp"

namespace app {

struct CameraOptions {
  std::string name_or_index;  ///< Of the scene's; empty = the first, else one that frames the scene.
  std::optional<glm::vec3> eye, target;
  std::optional<float> fov_y;  ///< Radians; replaces that of whatever camera there is.
  std::optional<CameraPath> path;
};

/// A camera at eye that looks at target with +Y up (where that is the line of sight, -Z). Precondition: eye != target.
glm::mat4 look_at(const glm::vec3& eye, const glm::vec3& target);

class CameraSource {
 public:
  /// pose: the scene at any time. Errors: no such camera (the message lists them).
  static umbrage::Result<CameraSource> create(const CameraOptions& options, const Pose& pose, const Box& bounds,
                                              float picture_aspect);
  ViewCamera at(const Pose& pose, double time_s) const;

 private:
  std::optional<CameraPath> path_;
  std::optional<size_t> scene_camera_;  // Into Pose::cameras.
  std::optional<float> fov_y_;
  ViewCamera fixed_;  // Without a path and a scene's camera; its lens serves the path too.
};

}  // namespace app
