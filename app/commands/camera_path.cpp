// The camera path of --path.
#include "commands/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "commands/json_file.hpp"

namespace app {
namespace {

using umbrage::Result;

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kMinFovDeg = 1, kMaxFovDeg = 170;

/// What is interpolated, as one vector.
struct Sample {
  glm::dvec3 eye, target;
  double fov_y;
};

Sample sample(const CameraKey& key) { return {glm::dvec3(key.eye), glm::dvec3(key.target), double(key.fov_y)}; }

Sample combine(double a, const Sample& x, double b, const Sample& y) {
  return {a * x.eye + b * y.eye, a * x.target + b * y.target, a * x.fov_y + b * y.fov_y};
}

/// Change per second at a key, from the keys around it.
Sample slope(const std::vector<CameraKey>& keys, size_t i) {
  const CameraKey& before = keys[i == 0 ? 0 : i - 1];
  const CameraKey& after = keys[std::min(i + 1, keys.size() - 1)];
  const double scale = 1.0 / (after.time_s - before.time_s);
  return combine(scale, sample(after), -scale, sample(before));
}

Result<CameraKey> read_key(const JsonPlace& place) {
  if (const auto object = place.expect_object({"time", "eye", "target", "fov"}); !object) return object.error();
  CameraKey key;
  for (const char* name : {"time", "eye", "target"})
    if (!place.member(name)) return place.error(std::string("needs the key \"") + name + "\"");
  const auto time = place.member("time")->number();
  if (!time) return time.error();
  key.time_s = *time;
  const auto eye = place.member("eye")->vec3();
  if (!eye) return eye.error();
  key.eye = *eye;
  const auto target = place.member("target")->vec3();
  if (!target) return target.error();
  key.target = *target;
  if (key.eye == key.target) return place.error("has eye and target at the same point");
  if (const auto fov = place.member("fov")) {
    const auto degrees = fov->number();
    if (!degrees) return degrees.error();
    if (*degrees < kMinFovDeg || *degrees > kMaxFovDeg) return fov->error("must be 1…170 degrees");
    key.fov_y = static_cast<float>(*degrees * kRadians);
  }
  return key;
}

Result<PathInterpolation> read_interpolation(const JsonPlace& root) {
  const auto place = root.member("interpolation");
  if (!place) return PathInterpolation::catmull_rom;
  const auto text = place->text();
  if (!text) return text.error();
  if (*text == "linear") return PathInterpolation::linear;
  if (*text == "catmull_rom") return PathInterpolation::catmull_rom;
  return place->error("must be \"catmull_rom\" or \"linear\", is " + place->value().dump());
}

}  // namespace

CameraKey CameraPath::at(double time_s) const {
  if (time_s <= keys.front().time_s) return keys.front();
  if (time_s >= keys.back().time_s) return keys.back();
  const auto next = std::upper_bound(keys.begin(), keys.end(), time_s,
                                     [](double time, const CameraKey& key) { return time < key.time_s; });
  const auto i = static_cast<size_t>(next - keys.begin()) - 1;
  const double length = keys[i + 1].time_s - keys[i].time_s;
  const double u = (time_s - keys[i].time_s) / length;
  Sample result{};
  if (interpolation == PathInterpolation::linear) {
    result = combine(1 - u, sample(keys[i]), u, sample(keys[i + 1]));
  } else {
    // Cubic Hermite basis.
    const double u2 = u * u, u3 = u2 * u;
    const Sample points = combine(2 * u3 - 3 * u2 + 1, sample(keys[i]), 3 * u2 - 2 * u3, sample(keys[i + 1]));
    const Sample slopes = combine((u3 - 2 * u2 + u) * length, slope(keys, i), (u3 - u2) * length, slope(keys, i + 1));
    result = combine(1, points, 1, slopes);
  }
  // A cubic may swing beyond its keys; the angle must stay one that a camera can have.
  const double fov_y = std::clamp(result.fov_y, kMinFovDeg * kRadians, kMaxFovDeg * kRadians);
  return {time_s, glm::vec3(result.eye), glm::vec3(result.target), static_cast<float>(fov_y)};
}

Result<CameraPath> read_camera_path(const std::filesystem::path& path) {
  const auto document = read_json(path);
  if (!document) return document.error();
  const JsonPlace root(*document, path.string());
  if (const auto object = root.expect_object({"interpolation", "keys"}); !object) return object.error();
  CameraPath result;
  const auto interpolation = read_interpolation(root);
  if (!interpolation) return interpolation.error();
  result.interpolation = *interpolation;
  const auto list = root.member("keys");
  if (!list) return root.error("needs the key \"keys\"");
  if (const auto array = list->expect_array(); !array) return array.error();
  if (list->value().empty()) return list->error("must hold at least one key");
  for (size_t i = 0; i < list->value().size(); ++i) {
    const JsonPlace place = list->element(i);
    const auto key = read_key(place);
    if (!key) return key.error();
    if (i > 0 && !(key->time_s > result.keys.back().time_s))
      return place.member("time")->error("must be later than the key before it");
    result.keys.push_back(*key);
  }
  return result;
}

}  // namespace app
