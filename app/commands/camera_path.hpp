// The camera path of --path: {"interpolation": "catmull_rom"|"linear", "keys": [{"time": seconds, "eye": [x,y,z],
// "target": [x,y,z], "fov": degrees}]}. Times rise strictly; fov is the vertical angle, 60 when left out.
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "umbrage/result.hpp"

namespace app {

inline constexpr float kDefaultFovY = 1.0471976f;  ///< Radians; 60 degrees.

struct CameraKey {
  double time_s = 0;
  glm::vec3 eye{0}, target{0, 0, -1};
  float fov_y = kDefaultFovY;  ///< Radians.
};

enum class PathInterpolation : uint8_t {
  linear,
  catmull_rom,  ///< Cubic with tangents from the neighbouring keys, for uneven times as well; the default.
};

struct CameraPath {
  PathInterpolation interpolation = PathInterpolation::catmull_rom;
  std::vector<CameraKey> keys;  ///< At least one.

  /// Before the first key and after the last one the camera rests there.
  CameraKey at(double time_s) const;
};

/// Errors name the place. At most 64 MiB.
umbrage::Result<CameraPath> read_camera_path(const std::filesystem::path& path);

}  // namespace app
