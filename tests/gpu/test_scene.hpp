// Small generated scenes with every kind of light and caster, and pictures of receivers to go with them.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "clusters/cluster_types.shared.h"
#include "umbrage/frame.hpp"
#include "umbrage/scene.hpp"

namespace umbrage::test {

struct TestMesh {
  std::vector<Vec3> positions;
  std::vector<Vec2> uvs;  ///< Empty: opaque; else the whole mesh has the rig's mask.
  std::vector<uint32_t> indices;
  std::vector<Submesh> submeshes;     ///< Empty: one.
  std::vector<float> level_errors_m;  ///< Empty: one level.
};

/// A sphere of radius 1.
TestMesh sphere_mesh(uint32_t rings, uint32_t segments);
/// A box of half extent 1.
TestMesh box_mesh();
/// A square of half side 1 in the xz plane, in cells × cells quads.
TestMesh plane_mesh(uint32_t cells);
/// plane_mesh with texture coordinates 0…1.
TestMesh masked_mesh();

/// Meshes of `parts`, each of some levels of detail.
struct LevelRange {
  uint32_t first = 0, last = MaxMeshLevels - 1;
};
TestMesh mesh_of_levels(std::span<const TestMesh> parts, std::span<const LevelRange>, std::span<const float> errors_m);
/// sphere_mesh in four levels, of 32 rings, 16, 8 and 4.
TestMesh sphere_in_levels();
/// Its finest level alone.
TestMesh finest_of(const TestMesh&);

struct TestInstance {
  uint32_t mesh = 0;
  Affine world_from_mesh;
  Mobility mobility = Mobility::movable;
  uint32_t light_mask = 0xffffffffu;
  bool casts = true;
};

struct TestScene {
  std::vector<TestMesh> meshes;
  std::vector<TestInstance> instances;
  std::vector<LightDesc> lights;
};

Affine affine(const glm::mat3& linear, const glm::vec3& translation);
/// Any rotation, sizes 0.2…1.2 along each axis, one in four mirrored.
Affine random_affine(uint32_t seed, const glm::vec3& translation);
glm::vec3 transform(const Affine&, const Vec3&);
inline Vec3 to_vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }
inline glm::vec3 to_glm(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Spheres, boxes and masked cards above the ground (y = 0, -12…12), and `lights` lights: mostly points of 1…6 m, some
/// spots of any width, two suns, some that cast nothing, some with masks and resolutions of their own.
TestScene mixed_scene(uint32_t instances, uint32_t lights, uint32_t seed);

// --- Cameras and receivers ------------------------------------------------------------------------------------------

/// From `eye` towards `target`, reversed infinite depth with near plane 0.1, 60° high. Images are the rig's.
CameraDesc perspective_camera(const glm::vec3& eye, const glm::vec3& target, uint32_t width, uint32_t height);
/// The same with a far plane, 0 at the near plane.
CameraDesc finite_camera(const glm::vec3& eye, const glm::vec3& target, uint32_t width, uint32_t height, float far_m);
CameraDesc orthographic_camera(const glm::vec3& eye, const glm::vec3& target, uint32_t width, uint32_t height,
                               float half_height, float far_m);

struct Surface {
  float t = 0;  ///< View depth.
  glm::vec3 normal{0, 1, 0};
};
/// What a camera's ray origin + t · direction meets.
using Receiver = std::function<std::optional<Surface>(const glm::vec3& origin, const glm::vec3& direction)>;

/// The ground and a few balls on it; sky above.
std::optional<Surface> balls_on_ground(const glm::vec3& origin, const glm::vec3& direction);

/// A picture of receivers, row by row: what the host would have drawn.
struct Receivers {
  uint32_t width = 0, height = 0;
  std::vector<float> depth;  ///< 0: background.
  std::vector<glm::vec4> normals;
  std::vector<float> t;  ///< View depth as the shaders compute it from `depth`.
  std::vector<glm::vec3> positions;
};
Receivers picture(const CameraDesc&, const Receiver&);

}  // namespace umbrage::test
