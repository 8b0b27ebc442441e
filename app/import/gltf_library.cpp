// The one translation unit with tinygltf's code. tinygltf trusts its input and drops what it does not understand, so it
// is handed a document that was checked before (gltf_schema.cpp); buffers and images, where it would read files and
// allocate by counts of the file, are kept from it.
#include <fstream>  // tinygltf uses it in code that is never called here and does not include it

#define TINYGLTF_IMPLEMENTATION
#include "import/gltf_library.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "import/gltf_fault.hpp"
#include "import/gltf_schema.hpp"

namespace app::gltf {
namespace {

using nlohmann::json;
using umbrage::ErrorCode;

constexpr std::array known_extensions = {
    "KHR_lights_punctual", "KHR_texture_transform",           "KHR_mesh_quantization",
    "KHR_materials_unlit", "KHR_materials_emissive_strength", "KHR_materials_pbrSpecularGlossiness",
};

void check_version(const json& asset) {
  const std::string version = asset.value("minVersion", asset.at("version").get<std::string>());
  const bool two = asset.at("version").get<std::string>().starts_with("2.");
  if (!two || (asset.contains("minVersion") && version != "2.0")) {
    refuse_as(ErrorCode::unsupported, "asset: glTF ", version.substr(0, 16), " is not read; convert it to glTF 2.0");
  }
}

void check_extensions(const json& document) {
  if (!document.contains("extensionsRequired")) return;
  for (const json& required : document.at("extensionsRequired")) {
    const auto& name = required.get_ref<const std::string&>();
    if (std::ranges::find(known_extensions, name) == known_extensions.end()) {
      refuse_as(ErrorCode::unsupported, "extensionsRequired: ", name.substr(0, 64),
                " is not supported; export the file without it");
    }
  }
}

void take_sources(json& document, Model& model) {
  for (const json& buffer : document.value("buffers", json::array())) {
    model.buffers.push_back({buffer.value("uri", ""), buffer.at("byteLength").get<uint64_t>()});
  }
  for (const json& image : document.value("images", json::array())) {
    model.images.push_back({image.value("name", ""), image.value("uri", ""), image.value("bufferView", -1)});
  }
  document.erase("buffers");
  document.erase("images");
}

/// tinygltf refuses index accessors without a buffer view, which glTF allows (all zero): they get one, told by its
/// number.
void add_stand_in_view(json& document, Model& model) {
  json& views = document["bufferViews"];
  if (views.is_null()) views = json::array();
  model.buffer_views = views.size();
  views.push_back({{"buffer", 0}, {"byteLength", 1}});
  if (!document.contains("accessors")) return;
  for (json& accessor : document.at("accessors")) {
    if (!accessor.contains("bufferView")) accessor["bufferView"] = model.buffer_views;
  }
}

/// glTF says: a channel without a node is ignored (an extension may give it another target). tinygltf would complain.
void drop_channels_without_node(json& document) {
  if (!document.contains("animations")) return;
  for (json& animation : document.at("animations")) {
    json kept = json::array();
    for (json& channel : animation.at("channels")) {
      if (channel.at("target").contains("node")) kept.push_back(std::move(channel));
    }
    animation["channels"] = std::move(kept);
  }
}

}  // namespace

Model parse_model(const Document& document) {
  std::string error, warning;
  json checked;
  try {
    checked = checked_copy(json::parse(document.json));
  } catch (const json::exception& fault) {
    const size_t first = document.json.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || document.json[first] != '{')
      refuse("JSON: there is none, so the file is neither .gltf nor .glb");
    const std::string_view text = fault.what();  // "[json.exception…] parse error at line 1, …"
    refuse("JSON: ", text.substr(std::min(text.find("] ") + 2, text.size()), 160));
  }
  check_version(checked.at("asset"));
  check_extensions(checked);
  Model model;
  take_sources(checked, model);
  add_stand_in_view(checked, model);
  drop_channels_without_node(checked);
  const std::string text = checked.dump();
  if (!tinygltf::TinyGLTF().LoadASCIIFromString(&model.parsed, &error, &warning, text.data(),
                                                static_cast<unsigned>(text.size()), "", tinygltf::NO_REQUIRE)) {
    std::ranges::replace(error, '\n', ' ');
    refuse(error);
  }
  return model;
}

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

double number_of(const tinygltf::Value& object, const char* key, double fallback) {
  return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

std::vector<double> numbers_of(const tinygltf::Value& object, const char* key) {
  std::vector<double> numbers;
  if (!object.Has(key)) return numbers;
  const tinygltf::Value& array = object.Get(key);
  for (size_t i = 0; i < array.ArrayLen(); ++i) numbers.push_back(array.Get(static_cast<int>(i)).GetNumberAsDouble());
  return numbers;
}

float finite_float(double value, std::string_view where) {
  const auto number = static_cast<float>(value);
  if (!std::isfinite(number)) refuse(where, ": ", value, " is not a finite 32-bit float");
  return number;
}

}  // namespace app::gltf
