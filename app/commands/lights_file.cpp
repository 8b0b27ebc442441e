// The lights file.
#include "commands/lights_file.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <sstream>
#include <string_view>

#include "commands/json_file.hpp"
#include "umbrage/scene.hpp"

namespace app {
namespace {

using umbrage::Result;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr LightKind kKinds[] = {LightKind::point, LightKind::spot, LightKind::directional};

enum class Bound : uint8_t { positive, not_negative };

/// Leaves value as it is where the key is absent.
Result<void> read_number(const JsonPlace& light, const char* key, Bound bound, double& value) {
  const auto place = light.member(key);
  if (!place) return {};
  const auto number = place->number();
  if (!number) return number.error();
  // The value is kept in single precision, where a tiny one may be zero.
  if (bound == Bound::positive && !(static_cast<float>(*number) > 0))
    return place->error("must be > 0, is " + place->value().dump());
  if (bound == Bound::not_negative && *number < 0) return place->error("must be ≥ 0, is " + place->value().dump());
  value = *number;
  return {};
}

Result<LightKind> read_kind(const JsonPlace& light) {
  const auto place = light.member("type");
  if (!place) return light.error("needs the key \"type\"");
  const auto text = place->text();
  if (!text) return text.error();
  for (const LightKind kind : kKinds)
    if (*text == kind_name(kind)) return kind;
  return place->error("must be \"point\", \"spot\" or \"directional\", is " + place->value().dump());
}

Result<void> read_placement(const JsonPlace& place, PosedLight& light) {
  const auto position = place.member("position");
  if (position) {
    const auto value = position->vec3();
    if (!value) return value.error();
    light.position = *value;
  } else if (light.kind != LightKind::directional) {
    return place.error(std::string("needs the key \"position\" (type ") + kind_name(light.kind) + ")");
  }
  const auto direction = place.member("direction");
  if (direction) {
    const auto value = direction->vec3();
    if (!value) return value.error();
    const double length = glm::length(glm::dvec3(*value));
    if (!(length > 0)) return direction->error("must have a length > 0");
    // A unit vector stays bit for bit what it is, so that a dumped file reproduces its frame.
    light.direction = std::abs(length - 1) < 1e-6 ? *value : glm::vec3(glm::dvec3(*value) / length);
  } else if (light.kind != LightKind::point) {
    return place.error(std::string("needs the key \"direction\" (type ") + kind_name(light.kind) + ")");
  }
  return {};
}

Result<void> read_color(const JsonPlace& place, PosedLight& light) {
  const auto color = place.member("color");
  if (!color) return {};
  const auto value = color->vec3();
  if (!value) return value.error();
  if (glm::any(glm::lessThan(*value, glm::vec3(0)))) return color->error("must not have negative components");
  light.color = *value;
  return {};
}

Result<void> read_cone(const JsonPlace& place, PosedLight& light) {
  double inner_deg = 0, outer_deg = 45;
  if (const auto read = read_number(place, "inner_cone_deg", Bound::not_negative, inner_deg); !read)
    return read.error();
  if (const auto read = read_number(place, "outer_cone_deg", Bound::positive, outer_deg); !read) return read.error();
  if (outer_deg > 90) return place.member("outer_cone_deg")->error("must be at most 90 (a half-angle)");
  if (inner_deg > outer_deg) return place.error("has an inner_cone_deg above its outer_cone_deg (45 when left out)");
  light.inner_cone = static_cast<float>(inner_deg / kDegrees);
  light.outer_cone = static_cast<float>(outer_deg / kDegrees);
  return {};
}

constexpr std::string_view kFaces[] = {"+x", "-x", "+y", "-y", "+z", "-z"};

/// "faces": "+x -y": names between spaces.
Result<void> read_faces(const JsonPlace& place, PosedLight& light) {
  const auto faces = place.member("faces");
  if (!faces) return {};
  const auto text = faces->text();
  if (!text) return text.error();
  light.faces = 0;
  std::istringstream names(*text);
  for (std::string name; names >> name;) {
    const auto* const found = std::find(std::begin(kFaces), std::end(kFaces), name);
    if (found == std::end(kFaces)) return faces->error("names \"" + name + "\": choose from +x, -x, +y, -y, +z, -z");
    light.faces |= 1u << (found - std::begin(kFaces));
  }
  if (light.faces == 0) return faces->error("must name a face: +x, -x, +y, -y, +z, -z");
  if (light.kind != LightKind::point) return faces->error("is for point lights");
  return {};
}

std::string names_of_faces(uint32_t faces) {
  std::string names;
  for (size_t face = 0; face < std::size(kFaces); ++face) {
    if ((faces >> face & 1) == 0) continue;
    if (!names.empty()) names += ' ';
    names += kFaces[face];
  }
  return names;
}

Result<PosedLight> read_light(const JsonPlace& place) {
  if (const auto object = place.expect_object({"type", "position", "direction", "color", "intensity", "range",
                                               "inner_cone_deg", "outer_cone_deg", "faces", "name"});
      !object)
    return object.error();
  PosedLight light;
  const auto kind = read_kind(place);
  if (!kind) return kind.error();
  light.kind = *kind;
  if (const auto name = place.member("name")) {
    const auto text = name->text();
    if (!text) return text.error();
    light.name = *text;
  }
  if (const auto read = read_placement(place, light); !read) return read.error();
  if (const auto read = read_color(place, light); !read) return read.error();
  double intensity = 1, range = std::numeric_limits<double>::infinity();
  if (const auto read = read_number(place, "intensity", Bound::not_negative, intensity); !read) return read.error();
  if (const auto read = read_number(place, "range", Bound::positive, range); !read) return read.error();
  light.intensity = static_cast<float>(intensity);
  light.range = static_cast<float>(range);
  if (const auto read = read_cone(place, light); !read) return read.error();
  if (const auto read = read_faces(place, light); !read) return read.error();
  return light;
}

nlohmann::ordered_json array_of(const glm::vec3& value) {
  return {shortest_decimal(value.x), shortest_decimal(value.y), shortest_decimal(value.z)};
}

}  // namespace

const char* kind_name(LightKind kind) {
  switch (kind) {
    case LightKind::point:
      return "point";
    case LightKind::spot:
      return "spot";
    case LightKind::directional:
      return "directional";
  }
  return "point";
}

Result<std::vector<PosedLight>> read_lights(const std::filesystem::path& path) {
  const auto document = read_json(path);
  if (!document) return document.error();
  const JsonPlace root(*document, path.string());
  if (const auto object = root.expect_object({"lights"}); !object) return object.error();
  const auto list = root.member("lights");
  if (!list) return root.error("needs the key \"lights\"");
  if (const auto array = list->expect_array(); !array) return array.error();
  std::vector<PosedLight> lights;
  lights.reserve(list->value().size());
  for (size_t i = 0; i < list->value().size(); ++i) {
    auto light = read_light(list->element(i));
    if (!light) return light.error();
    lights.push_back(std::move(*light));
  }
  return lights;
}

nlohmann::ordered_json lights_document(std::span<const ActiveLight> lights) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ActiveLight& light : lights) {
    nlohmann::ordered_json entry;
    entry["type"] = kind_name(light.kind);
    if (!light.name.empty()) entry["name"] = light.name;
    if (light.kind != LightKind::directional) entry["position"] = array_of(light.position);
    if (light.kind != LightKind::point) entry["direction"] = array_of(light.direction);
    entry["color"] = array_of(light.color);
    entry["intensity"] = shortest_decimal(light.intensity);
    if (light.kind != LightKind::directional) entry["range"] = shortest_decimal(light.range);
    if (light.faces != umbrage::LightDesc().faces) entry["faces"] = names_of_faces(light.faces);
    if (light.kind == LightKind::spot) {
      entry["inner_cone_deg"] = double(light.inner_cone) * kDegrees;
      entry["outer_cone_deg"] = double(light.outer_cone) * kDegrees;
    }
    list.push_back(std::move(entry));
  }
  nlohmann::ordered_json document;
  document["lights"] = std::move(list);
  return document;
}

}  // namespace app
