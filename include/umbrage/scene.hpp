// What a host says about its scene: meshes, instances, lights. The library consumes positions and triangles only.
#pragma once
#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <limits>
#include <span>

#include "umbrage/types.hpp"

namespace umbrage {

/// A strided array in the host's device memory, read by the library's shaders. The host makes its contents visible to
/// compute and vertex shaders before record_scene. address = 0: none. Elements are tightly typed 32-bit floats:
/// three for positions, two for texture coordinates. address and stride are multiples of 4.
struct Stream {
  VkDeviceAddress address = 0;
  uint32_t stride_bytes = 12;
};

/// A mesh has no more levels of detail.
inline constexpr uint32_t MaxMeshLevels = 16;

/// A range of a mesh's triangles with one alpha mask.
struct Submesh {
  uint32_t first_index = 0;   ///< Into MeshDesc::indices; a multiple of 3.
  uint32_t index_count = 0;   ///< A multiple of 3.
  MaskId mask;                ///< 0: opaque.
  float alpha_cutoff = 0.5f;  ///< Texels with alpha below it do not cast (glTF alphaMode MASK).
  float alpha_factor = 1.0f;  ///< Multiplies the sampled alpha (glTF baseColorFactor.a).
  uint32_t first_level = 0;   ///< Of MeshDesc::level_errors_m: the levels that it is part of, first_level … last_level.
  uint32_t last_level = MaxMeshLevels - 1;
};

/// A triangle mesh. Spans are read during add_mesh only; device streams must outlive the mesh.
struct MeshDesc {
  std::span<const Vec3> positions;       ///< Mesh space; finite. Always needed: batches are built from them.
  std::span<const uint32_t> indices;     ///< Triangle list, each < positions.size().
  std::span<const Vec2> uvs;             ///< For masked submeshes: one per position. Empty when nothing is masked.
  Stream device_positions;               ///< The host's own copy, used instead of one of the library's.
  Stream device_uvs;                     ///< Likewise.
  std::span<const Submesh> submeshes;    ///< Cover indices without overlap; empty = one opaque submesh.
  /// Levels of detail, the finest first: how far the surface of each lies from the finest at most, mesh space; 0, then more from
  /// level to level; up to MaxMeshLevels. Empty = one level. A map of the page pool and the other virtual stores gets the
  /// coarsest level that is off by FrameSettings::caster_error_percent of its texel at most where the instance is nearest to
  /// the light; instances with a deformed stream, fixed cubes and cascades get the finest.
  /// A level that no submesh is part of has no triangles.
  std::span<const float> level_errors_m;
  std::span<const std::byte> prepared;   ///< From prepare_mesh (prepare.hpp) for the same triangles; empty = prepared here.
};

enum class Mobility : uint8_t {
  fixed,    ///< Never moves; set_transforms on it is refused.
  movable,  ///< May move in any frame.
};

struct InstanceDesc {
  MeshId mesh;
  Affine world_from_mesh;               ///< Any invertible affine map, mirroring included.
  Mobility mobility = Mobility::fixed;
  uint32_t light_mask = 0xffffffffu;    ///< Casts for a light when (light_mask & LightDesc::light_mask) != 0.
  Stream deformed;                      ///< Mesh-space positions of this instance alone (skinned, displaced); announce changes by mark_deformed.
  bool casts = true;
};

enum class LightType : uint8_t { point, spot, directional };

/// A light. Colour and intensity stay with the host; host_index finds them again in the shader.
struct LightDesc {
  LightType type = LightType::point;
  Vec3 position;                        ///< World space. Unused by directional lights.
  Vec3 direction{0, 0, -1};             ///< Where the light shines, any length > 0. Unused by point lights.
  float range_m = 10.0f;                ///< Nothing farther away is lit. > 0 and finite; unused by directional lights.
  float inner_cone_rad = 0.0f;          ///< Half-angle, 0 <= inner <= outer.
  float outer_cone_rad = 0.7853982f;    ///< Half-angle, 0 < outer <= pi/2.
  uint32_t faces = 0x3f;                ///< What a point light shines through of the world's cube around it: bits 0…5 are its faces +x, -x,
                                        ///< +y, -y, +z, -z; 1…63. Beyond the others it is dark and costs nothing. Unused by other types.
  float near_m = 0.0f;                  ///< Casters nearer than this (axis depth) cast no shadow; 0 = range_m / 256.
  float priority = 1.0f;                ///< Larger keeps its quality longer when memory is short.
  bool casts_shadow = true;
  uint32_t light_mask = 0xffffffffu;
  uint32_t max_resolution = 0;          ///< Texels along a face's side; 0 = no limit of its own.
  uint32_t host_index = 0;              ///< Returned by umbrage_light() in the shader.
};

}  // namespace umbrage
