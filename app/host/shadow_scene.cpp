// Hands the scene to umbrage.
#include "host/shadow_scene.hpp"

#include <algorithm>

#include "import/detail_levels.hpp"

namespace app {

using umbrage::Error;
using umbrage::Result;

namespace {

umbrage::Affine affine(const glm::mat4& m) {
  umbrage::Affine rows;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) rows.m[4 * row + column] = m[column][row];
  }
  return rows;
}

umbrage::Vec3 vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }

umbrage::LightDesc light_desc(const ActiveLight& light, uint32_t index) {
  umbrage::LightDesc desc;
  desc.type = light.kind == LightKind::point  ? umbrage::LightType::point
              : light.kind == LightKind::spot ? umbrage::LightType::spot
                                              : umbrage::LightType::directional;
  desc.position = vec3(light.position);
  desc.direction = vec3(light.direction);
  if (light.kind != LightKind::directional) desc.range_m = light.range;
  if (light.kind == LightKind::spot) {
    desc.inner_cone_rad = light.inner_cone;
    desc.outer_cone_rad = light.outer_cone;
  }
  desc.faces = light.faces;
  desc.host_index = index;
  return desc;
}

bool same(const umbrage::LightDesc& a, const umbrage::LightDesc& b) {
  const auto values = [](const umbrage::LightDesc& d) {
    return std::tuple(d.type, d.position.x, d.position.y, d.position.z, d.direction.x, d.direction.y, d.direction.z,
                      d.range_m, d.inner_cone_rad, d.outer_cone_rad, d.faces, d.host_index);
  };
  return values(a) == values(b);
}

/// Blended surfaces and skies cast nothing; nor does what its own factor cuts away wholly.
bool casts(const Material& material) {
  if (material.alpha_mode == AlphaMode::blend || !material.casts_shadow) return false;
  return material.alpha_mode == AlphaMode::opaque || material.base_color.a >= material.alpha_cutoff;
}

/// Texture coordinates of the base colour as its texture's transform leaves them.
std::vector<umbrage::Vec2> mask_uvs(const Primitive& primitive, const Texture& texture) {
  const auto& source = primitive.uv[texture.uv_set == 0 ? 0 : 1];
  std::vector<umbrage::Vec2> uvs(primitive.positions.size());
  for (size_t i = 0; i < uvs.size(); ++i) {
    const glm::vec2 raw = source.empty() ? glm::vec2(0) : source[i];
    const glm::vec2 uv = texture.uv_transform * glm::vec3(raw, 1.0f);
    uvs[i] = {uv.x, uv.y};
  }
  return uvs;
}

std::vector<umbrage::Submesh> submeshes_of(const DetailLevels& levels, umbrage::Submesh like) {
  std::vector<umbrage::Submesh> submeshes;
  for (uint32_t level = 0; level < levels.errors_m.size(); ++level) {
    like.first_index = levels.first_index[level];
    like.index_count = levels.first_index[level + 1] - like.first_index;
    like.first_level = like.last_level = level;
    submeshes.push_back(like);
  }
  return submeshes;
}

}  // namespace

Result<std::unique_ptr<ShadowScene>> ShadowScene::create(const GpuContext& context,
                                                         const umbrage::StaticSettings& settings) {
  auto system = umbrage::ShadowSystem::create(context.headless().desc(), settings);
  if (!system) return system.error();
  return std::unique_ptr<ShadowScene>(new ShadowScene(std::move(system).value()));
}

Result<void> ShadowScene::add_scene(const Source& source, const std::string& batch_cache_dir,
                                    uint32_t batch_triangles) {
  masks_.resize(source.textures.size());
  std::vector<const Primitive*> primitives;
  for (const Mesh& mesh : source.scene.meshes) {
    for (const Primitive& primitive : mesh.primitives) primitives.push_back(&primitive);
  }
  std::vector<umbrage::MeshId> meshes(primitives.size());
  BatchCache cache(batch_cache_dir);
  const umbrage::PrepareSettings settings = {.batch_triangles = batch_triangles};
  for (const SceneItem& item : source.items) {
    const Primitive& primitive = *primitives[item.primitive];
    if (!casts(source.scene.materials[primitive.material])) {
      instances_.emplace_back();
      transforms_.emplace_back();
      continue;
    }
    umbrage::MeshId& mesh = meshes[item.primitive];
    if (mesh.value == 0) {
      auto added =
          add_mesh(source, primitive, source.buffers.primitives()[item.primitive], cache, settings, !item.deformed);
      if (!added) return added.error();
      mesh = *added;
    }
    if (auto added = add_instance(item, mesh, source.pose); !added) return added.error();
  }
  return {};
}

Result<umbrage::MaskId> ShadowScene::mask_of(const Texture& texture, const TextureTable& textures) {
  if (texture.image < 0) return umbrage::MaskId{};
  const uint32_t slot = textures.slot(texture, ColorSpace::srgb);
  if (masks_[slot].value == 0) {
    auto added = system_.add_mask(textures.view(slot), textures.sampler(slot));
    if (!added) return added.error();
    masks_[slot] = *added;
  }
  return masks_[slot];
}

Result<umbrage::MeshId> ShadowScene::add_mesh(const Source& source, const Primitive& primitive,
                                              const UploadedPrimitive& uploaded, BatchCache& cache,
                                              const umbrage::PrepareSettings& settings, bool has_levels) {
  const Material& material = source.scene.materials[primitive.material];
  umbrage::Submesh submesh;
  std::vector<umbrage::Vec2> uvs;
  if (material.alpha_mode == AlphaMode::mask) {
    auto mask = mask_of(material.base_color_texture, source.textures);
    if (!mask) return mask.error();
    submesh.mask = *mask;
    submesh.alpha_cutoff = material.alpha_cutoff;
    submesh.alpha_factor = material.base_color.a;
    if (mask->value != 0) uvs = mask_uvs(primitive, material.base_color_texture);
  }
  std::vector<umbrage::Vec3> positions;
  positions.reserve(primitive.positions.size());
  for (const glm::vec3& p : primitive.positions) positions.push_back(vec3(p));

  umbrage::MeshDesc mesh;
  // Triangles that a texture cuts out, or that bend, stay as they are.
  const DetailLevels levels = has_levels && submesh.mask.value == 0
                                  ? cache.levels(primitive.positions, primitive.indices)
                                  : one_detail_level(primitive.indices);
  const std::vector<umbrage::Submesh> submeshes = submeshes_of(levels, submesh);
  mesh.positions = positions;
  mesh.indices = levels.indices;
  mesh.level_errors_m = levels.errors_m;
  mesh.uvs = uvs;
  mesh.device_positions = {uploaded.positions, sizeof(glm::vec3)};
  mesh.submeshes = submeshes;
  auto prepared = cache.prepare(positions, mesh.indices, mesh.submeshes, settings);
  if (!prepared) return prepared.error();
  mesh.prepared = *prepared;
  return system_.add_mesh(mesh);
}

Result<void> ShadowScene::add_instance(const SceneItem& item, umbrage::MeshId mesh, const Pose& pose) {
  const glm::mat4& matrix = pose.instances[item.instance].world_from_mesh;
  umbrage::InstanceDesc instance;
  instance.mesh = mesh;
  instance.world_from_mesh = affine(matrix);
  instance.mobility = item.moving || item.deformed ? umbrage::Mobility::movable : umbrage::Mobility::fixed;
  if (item.deformed) instance.deformed = {item.positions, sizeof(glm::vec3)};
  auto added = system_.add_instance(instance);
  if (!added) return added.error();
  instances_.push_back(*added);
  transforms_.push_back(matrix);
  return {};
}

Result<void> ShadowScene::update(const Pose& pose, std::span<const SceneItem> items,
                                 std::span<const uint32_t> deformed) {
  changed_instances_.clear();
  changed_transforms_.clear();
  for (uint32_t i = 0; i < items.size(); ++i) {
    if (!items[i].moving || instances_[i].value == 0) continue;
    const glm::mat4& matrix = pose.instances[items[i].instance].world_from_mesh;
    if (matrix == transforms_[i]) continue;
    transforms_[i] = matrix;
    changed_instances_.push_back(instances_[i]);
    changed_transforms_.push_back(affine(matrix));
  }
  if (!changed_instances_.empty()) {
    if (auto set = system_.set_transforms(changed_instances_, changed_transforms_); !set) return set.error();
  }
  changed_instances_.clear();
  for (const uint32_t item : deformed) {
    if (instances_[item].value != 0) changed_instances_.push_back(instances_[item]);
  }
  return changed_instances_.empty() ? Result<void>() : system_.mark_deformed(changed_instances_);
}

Result<void> ShadowScene::set_lights(std::span<const ActiveLight> lights) {
  std::vector<umbrage::LightId> changed;
  std::vector<umbrage::LightDesc> changed_descs;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const umbrage::LightDesc desc = light_desc(lights[i], i);
    if (i < lights_.size() && desc.type == light_descs_[i].type) {
      if (same(desc, light_descs_[i])) continue;
      changed.push_back(lights_[i]);
      changed_descs.push_back(desc);
      light_descs_[i] = desc;
      continue;
    }
    auto added = system_.add_light(desc);
    if (!added) return added.error();
    if (i < lights_.size()) {
      if (auto removed = system_.remove(std::exchange(lights_[i], *added)); !removed) return removed.error();
      light_descs_[i] = desc;
    } else {
      lights_.push_back(*added);
      light_descs_.push_back(desc);
    }
  }
  while (lights_.size() > lights.size()) {
    if (auto removed = system_.remove(lights_.back()); !removed) return removed.error();
    lights_.pop_back();
    light_descs_.pop_back();
  }
  return changed.empty() ? Result<void>() : system_.set_lights(changed, changed_descs);
}

}  // namespace app
