// The scene at a time: animated transforms and weights, world matrices, joints, and deformation on the CPU.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

#include "import/scene.hpp"

namespace app {
namespace {

/// What animations may change of a node.
struct LocalPose {
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  std::vector<float> weights;
};

size_t value_width(const Channel& channel) {
  const size_t values_per_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  return channel.values.size() / (channel.times.size() * values_per_key);
}

glm::quat quaternion(std::span<const float> v) { return glm::quat(v[3], v[0], v[1], v[2]); }

void store(const glm::quat& q, std::span<float> out) { out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w; }

/// Unit length; what has none becomes no rotation.
glm::quat unit(const glm::quat& q) {
  const float length = glm::length(q);
  return length > 0 ? q / length : glm::quat(1, 0, 0, 0);
}

/// Cubic Hermite spline of glTF: tangents are per second.
void hermite(const Channel& channel, size_t key, float u, float seconds, std::span<float> out) {
  const size_t width = out.size();
  const float* from = channel.values.data() + key * 3 * width;
  const float* to = from + 3 * width;
  const float u2 = u * u, u3 = u2 * u;
  for (size_t i = 0; i < width; ++i) {
    const float value = from[width + i], out_tangent = from[2 * width + i] * seconds;
    const float next_value = to[width + i], in_tangent = to[i] * seconds;
    out[i] = (2 * u3 - 3 * u2 + 1) * value + (u3 - 2 * u2 + u) * out_tangent + (3 * u2 - 2 * u3) * next_value +
             (u3 - u2) * in_tangent;
  }
}

/// The channel's value at a time; before the first and after the last key it stays.
void sample(const Channel& channel, float time, std::span<float> out) {
  const size_t width = out.size();
  const bool cubic = channel.interpolation == Interpolation::cubic_spline;
  const auto value_of = [&](size_t key) {
    return std::span(channel.values).subspan((cubic ? 3 * key + 1 : key) * width, width);
  };
  const auto after = static_cast<size_t>(std::ranges::upper_bound(channel.times, time) - channel.times.begin());
  if (after == 0 || after == channel.times.size() || channel.interpolation == Interpolation::step) {
    std::ranges::copy(value_of(after == 0 ? 0 : after - 1), out.begin());
    return;
  }
  const size_t key = after - 1;
  const float seconds = channel.times[after] - channel.times[key];
  const float u = (time - channel.times[key]) / seconds;
  if (cubic) {
    hermite(channel, key, u, seconds, out);
  } else if (channel.path == AnimatedPath::rotation) {
    store(glm::slerp(unit(quaternion(value_of(key))), unit(quaternion(value_of(after))), u), out);
  } else {
    for (size_t i = 0; i < width; ++i) out[i] = value_of(key)[i] * (1 - u) + value_of(after)[i] * u;
  }
}

void apply(const Channel& channel, float time, LocalPose& local) {
  std::vector<float> value(value_width(channel));
  sample(channel, time, value);
  switch (channel.path) {
    case AnimatedPath::translation:
      local.translation = {value[0], value[1], value[2]};
      break;
    case AnimatedPath::rotation:
      local.rotation = unit(quaternion(value));
      break;
    case AnimatedPath::scale:
      local.scale = {value[0], value[1], value[2]};
      break;
    case AnimatedPath::weights:
      local.weights = std::move(value);
      break;
  }
}

/// Time within an animation that repeats after its duration.
float looped(double time_s, float duration) {
  if (duration <= 0) return 0;
  const double time = std::fmod(time_s, static_cast<double>(duration));
  return static_cast<float>(time < 0 ? time + static_cast<double>(duration) : time);
}

std::vector<LocalPose> local_poses(const Scene& scene, double time_s) {
  std::vector<LocalPose> locals(scene.nodes.size());
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    locals[i] = {node.translation, node.rotation, node.scale, node.weights};
    if (node.weights.empty() && node.mesh >= 0)
      locals[i].weights = scene.meshes[static_cast<size_t>(node.mesh)].weights;
  }
  for (const Animation& animation : scene.animations) {
    const float time = looped(time_s, animation.duration);
    for (const Channel& channel : animation.channels) apply(channel, time, locals[channel.node]);
  }
  return locals;
}

std::vector<glm::mat4> world_matrices(const Scene& scene, const std::vector<LocalPose>& locals) {
  std::vector<glm::mat4> worlds(scene.nodes.size());
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    const glm::mat4 local = node.matrix
                                ? *node.matrix
                                : glm::translate(glm::mat4(1), locals[i].translation) *
                                      glm::mat4_cast(locals[i].rotation) * glm::scale(glm::mat4(1), locals[i].scale);
    worlds[i] = node.parent < 0 ? local : worlds[static_cast<size_t>(node.parent)] * local;
  }
  return worlds;
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : fallback;
}

/// The matrix without scale and shear. Its back axis is kept, so it looks where the matrix looks.
glm::mat4 rigid(const glm::mat4& m) {
  const glm::vec3 back = unit_or(glm::vec3(m[2]), {0, 0, 1});
  const glm::vec3 any_up = std::abs(back.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 fallback = unit_or(glm::cross(any_up, back), {1, 0, 0});
  const glm::vec3 right = unit_or(glm::cross(glm::vec3(m[1]), back), fallback);
  return {glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0),
          glm::vec4(glm::vec3(m[3]), 1)};
}

PosedLight pose_light(const Light& light, const Node& node, const glm::mat4& world) {
  return {.name = node.name.empty() ? light.name : node.name,
          .kind = light.kind,
          .position = glm::vec3(world[3]),
          .direction = unit_or(-glm::vec3(world[2]), {0, 0, -1}),
          .color = light.color,
          .intensity = light.intensity,
          .range = light.range,
          .inner_cone = light.inner_cone,
          .outer_cone = light.outer_cone};
}

PosedCamera pose_camera(const Camera& camera, const Node& node, const glm::mat4& world) {
  return {.name = node.name.empty() ? camera.name : node.name, .lens = camera, .world_from_camera = rigid(world)};
}

std::vector<glm::mat4> pose_skin(const Skin& skin, const std::vector<glm::mat4>& worlds) {
  std::vector<glm::mat4> matrices(skin.joints.size());
  for (size_t j = 0; j < matrices.size(); ++j) matrices[j] = worlds[skin.joints[j]] * skin.inverse_bind[j];
  return matrices;
}

/// A channel whose value is the same at all times does not move anything.
bool varies(const Channel& channel) {
  if (channel.times.size() < 2) return false;
  const size_t width = value_width(channel);
  for (size_t i = width; i < channel.values.size(); ++i) {
    if (channel.values[i] != channel.values[i - width]) return true;
  }
  return channel.interpolation == Interpolation::cubic_spline &&
         std::ranges::any_of(channel.values, [](float v) { return v != 0; });
}

}  // namespace

Pose pose(const Scene& scene, double time_s) {
  std::vector<LocalPose> locals = local_poses(scene, time_s);
  const std::vector<glm::mat4> worlds = world_matrices(scene, locals);
  Pose result;
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (node.mesh >= 0) {
      PosedInstance instance{.node = static_cast<uint32_t>(i), .mesh = static_cast<uint32_t>(node.mesh)};
      instance.weights = std::move(locals[i].weights);
      if (node.skin >= 0) {
        instance.skin = static_cast<int>(result.joint_matrices.size());
        result.joint_matrices.push_back(pose_skin(scene.skins[static_cast<size_t>(node.skin)], worlds));
      } else {
        instance.world_from_mesh = worlds[i];
      }
      result.instances.push_back(std::move(instance));
    }
    if (node.light >= 0)
      result.lights.push_back(pose_light(scene.lights[static_cast<size_t>(node.light)], node, worlds[i]));
    if (node.camera >= 0) {
      result.cameras.push_back(pose_camera(scene.cameras[static_cast<size_t>(node.camera)], node, worlds[i]));
    }
  }
  return result;
}

std::vector<bool> moving_nodes(const Scene& scene) {
  std::vector<bool> transform_moves(scene.nodes.size()), weights_move(scene.nodes.size());
  for (const Animation& animation : scene.animations) {
    for (const Channel& channel : animation.channels) {
      auto& moves = channel.path == AnimatedPath::weights ? weights_move : transform_moves;
      if (varies(channel)) moves[channel.node] = true;
    }
  }
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const int parent = scene.nodes[i].parent;
    if (parent >= 0 && transform_moves[static_cast<size_t>(parent)]) transform_moves[i] = true;
  }
  std::vector<bool> moving(scene.nodes.size());
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const int skin = scene.nodes[i].skin;
    const auto joint_moves = [&](uint32_t joint) { return transform_moves[joint]; };
    // A skinned mesh follows its joints alone, not its node.
    const bool shape_moves =
        skin < 0 ? transform_moves[i] : std::ranges::any_of(scene.skins[static_cast<size_t>(skin)].joints, joint_moves);
    moving[i] = shape_moves || weights_move[i];
  }
  return moving;
}

std::vector<glm::vec3> deformed_positions(const Primitive& primitive, const PosedInstance& instance, const Pose& pose) {
  std::vector<glm::vec3> positions = primitive.positions;
  for (size_t t = 0; t < primitive.targets.size() && t < instance.weights.size(); ++t) {
    const std::vector<glm::vec3>& deltas = primitive.targets[t].positions;
    for (size_t v = 0; v < deltas.size(); ++v) positions[v] += instance.weights[t] * deltas[v];
  }
  if (instance.skin < 0 || primitive.joints.empty()) return positions;
  const std::vector<glm::mat4>& joints = pose.joint_matrices[static_cast<size_t>(instance.skin)];
  for (size_t v = 0; v < positions.size(); ++v) {
    glm::vec3 skinned(0);
    for (int k = 0; k < 4; ++k) {
      const float weight = primitive.weights[v][k];
      if (weight > 0) skinned += weight * glm::vec3(joints[primitive.joints[v][k]] * glm::vec4(positions[v], 1));
    }
    positions[v] = skinned;
  }
  return positions;
}

}  // namespace app
