// Where a frame's camera comes from.
#include "commands/camera_source.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "commands/parse.hpp"

namespace app {
namespace {

using umbrage::Result;

Result<size_t> find_camera(const std::string& name_or_index, const Pose& pose) {
  for (size_t i = 0; i < pose.cameras.size(); ++i)
    if (pose.cameras[i].name == name_or_index) return i;
  const auto index = parse_count(name_or_index, 0, UINT32_MAX);
  if (index && *index < pose.cameras.size()) return static_cast<size_t>(*index);
  if (pose.cameras.empty()) return invalid("--camera: the scene has no cameras; use --eye and --target");
  std::vector<std::string> names;
  for (size_t i = 0; i < pose.cameras.size(); ++i) {
    const std::string& name = pose.cameras[i].name;
    names.push_back(std::to_string(i) + (name.empty() ? "" : " (" + name + ")"));
  }
  return invalid("--camera: the scene has no camera \"" + name_or_index + "\"; it has " + join_names(names));
}

/// Everything inside the box is in the picture, seen from the front, the right and above.
glm::mat4 framing(const Box& bounds, float fov_y, float aspect) {
  const float half_fov = std::min(0.5f * fov_y, std::atan(std::tan(0.5f * fov_y) * aspect));
  const float radius = std::max(0.5f * bounds.diagonal(), 1e-3f);
  const glm::vec3 direction = glm::normalize(glm::vec3(0.6f, 0.45f, 1.0f));
  const glm::vec3 target = bounds.center();
  return look_at(target + direction * (radius / std::sin(half_fov)), target);
}

}  // namespace

glm::mat4 look_at(const glm::vec3& eye, const glm::vec3& target) {
  const glm::vec3 back = glm::normalize(eye - target);
  const glm::vec3 up = std::abs(back.y) > 0.9999f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(up, back));
  return {glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0), glm::vec4(eye, 1)};
}

Result<CameraSource> CameraSource::create(const CameraOptions& options, const Pose& pose, const Box& bounds,
                                          float picture_aspect) {
  CameraSource source;
  source.fov_y_ = options.fov_y;
  source.path_ = options.path;
  Camera& lens = source.fixed_.lens;
  lens.fov_y = options.fov_y.value_or(kDefaultFovY);
  lens.near = std::clamp(1e-3f * bounds.diagonal(), 1e-6f, 0.1f);
  if (options.path) return source;
  if (options.eye) {
    source.fixed_.world_from_camera = look_at(*options.eye, *options.target);
    return source;
  }
  if (!options.name_or_index.empty()) {
    const auto index = find_camera(options.name_or_index, pose);
    if (!index) return index.error();
    source.scene_camera_ = *index;
  } else if (!pose.cameras.empty()) {
    source.scene_camera_ = 0;
  } else {
    source.fixed_.world_from_camera = framing(bounds, lens.fov_y, picture_aspect);
  }
  return source;
}

ViewCamera CameraSource::at(const Pose& pose, double time_s) const {
  ViewCamera camera = fixed_;
  if (path_) {
    const CameraKey key = path_->at(time_s);
    camera.lens.fov_y = key.fov_y;
    // A path may pass through its target for an instant.
    const glm::vec3 target = key.eye == key.target ? key.eye - glm::vec3(0, 0, 1) : key.target;
    camera.world_from_camera = look_at(key.eye, target);
  } else if (scene_camera_) {
    camera = {pose.cameras[*scene_camera_].lens, pose.cameras[*scene_camera_].world_from_camera};
  }
  if (fov_y_) camera.lens.fov_y = *fov_y_;
  return camera;
}

}  // namespace app
