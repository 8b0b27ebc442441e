// Cameras and KHR_lights_punctual.
#include <algorithm>
#include <cmath>

#include "import/gltf_fault.hpp"
#include "import/gltf_nodes.hpp"

namespace app::gltf {
namespace {

/// glTF recommends angles below π and its validator warns only; a picture needs one.
constexpr float max_fov_y = 3.1f;

float positive(double value, const std::string& where) {
  const float number = finite_float(value, where);
  if (number <= 0) refuse(where, ": must be greater than 0");
  return number;
}

Camera import_perspective(const tinygltf::PerspectiveCamera& source, const std::string& where) {
  Camera camera;
  camera.fov_y = std::min(positive(source.yfov, where + ".yfov"), max_fov_y);
  camera.aspect = source.aspectRatio == 0 ? 0 : positive(source.aspectRatio, where + ".aspectRatio");
  camera.near = positive(source.znear, where + ".znear");
  if (source.zfar != 0) camera.far = positive(source.zfar, where + ".zfar");
  return camera;
}

Camera import_orthographic(const tinygltf::OrthographicCamera& source, const std::string& where) {
  Camera camera{.orthographic = true};
  camera.half_width = positive(std::abs(source.xmag), where + ".xmag");
  camera.half_height = positive(std::abs(source.ymag), where + ".ymag");
  camera.near = finite_float(source.znear, where + ".znear");
  camera.far = finite_float(source.zfar, where + ".zfar");
  if (camera.near < 0) refuse(where, ".znear: must not be negative");
  return camera;
}

Light import_light(const tinygltf::Light& source, const std::string& where) {
  Light light{.name = source.name};
  if (source.type == "spot") {
    light.kind = LightKind::spot;
  } else if (source.type == "directional") {
    light.kind = LightKind::directional;
  } else if (source.type != "point") {
    refuse(where, ".type: must be point, spot or directional");
  }
  for (size_t c = 0; c < source.color.size(); ++c) {
    light.color[static_cast<int>(c)] = finite_float(source.color[c], where + ".color");
    if (source.color[c] < 0) refuse(where, ".color: must not be negative");
  }
  light.intensity = finite_float(source.intensity, where + ".intensity");
  if (light.intensity < 0) refuse(where, ".intensity: must not be negative");
  if (source.range != 0) light.range = positive(source.range, where + ".range");
  if (light.kind == LightKind::spot) {
    light.inner_cone = finite_float(source.spot.innerConeAngle, where + ".spot.innerConeAngle");
    light.outer_cone = finite_float(source.spot.outerConeAngle, where + ".spot.outerConeAngle");
    constexpr float right_angle = 1.5707964f;
    if (light.inner_cone < 0 || light.inner_cone >= light.outer_cone || light.outer_cone > right_angle) {
      refuse(where, ".spot: cone angles ", light.inner_cone, " and ", light.outer_cone,
             " must grow from 0 to at most a right angle, the inner below the outer");
    }
  }
  return light;
}

}  // namespace

std::vector<Camera> import_cameras(const Model& model) {
  std::vector<Camera> cameras;
  for (size_t i = 0; i < model.parsed.cameras.size(); ++i) {
    const tinygltf::Camera& source = model.parsed.cameras[i];
    const std::string where = place("cameras", i);
    cameras.push_back(source.type == "perspective" ? import_perspective(source.perspective, where + ".perspective")
                                                   : import_orthographic(source.orthographic, where + ".orthographic"));
    if (cameras.back().far <= cameras.back().near) refuse(where, ": zfar must be greater than znear");
    cameras.back().name = source.name;
  }
  return cameras;
}

std::vector<Light> import_lights(const Model& model) {
  std::vector<Light> lights;
  for (size_t i = 0; i < model.parsed.lights.size(); ++i) {
    lights.push_back(import_light(model.parsed.lights[i], place("extensions.KHR_lights_punctual.lights", i)));
  }
  return lights;
}

}  // namespace app::gltf
