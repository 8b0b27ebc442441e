// A scene as the program holds it: what glTF says, decoded and checked, and no Vulkan. Importers and built-in scenes make it;
// pose() evaluates it at a time; the host renderer and the ray tracer read the pose.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "import/material.hpp"

namespace app {

struct MorphTarget {
  std::vector<glm::vec3> positions, normals;  ///< Deltas; either empty or one per vertex.
};

/// Triangles of one material. Every array is empty or has one element per position; indices are in range.
struct Primitive {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   ///< Always filled by importers (flat ones made where the file has none).
  std::vector<glm::vec4> tangents;  ///< w = handedness; empty: the renderer derives them where needed.
  std::vector<glm::vec2> uv[2];
  std::vector<glm::vec4> colors;
  std::vector<glm::u16vec4> joints;  ///< With weights that sum to 1.
  std::vector<glm::vec4> weights;
  std::vector<uint32_t> indices;  ///< Triangle list.
  std::vector<MorphTarget> targets;
  uint32_t material = 0;  ///< Into Scene::materials (importers add a default one).
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> weights;  ///< Default morph weights, one per target.
};

struct Skin {
  std::vector<uint32_t> joints;         ///< Node indices.
  std::vector<glm::mat4> inverse_bind;  ///< One per joint.
};

enum class LightKind : uint8_t { point, spot, directional };

/// KHR_lights_punctual: shines along -Z of its node.
struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  glm::vec3 color{1};
  float intensity = 1;  ///< Candela; lux for directional.
  float range =
      std::numeric_limits<float>::infinity();     ///< Infinite: the renderer finds one from its irradiance threshold.
  float inner_cone = 0, outer_cone = 0.7853982f;  ///< Half-angles, radians.
};

struct Camera {
  std::string name;
  bool orthographic = false;
  float fov_y = 0.9f;                     ///< Radians.
  float aspect = 0;                       ///< 0: that of the picture.
  float half_width = 1, half_height = 1;  ///< Orthographic.
  float near = 0.1f;
  float far = std::numeric_limits<float>::infinity();
};

struct Node {
  std::string name;
  int parent = -1;  ///< Parents come before children.
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  std::optional<glm::mat4> matrix;  ///< Instead of translation, rotation, scale; never animated.
  int mesh = -1, skin = -1, camera = -1, light = -1;
  std::vector<float> weights;  ///< Empty: the mesh's.
};

enum class Interpolation : uint8_t { step, linear, cubic_spline };
enum class AnimatedPath : uint8_t { translation, rotation, scale, weights };

struct Channel {
  uint32_t node = 0;
  AnimatedPath path = AnimatedPath::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;   ///< Strictly increasing seconds.
  std::vector<float> values;  ///< times.size() × width floats (× 3 for cubic splines: in-tangent, value, out-tangent).
};

struct Animation {
  std::string name;
  std::vector<Channel> channels;
  float duration = 0;  ///< Largest key time. Animations loop.
};

struct Scene {
  std::string name;
  std::vector<Image> images;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Skin> skins;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::vector<Node> nodes;            ///< Only those of the scene shown.
  std::vector<Animation> animations;  ///< All play at once.
};

/// Triangles of one node's mesh in the world.
struct PosedInstance {
  uint32_t node = 0, mesh = 0;
  glm::mat4 world_from_mesh{1};  ///< Identity for skinned meshes (their joints say it all).
  int skin = -1;                 ///< Into Pose::joint_matrices.
  std::vector<float> weights;    ///< Morph weights; empty: not morphed.
};

struct PosedLight {
  std::string name;
  LightKind kind = LightKind::point;
  glm::vec3 position{0}, direction{0, 0, -1};  ///< World; direction unit length.
  glm::vec3 color{1};
  float intensity = 1;
  float range = std::numeric_limits<float>::infinity();
  float inner_cone = 0, outer_cone = 0.7853982f;
  uint32_t faces = 0x3f;  ///< Of a point light, what it shines through: umbrage::LightDesc::faces.
};

struct PosedCamera {
  std::string name;
  Camera lens;
  glm::mat4 world_from_camera{1};  ///< Looks along -Z, rigid.
};

/// The scene at a time. Arrays keep their order and length over time (instances by node, lights by node).
struct Pose {
  std::vector<PosedInstance> instances;
  std::vector<PosedLight> lights;
  std::vector<PosedCamera> cameras;
  std::vector<std::vector<glm::mat4>>
      joint_matrices;  ///< Per instance with a skin: world from mesh-bind space, one per joint.
};

Pose pose(const Scene& scene, double time_s);
/// True if anything of the node's instances may differ between two times (animated ancestors, skin, morph).
std::vector<bool> moving_nodes(const Scene& scene);
/// CPU deformation of one primitive of a posed instance: mesh-space positions (world-space when skinned), morph then skin.
std::vector<glm::vec3> deformed_positions(const Primitive&, const PosedInstance&, const Pose&);

}  // namespace app
