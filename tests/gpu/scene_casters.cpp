#include "scene_casters.hpp"

namespace umbrage::test {

SceneCasters add_casters(Gpu& gpu, scene::GpuScene& scene, const TestScene& test_scene) {
  constexpr uint32_t side = 16;
  SceneCasters casters{.mask = Image(gpu, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, side, side),
                       .meshes = {},
                       .instances = {}};
  std::vector<uint32_t> checkers(side * side);
  for (uint32_t i = 0; i < checkers.size(); ++i) checkers[i] = (i / 4 + i / (4 * side)) % 2 ? 0xffffffffu : 0x00ffffffu;
  gpu.fill(casters.mask, checkers.data(), checkers.size() * sizeof(uint32_t), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  gpu.set_mask(0, casters.mask);
  const MaskId mask = take(scene.add_mask(casters.mask.view(), VK_NULL_HANDLE));
  for (const TestMesh& mesh : test_scene.meshes) {
    const Submesh masked{.index_count = static_cast<uint32_t>(mesh.indices.size()), .mask = mask};
    MeshDesc desc{.positions = mesh.positions, .indices = mesh.indices, .uvs = mesh.uvs};
    if (!mesh.uvs.empty()) desc.submeshes = {&masked, 1};
    casters.meshes.push_back(take(scene.add_mesh(desc)));
  }
  for (const TestInstance& instance : test_scene.instances)
    casters.instances.push_back(take(scene.add_instance({.mesh = casters.meshes[instance.mesh],
                                                         .world_from_mesh = instance.world_from_mesh,
                                                         .mobility = instance.mobility})));
  return casters;
}

}  // namespace umbrage::test
