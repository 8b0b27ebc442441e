// Samplers and channels, each channel with its own copy of the keys.
#include "import/gltf_animations.hpp"

#include <algorithm>
#include <optional>

#include "import/gltf_fault.hpp"

namespace app::gltf {
namespace {

std::optional<AnimatedPath> path_of(const std::string& name) {
  if (name == "translation") return AnimatedPath::translation;
  if (name == "rotation") return AnimatedPath::rotation;
  if (name == "scale") return AnimatedPath::scale;
  if (name == "weights") return AnimatedPath::weights;
  return std::nullopt;
}

Interpolation interpolation_of(const std::string& name, const std::string& where) {
  if (name == "STEP") return Interpolation::step;
  if (name == "LINEAR" || name.empty()) return Interpolation::linear;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  refuse(where, ".interpolation: must be STEP, LINEAR or CUBICSPLINE");
}

std::vector<float> read_times(Accessors& accessors, int input, const std::string& where) {
  std::vector<float> times = accessors.floats(input, 1, Numbers::floats, where);
  if (times.empty()) refuse(where, ": has no keys");
  if (times.front() < 0) refuse(where, ": time ", times.front(), " is negative");
  for (size_t i = 1; i < times.size(); ++i) {
    if (times[i] <= times[i - 1]) refuse(where, ": times must increase, ", times[i], " follows ", times[i - 1]);
  }
  return times;
}

/// Numbers of one key's value.
size_t width_of(AnimatedPath path, const Node& node, const Scene& scene, const std::string& where) {
  if (path != AnimatedPath::weights && node.matrix) refuse(where, ": animates a node that has a matrix");
  if (path == AnimatedPath::rotation) return 4;
  if (path != AnimatedPath::weights) return 3;
  const size_t targets = node.mesh < 0 ? 0 : scene.meshes[static_cast<size_t>(node.mesh)].weights.size();
  if (targets == 0) refuse(where, ": animates weights of a node without morph targets");
  return targets;
}

/// Nothing: a channel of something that is not shown, not known or without data.
std::optional<Channel> import_channel(Accessors& accessors, const tinygltf::Animation& animation,
                                      const tinygltf::AnimationChannel& source, const NodeMap& map, const Scene& scene,
                                      const std::string& where) {
  if (source.sampler < 0 || static_cast<size_t>(source.sampler) >= animation.samplers.size()) {
    refuse(where, ": samplers[", source.sampler, "] is not in the animation");
  }
  if (static_cast<size_t>(source.target_node) >= map.size()) {
    refuse(where, ": nodes[", source.target_node, "] is not in the file");
  }
  const std::optional<AnimatedPath> path = path_of(source.target_path);
  const int node = map[static_cast<size_t>(source.target_node)];
  if (!path || node < 0) return std::nullopt;

  const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<size_t>(source.sampler)];
  if (!accessors.has_data(sampler.input, where + ": input") ||
      !accessors.has_data(sampler.output, where + ": output")) {
    return std::nullopt;
  }
  Channel channel{.node = static_cast<uint32_t>(node), .path = *path};
  channel.interpolation = interpolation_of(sampler.interpolation, where);
  channel.times = read_times(accessors, sampler.input, where + ": input");
  const bool cubic = channel.interpolation == Interpolation::cubic_spline;
  if (cubic && channel.times.size() < 2) refuse(where, ": a cubic spline needs two keys");

  // Weights are stored as scalars, several to a key; everything else as one vector.
  const size_t width = width_of(*path, scene.nodes[channel.node], scene, where);
  const size_t expected = channel.times.size() * (cubic ? 3 : 1) * (*path == AnimatedPath::weights ? width : 1);
  if (const size_t count = accessors.count(sampler.output, where + ": output"); count != expected) {
    refuse(where, ": output has ", count, " elements; its ", channel.times.size(), " keys need ", expected);
  }
  const auto components = static_cast<uint32_t>(*path == AnimatedPath::weights ? 1 : width);
  channel.values = accessors.floats(sampler.output, components, Numbers::reals, where + ": output");
  return channel;
}

}  // namespace

std::vector<Animation> import_animations(const Model& model, Accessors& accessors, const NodeMap& map,
                                         const Scene& scene) {
  std::vector<Animation> animations;
  for (size_t a = 0; a < model.parsed.animations.size(); ++a) {
    const tinygltf::Animation& source = model.parsed.animations[a];
    Animation animation{.name = source.name};
    for (size_t c = 0; c < source.channels.size(); ++c) {
      const std::string where = place(place("animations", a) + ".channels", c);
      auto channel = import_channel(accessors, source, source.channels[c], map, scene, where);
      if (!channel) continue;
      animation.duration = std::max(animation.duration, channel->times.back());
      animation.channels.push_back(std::move(*channel));
    }
    if (!animation.channels.empty()) animations.push_back(std::move(animation));
  }
  return animations;
}

}  // namespace app::gltf
