// glTF materials, with the extensions that change what the sample renderer shows.
#include "import/gltf_materials.hpp"

#include <algorithm>
#include <cmath>

#include "import/gltf_fault.hpp"

namespace app::gltf {
namespace {

/// Slots for the texture coordinate sets that one material names, in order of use.
struct SetSlots {
  UvSets sets{0, 1};
  uint32_t used = 0;

  uint32_t slot(uint32_t set, std::string_view where) {
    const auto end = sets.begin() + used;
    const auto found = std::find(sets.begin(), end, set);
    if (found != end) return static_cast<uint32_t>(found - sets.begin());
    if (used == sets.size()) {
      refuse(where, ": reads TEXCOORD_", set, " besides TEXCOORD_", sets[0], " and TEXCOORD_", sets[1],
             "; a material may use two sets");
    }
    // The slot keeps {0, 1} together where it can, so that no set is read twice.
    const auto unused = std::find(end, sets.end(), set);
    if (unused != sets.end()) {
      std::swap(sets[used], *unused);
    } else {
      sets[used] = set;
    }
    return used++;
  }
};

struct Context {
  const Model& model;
  Images& images;
  SetSlots slots;
  std::string where;
};

Wrap wrap_of(int mode, std::string_view where) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::mirror;
    default:
      refuse(where, ": wrap mode ", mode, " is none of glTF's");
  }
}

/// Scale, then rotate, then move. Rotation is counter-clockwise in glTF's texture space, whose v axis points down: the
/// convention of the Khronos viewer (the GLSL listing in the extension's text turns the other way, glTF issue 1563).
glm::mat3x2 uv_transform_of(const tinygltf::Value& transform, const std::string& where) {
  const auto pair = [&](const char* key, float fallback) {
    const std::vector<double> numbers = numbers_of(transform, key);
    if (numbers.empty()) return glm::vec2(fallback);
    return glm::vec2(finite_float(numbers[0], where), finite_float(numbers[1], where));
  };
  const glm::vec2 move = pair("offset", 0), size = pair("scale", 1);
  const double angle = number_of(transform, "rotation", 0);
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  return {c * size.x, -s * size.x, s * size.y, c * size.y, move.x, move.y};
}

Texture import_texture(Context& context, int index, int set, const tinygltf::ExtensionMap& extensions) {
  Texture texture;
  if (index < 0) return texture;
  const std::string name = place("textures", static_cast<size_t>(index));
  if (static_cast<size_t>(index) >= context.model.parsed.textures.size()) {
    refuse(context.where, ": ", name, " is not in the file");
  }
  const tinygltf::Texture& source = context.model.parsed.textures[static_cast<size_t>(index)];
  if (source.source < 0) return texture;  // its image comes with an extension that is not supported
  texture.image = context.images.use(source.source, name);
  if (source.sampler >= 0) {
    if (static_cast<size_t>(source.sampler) >= context.model.parsed.samplers.size()) {
      refuse(name, ": samplers[", source.sampler, "] is not in the file");
    }
    const tinygltf::Sampler& sampler = context.model.parsed.samplers[static_cast<size_t>(source.sampler)];
    texture.wrap_u = wrap_of(sampler.wrapS, place("samplers", static_cast<size_t>(source.sampler)));
    texture.wrap_v = wrap_of(sampler.wrapT, place("samplers", static_cast<size_t>(source.sampler)));
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  auto uv_set = static_cast<uint32_t>(set);
  if (const tinygltf::Value* transform = extension(extensions, "KHR_texture_transform")) {
    texture.uv_transform = uv_transform_of(*transform, context.where + ": KHR_texture_transform");
    uv_set = static_cast<uint32_t>(number_of(*transform, "texCoord", set));
  }
  texture.uv_set = context.slots.slot(uv_set, context.where);
  return texture;
}

float unit(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

glm::vec4 unit_color(const std::vector<double>& c) { return {unit(c[0]), unit(c[1]), unit(c[2]), unit(c[3])}; }

float non_negative(double value, const std::string& where) {
  if (value < 0) refuse(where, ": must not be negative");
  return finite_float(value, where);
}

/// The older model's diffuse part as a dielectric; its specular colour has no counterpart.
void import_specular_glossiness(Context& context, const tinygltf::Value& source, Material& material) {
  const std::vector<double> diffuse = numbers_of(source, "diffuseFactor");
  if (!diffuse.empty()) material.base_color = unit_color(diffuse);
  material.metallic = 0;
  material.roughness = 1 - unit(number_of(source, "glossinessFactor", 1));
  if (!source.Has("diffuseTexture")) return;
  const tinygltf::Value& texture = source.Get("diffuseTexture");
  tinygltf::ExtensionMap extensions;
  if (texture.Has("extensions") && texture.Get("extensions").Has("KHR_texture_transform")) {
    extensions["KHR_texture_transform"] = texture.Get("extensions").Get("KHR_texture_transform");
  }
  material.base_color_texture = import_texture(context, static_cast<int>(number_of(texture, "index", -1)),
                                               static_cast<int>(number_of(texture, "texCoord", 0)), extensions);
}

void import_metallic_roughness(Context& context, const tinygltf::PbrMetallicRoughness& source, Material& material) {
  material.base_color = unit_color(source.baseColorFactor);
  material.metallic = unit(source.metallicFactor);
  material.roughness = unit(source.roughnessFactor);
  const auto& color = source.baseColorTexture;
  material.base_color_texture = import_texture(context, color.index, color.texCoord, color.extensions);
  const auto& surface = source.metallicRoughnessTexture;
  material.metallic_roughness_texture = import_texture(context, surface.index, surface.texCoord, surface.extensions);
}

void import_alpha(Context& context, const tinygltf::Material& source, Material& material) {
  if (source.alphaMode == "MASK") {
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = non_negative(source.alphaCutoff, context.where + ".alphaCutoff");
  } else if (source.alphaMode == "BLEND") {
    material.alpha_mode = AlphaMode::blend;
  } else if (source.alphaMode != "OPAQUE") {
    refuse(context.where, ".alphaMode: must be OPAQUE, MASK or BLEND");
  }
}

Material import_material(Context& context, const tinygltf::Material& source) {
  Material material{.name = source.name};
  if (const tinygltf::Value* older = extension(source.extensions, "KHR_materials_pbrSpecularGlossiness")) {
    import_specular_glossiness(context, *older, material);
  } else {
    import_metallic_roughness(context, source.pbrMetallicRoughness, material);
  }
  const auto& normal = source.normalTexture;
  material.normal_texture = import_texture(context, normal.index, normal.texCoord, normal.extensions);
  material.normal_scale = finite_float(normal.scale, context.where + ".normalTexture.scale");
  double strength = 1;
  if (const tinygltf::Value* emissive = extension(source.extensions, "KHR_materials_emissive_strength")) {
    strength = number_of(*emissive, "emissiveStrength", 1);
  }
  for (int c = 0; c < 3; ++c) {
    const double factor = source.emissiveFactor[static_cast<size_t>(c)];
    material.emissive[c] = non_negative(factor * strength, context.where + ".emissiveFactor times strength");
  }
  const auto& emissive = source.emissiveTexture;
  material.emissive_texture = import_texture(context, emissive.index, emissive.texCoord, emissive.extensions);
  import_alpha(context, source, material);
  material.double_sided = source.doubleSided;
  material.unlit = extension(source.extensions, "KHR_materials_unlit") != nullptr;
  return material;
}

}  // namespace

Materials import_materials(const Model& model, Images& images) {
  Materials result;
  for (size_t i = 0; i < model.parsed.materials.size(); ++i) {
    Context context{model, images, {}, place("materials", i)};
    result.materials.push_back(import_material(context, model.parsed.materials[i]));
    result.uv_sets.push_back(context.slots.sets);
  }
  result.materials.push_back({.name = "default"});
  result.uv_sets.push_back(UvSets{0, 1});
  return result;
}

}  // namespace app::gltf
