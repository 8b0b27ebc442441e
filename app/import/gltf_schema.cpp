// One table of glTF 2.0's properties and the walk that holds a document against it.
#include "import/gltf_schema.hpp"

#include <cmath>
#include <string>
#include <string_view>

#include "import/gltf_fault.hpp"
#include "import/gltf_limits.hpp"

namespace app::gltf {
namespace {

using nlohmann::json;

enum class Kind : uint8_t {
  text,
  boolean,
  number,
  index,  ///< 0 … 2³¹-1: references, enumerations, small counts.
  size,   ///< 0 … 2⁵³: bytes and element counts.
  texts,
  numbers,
  indices,
  index_map,  ///< Any keys, each an index: vertex attributes.
  index_maps,
  object,
  objects,
};

enum class Presence : uint8_t { optional, required };
using enum Presence;

/// One property of one kind of object. count: exact length of number arrays, largest length of lists of objects; 0 =
/// any, max_objects. members: the table's name for the object(s) inside.
struct Property {
  std::string_view object, key;
  Kind kind;
  Presence presence = optional;
  size_t count = 0;
  std::string_view members = {};
};

constexpr Property properties[] = {
    {"document", "asset", Kind::object, required, 0, "asset"},
    {"document", "extensionsUsed", Kind::texts},
    {"document", "extensionsRequired", Kind::texts},
    {"document", "extensions", Kind::object, optional, 0, "document.extensions"},
    {"document", "scene", Kind::index},
    {"document", "scenes", Kind::objects, optional, max_large_objects, "scene"},
    {"document", "nodes", Kind::objects, optional, 0, "node"},
    {"document", "meshes", Kind::objects, optional, 0, "mesh"},
    {"document", "accessors", Kind::objects, optional, 0, "accessor"},
    {"document", "bufferViews", Kind::objects, optional, 0, "buffer_view"},
    {"document", "buffers", Kind::objects, optional, 0, "buffer"},
    {"document", "images", Kind::objects, optional, max_large_objects, "image"},
    {"document", "textures", Kind::objects, optional, max_large_objects, "texture"},
    {"document", "samplers", Kind::objects, optional, max_large_objects, "sampler"},
    {"document", "materials", Kind::objects, optional, max_large_objects, "material"},
    {"document", "cameras", Kind::objects, optional, max_large_objects, "camera"},
    {"document", "skins", Kind::objects, optional, max_large_objects, "skin"},
    {"document", "animations", Kind::objects, optional, max_large_objects, "animation"},
    {"document.extensions", "KHR_lights_punctual", Kind::object, optional, 0, "lights"},
    {"asset", "version", Kind::text, required},
    {"asset", "minVersion", Kind::text},
    {"scene", "name", Kind::text},
    {"scene", "nodes", Kind::indices},

    {"node", "name", Kind::text},
    {"node", "children", Kind::indices},
    {"node", "mesh", Kind::index},
    {"node", "skin", Kind::index},
    {"node", "camera", Kind::index},
    {"node", "matrix", Kind::numbers, optional, 16},
    {"node", "translation", Kind::numbers, optional, 3},
    {"node", "rotation", Kind::numbers, optional, 4},
    {"node", "scale", Kind::numbers, optional, 3},
    {"node", "weights", Kind::numbers},
    {"node", "extensions", Kind::object, optional, 0, "node.extensions"},
    {"node.extensions", "KHR_lights_punctual", Kind::object, optional, 0, "node.light"},
    {"node.light", "light", Kind::index, required},

    {"mesh", "name", Kind::text},
    {"mesh", "primitives", Kind::objects, required, 0, "primitive"},
    {"mesh", "weights", Kind::numbers},
    {"primitive", "attributes", Kind::index_map, required},
    {"primitive", "indices", Kind::index},
    {"primitive", "material", Kind::index},
    {"primitive", "mode", Kind::index},
    {"primitive", "targets", Kind::index_maps},

    {"accessor", "bufferView", Kind::index},
    {"accessor", "byteOffset", Kind::size},
    {"accessor", "componentType", Kind::index, required},
    {"accessor", "normalized", Kind::boolean},
    {"accessor", "count", Kind::size, required},
    {"accessor", "type", Kind::text, required},
    {"accessor", "sparse", Kind::object, optional, 0, "sparse"},
    {"sparse", "count", Kind::index, required},
    {"sparse", "indices", Kind::object, required, 0, "sparse.indices"},
    {"sparse", "values", Kind::object, required, 0, "sparse.values"},
    {"sparse.indices", "bufferView", Kind::index, required},
    {"sparse.indices", "byteOffset", Kind::index},
    {"sparse.indices", "componentType", Kind::index, required},
    {"sparse.values", "bufferView", Kind::index, required},
    {"sparse.values", "byteOffset", Kind::index},
    {"buffer_view", "buffer", Kind::index, required},
    {"buffer_view", "byteOffset", Kind::size},
    {"buffer_view", "byteLength", Kind::size, required},
    {"buffer_view", "byteStride", Kind::size},
    {"buffer", "uri", Kind::text},
    {"buffer", "byteLength", Kind::size, required},

    {"image", "name", Kind::text},
    {"image", "uri", Kind::text},
    {"image", "bufferView", Kind::index},
    {"texture", "sampler", Kind::index},
    {"texture", "source", Kind::index},
    {"sampler", "magFilter", Kind::index},
    {"sampler", "wrapS", Kind::index},
    {"sampler", "wrapT", Kind::index},

    {"material", "name", Kind::text},
    {"material", "pbrMetallicRoughness", Kind::object, optional, 0, "metallic_roughness"},
    {"material", "normalTexture", Kind::object, optional, 0, "texture_info"},
    {"material", "emissiveTexture", Kind::object, optional, 0, "texture_info"},
    {"material", "emissiveFactor", Kind::numbers, optional, 3},
    {"material", "alphaMode", Kind::text},
    {"material", "alphaCutoff", Kind::number},
    {"material", "doubleSided", Kind::boolean},
    {"material", "extensions", Kind::object, optional, 0, "material.extensions"},
    {"material.extensions", "KHR_materials_unlit", Kind::object, optional, 0, "unlit"},
    {"material.extensions", "KHR_materials_emissive_strength", Kind::object, optional, 0, "emissive_strength"},
    {"material.extensions", "KHR_materials_pbrSpecularGlossiness", Kind::object, optional, 0, "specular_glossiness"},
    {"metallic_roughness", "baseColorFactor", Kind::numbers, optional, 4},
    {"metallic_roughness", "baseColorTexture", Kind::object, optional, 0, "texture_info"},
    {"metallic_roughness", "metallicFactor", Kind::number},
    {"metallic_roughness", "roughnessFactor", Kind::number},
    {"metallic_roughness", "metallicRoughnessTexture", Kind::object, optional, 0, "texture_info"},
    {"emissive_strength", "emissiveStrength", Kind::number},
    {"specular_glossiness", "diffuseFactor", Kind::numbers, optional, 4},
    {"specular_glossiness", "diffuseTexture", Kind::object, optional, 0, "texture_info"},
    {"specular_glossiness", "glossinessFactor", Kind::number},
    {"texture_info", "index", Kind::index, required},
    {"texture_info", "texCoord", Kind::index},
    {"texture_info", "scale", Kind::number},
    {"texture_info", "extensions", Kind::object, optional, 0, "texture_info.extensions"},
    {"texture_info.extensions", "KHR_texture_transform", Kind::object, optional, 0, "texture_transform"},
    {"texture_transform", "offset", Kind::numbers, optional, 2},
    {"texture_transform", "rotation", Kind::number},
    {"texture_transform", "scale", Kind::numbers, optional, 2},
    {"texture_transform", "texCoord", Kind::index},

    {"camera", "name", Kind::text},
    {"camera", "type", Kind::text, required},
    {"camera", "perspective", Kind::object, optional, 0, "perspective"},
    {"camera", "orthographic", Kind::object, optional, 0, "orthographic"},
    {"perspective", "aspectRatio", Kind::number},
    {"perspective", "yfov", Kind::number, required},
    {"perspective", "znear", Kind::number, required},
    {"perspective", "zfar", Kind::number},
    {"orthographic", "xmag", Kind::number, required},
    {"orthographic", "ymag", Kind::number, required},
    {"orthographic", "znear", Kind::number, required},
    {"orthographic", "zfar", Kind::number, required},
    {"lights", "lights", Kind::objects, required, 0, "light"},
    {"light", "name", Kind::text},
    {"light", "type", Kind::text, required},
    {"light", "color", Kind::numbers, optional, 3},
    {"light", "intensity", Kind::number},
    {"light", "range", Kind::number},
    {"light", "spot", Kind::object, optional, 0, "spot"},
    {"spot", "innerConeAngle", Kind::number},
    {"spot", "outerConeAngle", Kind::number},

    {"skin", "name", Kind::text},
    {"skin", "joints", Kind::indices, required},
    {"skin", "inverseBindMatrices", Kind::index},
    {"animation", "name", Kind::text},
    {"animation", "channels", Kind::objects, required, 0, "channel"},
    {"animation", "samplers", Kind::objects, required, 0, "animation.sampler"},
    {"channel", "sampler", Kind::index, required},
    {"channel", "target", Kind::object, required, 0, "target"},
    {"target", "node", Kind::index},
    {"target", "path", Kind::text, required},
    {"animation.sampler", "input", Kind::index, required},
    {"animation.sampler", "output", Kind::index, required},
    {"animation.sampler", "interpolation", Kind::text},
};

json checked_object(const json& value, std::string_view object, const std::string& where);

json checked_integer(const json& value, double largest, const std::string& where) {
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!value.is_number() || number < 0 || number > largest || number != std::floor(number)) {
    refuse(where, ": must be an integer from 0 to ", static_cast<uint64_t>(largest));
  }
  return static_cast<uint64_t>(number);
}

json checked_scalar(const json& value, Kind kind, const std::string& where) {
  switch (kind) {
    case Kind::text:
      if (!value.is_string()) refuse(where, ": must be a string, is ", value.type_name());
      return value;
    case Kind::boolean:
      if (!value.is_boolean()) refuse(where, ": must be true or false, is ", value.type_name());
      return value;
    case Kind::number:
      if (!value.is_number()) refuse(where, ": must be a number, is ", value.type_name());
      return value.get<double>();
    case Kind::size:
      return checked_integer(value, 9007199254740992.0, where);
    default:
      return checked_integer(value, 2147483647.0, where);
  }
}

json checked_map(const json& value, const std::string& where) {
  if (!value.is_object()) refuse(where, ": must be an object, is ", value.type_name());
  json copy = json::object();
  for (const auto& [key, index] : value.items()) copy[key] = checked_scalar(index, Kind::index, where + "." + key);
  return copy;
}

template <class Check>
json checked_list(const json& value, size_t exact, size_t largest, const std::string& where, Check&& check) {
  if (!value.is_array()) refuse(where, ": must be an array, is ", value.type_name());
  if (exact != 0 && value.size() != exact) refuse(where, ": must have ", exact, " elements, has ", value.size());
  if (value.size() > largest) refuse(where, ": has ", value.size(), " elements; at most ", largest, " are read");
  json copy = json::array();
  for (size_t i = 0; i < value.size(); ++i) copy.push_back(check(value[i], i));
  return copy;
}

json checked_list_of(const json& value, Kind kind, size_t exact, const std::string& where) {
  return checked_list(value, exact, value.size(), where,
                      [&](const json& e, size_t i) { return checked_scalar(e, kind, place(where, i)); });
}

json checked_value(const json& value, const Property& property, const std::string& where) {
  switch (property.kind) {
    case Kind::texts:
      return checked_list_of(value, Kind::text, 0, where);
    case Kind::numbers:
      return checked_list_of(value, Kind::number, property.count, where);
    case Kind::indices:
      return checked_list_of(value, Kind::index, 0, where);
    case Kind::index_map:
      return checked_map(value, where);
    case Kind::index_maps:
      return checked_list(value, 0, max_objects, where,
                          [&](const json& e, size_t i) { return checked_map(e, place(where, i)); });
    case Kind::object:
      return checked_object(value, property.members, where);
    case Kind::objects:
      return checked_list(
          value, 0, property.count != 0 ? property.count : max_objects, where,
          [&](const json& e, size_t i) { return checked_object(e, property.members, place(where, i)); });
    default:
      return checked_scalar(value, property.kind, where);
  }
}

json checked_object(const json& value, std::string_view object, const std::string& where) {
  if (!value.is_object()) refuse(where.empty() ? "document" : where, ": must be an object, is ", value.type_name());
  json copy = json::object();
  for (const Property& property : properties) {
    if (property.object != object) continue;
    const auto place_inside = [&] { return (where.empty() ? "" : where + ".") + std::string(property.key); };
    const auto found = value.find(property.key);
    if (found != value.end()) {
      copy[std::string(property.key)] = checked_value(*found, property, place_inside());
    } else if (property.presence == required) {
      refuse(place_inside(), ": is missing");
    }
  }
  return copy;
}

}  // namespace

json checked_copy(const json& document) { return checked_object(document, "document", ""); }

}  // namespace app::gltf
