// A scene, posed, as umbrage::LayeredScene takes it: one instance for each primitive of each node.
#pragma once
#include <optional>
#include <vector>

#include "import/scene.hpp"
#include "umbrage/layered_pass.hpp"

namespace app {

class TextureTable;

/// What the meshes' spans refer to.
struct LayeredArrays {
  struct Mesh {
    std::vector<umbrage::Vec3> positions, normals;
    std::vector<umbrage::Vec2> uvs;
    std::vector<umbrage::LayeredSkin> skin;
    std::vector<uint32_t> indices;
    umbrage::Submesh submesh;
  };
  std::vector<Mesh> meshes;
  std::vector<umbrage::LayeredInstance> instances;
  std::vector<umbrage::LayeredMask> masks;
  std::vector<uint32_t> materials;  ///< Of host_index: the scene's material of each instance.
  std::vector<uint32_t> posed;      ///< Likewise: which of Pose::instances it is.

  umbrage::Result<umbrage::LayeredScene> create(const umbrage::DeviceDesc&) const;
};

umbrage::Affine affine_rows(const glm::mat4&);
umbrage::Mat4 mat4(const glm::mat4&);

/// Not blended, and not only glowing (skies, lamps): those neither cast nor reflect light.
bool is_solid(const Material&);

LayeredArrays::Mesh layered_mesh(const Primitive&, const Material&, std::span<const glm::vec3> positions,
                                 umbrage::MaskId mask);

struct LayeredChoice {
  bool glowing = false;   ///< What only glows is taken, too.
  int without_mesh = -1;  ///< Of the scene.
};
/// Skinned and morphed meshes are taken as they are posed. textures (may be null: masked materials become opaque) outlives
/// what is made of it. What is not solid is left out.
LayeredArrays layered_arrays(const Scene&, const Pose&, const TextureTable* textures, const LayeredChoice& = {});

}  // namespace app
