// Nodes in depth-first order, so that parents come before children, and skins.
#include "import/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "import/gltf_fault.hpp"
#include "import/gltf_limits.hpp"

namespace app::gltf {
namespace {

/// Per node of the file its parent, or -1. Refuses nodes with two parents and, as no root leads to them, cycles.
std::vector<int> parents_of(const std::vector<tinygltf::Node>& nodes) {
  std::vector<int> parents(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      if (static_cast<size_t>(child) >= nodes.size())
        refuse(place("nodes", i), ": child nodes[", child, "] is not in the file");
      int& parent = parents[static_cast<size_t>(child)];
      if (parent >= 0)
        refuse(place("nodes", static_cast<size_t>(child)), ": is a child of nodes[", parent, "] and of nodes[", i, "]");
      parent = static_cast<int>(i);
    }
  }
  // With one parent each, a node is in a cycle or below one exactly if no root reaches it.
  std::vector<int> reached;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (parents[i] < 0) reached.push_back(static_cast<int>(i));
  }
  for (size_t i = 0; i < reached.size(); ++i) {
    for (const int child : nodes[static_cast<size_t>(reached[i])].children) reached.push_back(child);
  }
  if (reached.size() < nodes.size()) {
    std::ranges::sort(reached);
    size_t lost = 0;
    while (lost < reached.size() && reached[lost] == static_cast<int>(lost)) ++lost;
    refuse(place("nodes", lost), ": is its own ancestor, or below such a node");
  }
  return parents;
}

/// Root nodes of the scene shown.
std::vector<int> roots_of(const tinygltf::Model& model, const std::vector<int>& parents, std::string& name) {
  if (model.scenes.empty()) {
    std::vector<int> roots;
    for (size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] < 0) roots.push_back(static_cast<int>(i));
    }
    return roots;
  }
  const size_t shown = model.defaultScene < 0 ? 0 : static_cast<size_t>(model.defaultScene);
  if (shown >= model.scenes.size()) refuse("scene: scenes[", shown, "] is not in the file");
  name = model.scenes[shown].name;
  const std::vector<int>& roots = model.scenes[shown].nodes;
  std::vector<bool> listed(parents.size());
  for (const int root : roots) {
    const auto i = static_cast<size_t>(root);
    if (i >= parents.size()) refuse(place("scenes", shown), ": nodes[", root, "] is not in the file");
    if (parents[i] >= 0) refuse(place("scenes", shown), ": nodes[", root, "] is not a root: it has a parent");
    if (listed[i]) refuse(place("scenes", shown), ": nodes[", root, "] is listed twice");
    listed[i] = true;
  }
  return roots;
}

int checked_reference(int index, size_t count, const std::string& where, std::string_view list) {
  if (index >= 0 && static_cast<size_t>(index) >= count) refuse(where, ": ", list, "[", index, "] is not in the file");
  return index;
}

void import_transform(const tinygltf::Node& source, const std::string& where, Node& node) {
  if (!source.matrix.empty()) {
    glm::mat4 matrix;
    for (int i = 0; i < 16; ++i)
      matrix[i / 4][i % 4] = finite_float(source.matrix[static_cast<size_t>(i)], where + ".matrix");
    if (matrix[0].w != 0 || matrix[1].w != 0 || matrix[2].w != 0 || matrix[3].w != 1) {
      refuse(where, ".matrix: its last row must be 0 0 0 1");
    }
    node.matrix = matrix;
    return;
  }
  const auto vector = [&](const std::vector<double>& v, const char* key) {
    glm::vec3 result;
    for (int c = 0; c < 3; ++c) result[c] = finite_float(v[static_cast<size_t>(c)], where + "." + key);
    return result;
  };
  if (!source.translation.empty()) node.translation = vector(source.translation, "translation");
  if (!source.scale.empty()) node.scale = vector(source.scale, "scale");
  if (!source.rotation.empty()) {
    const std::vector<double>& q = source.rotation;  // x, y, z, w
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0) || !std::isfinite(length)) refuse(where, ".rotation: must be a unit quaternion");
    node.rotation = glm::quat(glm::dquat(q[3] / length, q[0] / length, q[1] / length, q[2] / length));
  }
}

Node import_node(const Model& model, const Scene& scene, size_t index) {
  const tinygltf::Node& source = model.parsed.nodes[index];
  const std::string where = place("nodes", index);
  Node node{.name = source.name};
  import_transform(source, where, node);
  node.mesh = checked_reference(source.mesh, scene.meshes.size(), where, "meshes");
  node.skin = checked_reference(source.skin, model.parsed.skins.size(), where, "skins");
  node.camera = checked_reference(source.camera, scene.cameras.size(), where, "cameras");
  if (const tinygltf::Value* light = extension(source.extensions, "KHR_lights_punctual")) {
    node.light =
        checked_reference(static_cast<int>(number_of(*light, "light", -1)), scene.lights.size(), where, "lights");
  }
  const size_t targets = node.mesh >= 0 ? scene.meshes[static_cast<size_t>(node.mesh)].weights.size() : 0;
  if (!source.weights.empty() && source.weights.size() != targets) {
    refuse(where, ".weights: has ", source.weights.size(), " elements for ", targets, " morph targets");
  }
  for (const double weight : source.weights) node.weights.push_back(finite_float(weight, where + ".weights"));
  return node;
}

/// Joints of a skin must be at least this many for a mesh; 0: not every primitive is skinned.
std::vector<size_t> joints_needed(const std::vector<Mesh>& meshes) {
  std::vector<size_t> needed;
  for (const Mesh& mesh : meshes) {
    size_t joints = 0;
    bool all_skinned = true;
    for (const Primitive& primitive : mesh.primitives) {
      all_skinned = all_skinned && !primitive.joints.empty();
      for (size_t v = 0; v < primitive.joints.size(); ++v) {
        for (int k = 0; k < 4; ++k) {
          if (primitive.weights[v][k] > 0) joints = std::max(joints, size_t{primitive.joints[v][k]} + 1);
        }
      }
    }
    needed.push_back(all_skinned ? joints : 0);
  }
  return needed;
}

Skin import_skin(const Model& model, Accessors& accessors, const NodeMap& map, size_t index) {
  const tinygltf::Skin& source = model.parsed.skins[index];
  const std::string where = place("skins", index);
  Skin skin;
  for (const int joint : source.joints) {
    checked_reference(joint, map.size(), where, "nodes");
    if (map[static_cast<size_t>(joint)] < 0)
      refuse(where, ": joint nodes[", joint, "] is not in the scene that uses the skin");
    skin.joints.push_back(static_cast<uint32_t>(map[static_cast<size_t>(joint)]));
  }
  skin.inverse_bind.assign(skin.joints.size(), glm::mat4(1));
  if (source.inverseBindMatrices < 0) return skin;
  const std::string matrices = where + ".inverseBindMatrices";
  if (accessors.count(source.inverseBindMatrices, matrices) < skin.joints.size()) {
    refuse(matrices, ": has fewer elements than the ", skin.joints.size(), " joints");
  }
  const std::vector<float> numbers =
      accessors.floats(source.inverseBindMatrices, 16, Numbers::floats, {0, skin.joints.size()}, matrices);
  for (size_t i = 0; i < numbers.size(); ++i) {
    skin.inverse_bind[i / 16][static_cast<int>(i % 16 / 4)][static_cast<int>(i % 4)] = numbers[i];
  }
  return skin;
}

/// Skins that nodes of the scene use, each once; the nodes' skin becomes its index.
void import_skins(const Model& model, Accessors& accessors, const NodeMap& map, Scene& scene) {
  const std::vector<size_t> needed = joints_needed(scene.meshes);
  std::vector<int> skin_index(model.parsed.skins.size(), -1);
  size_t pose_elements = 0;
  for (size_t i = 0; i < map.size(); ++i) {
    if (map[i] < 0) continue;
    Node& node = scene.nodes[static_cast<size_t>(map[i])];
    const std::string where = place("nodes", i);
    if (node.mesh >= 0) pose_elements += scene.meshes[static_cast<size_t>(node.mesh)].weights.size();
    if (node.skin >= 0) {
      if (node.mesh < 0) refuse(where, ": has a skin but no mesh");
      int& skin = skin_index[static_cast<size_t>(node.skin)];
      if (skin < 0) {
        skin = static_cast<int>(scene.skins.size());
        scene.skins.push_back(import_skin(model, accessors, map, static_cast<size_t>(node.skin)));
      }
      const size_t joints = scene.skins[static_cast<size_t>(skin)].joints.size();
      const size_t mesh_joints = needed[static_cast<size_t>(node.mesh)];
      const bool empty = scene.meshes[static_cast<size_t>(node.mesh)].primitives.empty();
      if (mesh_joints == 0 && !empty)
        refuse(where, ": has a skin but meshes[", node.mesh, "] has primitives without JOINTS_0");
      if (mesh_joints > joints) {
        refuse(where, ": meshes[", node.mesh, "] uses joint ", mesh_joints - 1, " of the ", joints, " in skins[",
               node.skin, "]");
      }
      node.skin = skin;
      pose_elements += joints;
    }
    if (pose_elements > max_pose_elements) {
      refuse(where, ": with it the scene has more than ", max_pose_elements,
             " joints and morph weights over all its nodes");
    }
  }
}

}  // namespace

NodeMap import_nodes(const Model& model, Accessors& accessors, Scene& scene) {
  const std::vector<int> parents = parents_of(model.parsed.nodes);
  std::vector<int> open = roots_of(model.parsed, parents, scene.name);
  std::ranges::reverse(open);
  NodeMap map(model.parsed.nodes.size(), -1);
  while (!open.empty()) {
    const auto index = static_cast<size_t>(open.back());
    open.pop_back();
    map[index] = static_cast<int>(scene.nodes.size());
    Node node = import_node(model, scene, index);
    node.parent = parents[index] >= 0 ? map[static_cast<size_t>(parents[index])] : -1;
    scene.nodes.push_back(std::move(node));
    const auto& children = model.parsed.nodes[index].children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  import_skins(model, accessors, map, scene);
  return map;
}

}  // namespace app::gltf
