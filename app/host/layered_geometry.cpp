// Scene → meshes, instances, masks of a layered scene.
#include "host/layered_geometry.hpp"

#include <map>

#include "host/textures.hpp"

namespace app {

using umbrage::Result;

umbrage::Affine affine_rows(const glm::mat4& m) {
  umbrage::Affine rows;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) rows.m[4 * row + column] = m[column][row];
  return rows;
}

umbrage::Mat4 mat4(const glm::mat4& m) {
  umbrage::Mat4 out;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) out.m[4 * column + row] = m[column][row];
  return out;
}

namespace {

umbrage::Vec3 vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// Each mask once.
class Masks {
 public:
  Masks(const TextureTable* textures, std::vector<umbrage::LayeredMask>& out) : textures_(textures), out_(out) {}
  umbrage::MaskId find(const Material& material) {
    if (!textures_ || material.alpha_mode != AlphaMode::mask || material.base_color_texture.image < 0) return {};
    const uint32_t slot = textures_->slot(material.base_color_texture, ColorSpace::srgb);
    auto [place, is_new] = found_.try_emplace(slot, umbrage::MaskId{static_cast<uint32_t>(out_.size() + 1)});
    if (is_new) out_.push_back({textures_->view(slot), textures_->sampler(slot)});
    return place->second;
  }

 private:
  const TextureTable* textures_;
  std::vector<umbrage::LayeredMask>& out_;
  std::map<uint32_t, umbrage::MaskId> found_;
};

}  // namespace

LayeredArrays::Mesh layered_mesh(const Primitive& primitive, const Material& material,
                                 std::span<const glm::vec3> positions, umbrage::MaskId mask) {
  LayeredArrays::Mesh mesh;
  for (const glm::vec3& p : positions) mesh.positions.push_back(vec3(p));
  for (const glm::vec3& n : primitive.normals) mesh.normals.push_back(vec3(n));
  const auto& uvs = primitive.uv[material.base_color_texture.uv_set == 0 ? 0 : 1];
  for (size_t i = 0; i < positions.size(); ++i) {
    const glm::vec2 uv =
        material.base_color_texture.uv_transform * glm::vec3(uvs.empty() ? glm::vec2(0) : uvs[i], 1.0f);
    mesh.uvs.push_back({uv.x, uv.y});
  }
  mesh.indices = primitive.indices;
  mesh.submesh.index_count = static_cast<uint32_t>(primitive.indices.size());
  mesh.submesh.mask = mask;
  mesh.submesh.alpha_cutoff = material.alpha_cutoff;
  mesh.submesh.alpha_factor = material.base_color.a;
  return mesh;
}

bool is_solid(const Material& material) {
  const bool only_glows =
      material.unlit || (glm::vec3(material.base_color) == glm::vec3(0) && material.emissive != glm::vec3(0));
  return material.alpha_mode != AlphaMode::blend && !only_glows;
}

LayeredArrays layered_arrays(const Scene& scene, const Pose& pose, const TextureTable* textures,
                             const LayeredChoice& choice) {
  LayeredArrays out;
  Masks masks(textures, out.masks);
  std::map<std::pair<uint32_t, size_t>, uint32_t> rigid;  // mesh and primitive → mesh of ours
  for (uint32_t posed = 0; posed < pose.instances.size(); ++posed) {
    const PosedInstance& instance = pose.instances[posed];
    if (choice.without_mesh >= 0 && instance.mesh == static_cast<uint32_t>(choice.without_mesh)) continue;
    const std::vector<Primitive>& primitives = scene.meshes[instance.mesh].primitives;
    for (size_t p = 0; p < primitives.size(); ++p) {
      const Primitive& primitive = primitives[p];
      const Material& material = scene.materials[primitive.material];
      const bool is_taken = choice.glowing ? material.alpha_mode != AlphaMode::blend : is_solid(material);
      if (!is_taken || primitive.indices.empty()) continue;
      const bool deforms = instance.skin >= 0 || !instance.weights.empty();
      auto mesh = static_cast<uint32_t>(out.meshes.size());
      if (deforms) {
        out.meshes.push_back(
            layered_mesh(primitive, material, deformed_positions(primitive, instance, pose), masks.find(material)));
      } else {
        const auto [place, is_new] = rigid.try_emplace({instance.mesh, p}, mesh);
        mesh = place->second;
        if (is_new) out.meshes.push_back(layered_mesh(primitive, material, primitive.positions, masks.find(material)));
      }
      out.instances.push_back({.mesh = mesh,
                               .world_from_mesh = affine_rows(instance.world_from_mesh),
                               .host_index = static_cast<uint32_t>(out.materials.size())});
      out.materials.push_back(primitive.material);
      out.posed.push_back(posed);
    }
  }
  return out;
}

Result<umbrage::LayeredScene> LayeredArrays::create(const umbrage::DeviceDesc& device) const {
  std::vector<umbrage::LayeredMesh> descs;
  for (const Mesh& mesh : meshes)
    descs.push_back({.positions = mesh.positions,
                     .indices = mesh.indices,
                     .normals = mesh.normals,
                     .uvs = mesh.uvs,
                     .skin = mesh.skin,
                     .submeshes = {&mesh.submesh, 1}});
  return umbrage::LayeredScene::create(device, {.meshes = descs, .instances = instances, .masks = masks});
}

}  // namespace app
