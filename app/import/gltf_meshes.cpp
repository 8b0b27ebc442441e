// glTF primitives: modes become triangle lists, every reference is held against the vertices that are there.
#include "import/gltf_meshes.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "import/gltf_fault.hpp"
#include "import/gltf_limits.hpp"
#include "import/mesh_normals.hpp"

namespace app::gltf {
namespace {

using Attributes = std::map<std::string, int>;

struct Context {
  const Model& model;
  Accessors& accessors;
  std::string where;        ///< "meshes[3].primitives[0]".
  Range vertices;           ///< Those of the file's that the primitive uses.
  size_t vertex_count = 0;  ///< Those that the file has.
};

int attribute(const Attributes& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

/// One vector per vertex used, or nothing where the attribute is missing.
template <int Width>
std::vector<glm::vec<Width, float>> vertex_data(Context& context, const Attributes& attributes, const std::string& name,
                                                Numbers numbers = Numbers::reals) {
  const int accessor = attribute(attributes, name);
  if (accessor < 0) return {};
  const std::string where = context.where + ": " + name;
  if (const size_t count = context.accessors.count(accessor, where); count != context.vertex_count) {
    refuse(where, " has ", count, " elements, POSITION ", context.vertex_count);
  }
  return context.accessors.vectors<Width>(accessor, numbers, context.vertices, where);
}

/// The primitive's index list, before modes are resolved, relative to context.vertices, which it sets.
std::vector<uint32_t> read_indices(Context& context, const tinygltf::Primitive& source) {
  std::vector<uint32_t> indices;
  if (source.indices < 0) {
    context.accessors.charge(context.vertex_count * sizeof(uint32_t), context.where);
    indices.resize(context.vertex_count);
    for (size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<uint32_t>(i);
    context.vertices = {0, context.vertex_count};
    return indices;
  }
  const std::string where = context.where + ": indices";
  indices = context.accessors.integers(source.indices, 1, {0, context.accessors.count(source.indices, where)}, where);
  if (indices.empty()) return indices;
  const auto [low, high] = std::ranges::minmax(indices);
  if (high >= context.vertex_count) {
    refuse(context.where, ": index ", high, " is beyond its ", context.vertex_count, " vertices");
  }
  // Files may keep many primitives in one vertex buffer: only the part between the smallest and the largest index is
  // read.
  context.vertices = {low, size_t{high} - low + 1};
  for (uint32_t& index : indices) index -= low;
  return indices;
}

/// Incomplete triangles at the end are left out, as glTF says.
std::vector<uint32_t> as_triangle_list(std::vector<uint32_t> indices, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    indices.resize(indices.size() / 3 * 3);
    return indices;
  }
  std::vector<uint32_t> triangles;
  for (size_t i = 0; i + 2 < indices.size(); ++i) {
    // Every second triangle of a strip runs the other way around.
    const size_t a = mode == TINYGLTF_MODE_TRIANGLE_FAN ? 0 : i, b = i + 1 + i % 2, c = i + 2 - i % 2;
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    triangles.insert(triangles.end(), {indices[a], indices[fan ? i + 1 : b], indices[fan ? i + 2 : c]});
  }
  return triangles;
}

void read_colors(Context& context, const Attributes& attributes, Primitive& primitive) {
  const int accessor = attribute(attributes, "COLOR_0");
  if (accessor < 0) return;
  if (context.accessors.width(accessor, context.where + ": COLOR_0") != 3) {
    primitive.colors = vertex_data<4>(context, attributes, "COLOR_0");
    return;
  }
  for (const glm::vec3& color : vertex_data<3>(context, attributes, "COLOR_0")) {
    primitive.colors.emplace_back(color, 1.0f);
  }
}

struct Influence {
  float weight = 0;
  uint16_t joint = 0;
};

/// The four strongest influences of a vertex, with weights that sum to 1. A vertex without weight follows its first
/// joint.
void store_influences(std::vector<Influence>& influences, glm::u16vec4& joints, glm::vec4& weights) {
  std::ranges::stable_sort(influences, std::greater{}, &Influence::weight);
  float sum = 0;
  for (size_t k = 0; k < 4; ++k) sum += influences[k].weight;
  for (int k = 0; k < 4; ++k) {
    joints[k] = influences[static_cast<size_t>(k)].joint;
    weights[k] = sum > 0 ? influences[static_cast<size_t>(k)].weight / sum : (k == 0 ? 1.0f : 0.0f);
  }
}

void read_influences(Context& context, const Attributes& attributes, Primitive& primitive) {
  std::vector<std::vector<uint32_t>> joint_sets;
  std::vector<std::vector<glm::vec4>> weight_sets;
  for (size_t set = 0;; ++set) {
    const std::string joints_name = "JOINTS_" + std::to_string(set), weights_name = "WEIGHTS_" + std::to_string(set);
    const int joints = attribute(attributes, joints_name), weights = attribute(attributes, weights_name);
    if ((joints < 0) != (weights < 0)) refuse(context.where, ": has only one of ", joints_name, " and ", weights_name);
    if (joints < 0) break;
    weight_sets.push_back(vertex_data<4>(context, attributes, weights_name));
    const std::string where = context.where + ": " + joints_name;
    if (context.accessors.count(joints, where) != context.vertex_count) {
      refuse(where, " and POSITION differ in their number of elements");
    }
    joint_sets.push_back(context.accessors.integers(joints, 4, context.vertices, where));
  }
  if (joint_sets.empty()) return;
  primitive.joints.resize(context.vertices.count);
  primitive.weights.resize(context.vertices.count);
  std::vector<Influence> influences;
  for (size_t v = 0; v < context.vertices.count; ++v) {
    influences.clear();
    for (size_t set = 0; set < joint_sets.size(); ++set) {
      for (int k = 0; k < 4; ++k) {
        const float weight = weight_sets[set][v][k];
        const uint32_t joint = joint_sets[set][4 * v + static_cast<size_t>(k)];
        if (weight < 0)
          refuse(context.where, ": WEIGHTS_", set, ": vertex ", context.vertices.first + v, " has a negative weight");
        if (joint > 0xffff) refuse(context.where, ": JOINTS_", set, ": joint ", joint, " is beyond 65535");
        influences.push_back({weight, static_cast<uint16_t>(joint)});
      }
    }
    store_influences(influences, primitive.joints[v], primitive.weights[v]);
  }
}

void read_attributes(Context& context, const Attributes& attributes, const UvSets& uv_sets, Primitive& primitive) {
  primitive.positions = vertex_data<3>(context, attributes, "POSITION");
  primitive.normals = vertex_data<3>(context, attributes, "NORMAL");
  primitive.tangents = vertex_data<4>(context, attributes, "TANGENT");
  for (size_t slot = 0; slot < uv_sets.size(); ++slot) {
    primitive.uv[slot] = vertex_data<2>(context, attributes, "TEXCOORD_" + std::to_string(uv_sets[slot]));
  }
  read_colors(context, attributes, primitive);
  read_influences(context, attributes, primitive);
}

void read_targets(Context& context, const std::vector<Attributes>& targets, Primitive& primitive) {
  const std::string where = context.where;
  for (size_t i = 0; i < targets.size(); ++i) {
    context.where = where + "." + place("targets", i);
    MorphTarget target;
    target.positions = vertex_data<3>(context, targets[i], "POSITION");
    target.normals = vertex_data<3>(context, targets[i], "NORMAL");
    primitive.targets.push_back(std::move(target));
  }
  context.where = where;
}

bool has_data(Context& context, const tinygltf::Primitive& source) {
  const auto all = [&](const Attributes& attributes) {
    return std::ranges::all_of(attributes, [&](const auto& entry) {
      return context.accessors.has_data(entry.second, context.where + ": " + entry.first);
    });
  };
  return (source.indices < 0 || context.accessors.has_data(source.indices, context.where + ": indices")) &&
         all(source.attributes) && std::ranges::all_of(source.targets, all);
}

/// Nothing: a primitive without triangles.
std::optional<Primitive> import_primitive(Context& context, const tinygltf::Primitive& source,
                                          const std::vector<UvSets>& uv_sets) {
  if (source.mode < TINYGLTF_MODE_POINTS || source.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    refuse(context.where, ".mode: ", source.mode, " is none of glTF's");
  }
  const size_t default_material = uv_sets.size() - 1;
  if (source.material >= 0 && static_cast<size_t>(source.material) >= default_material) {
    refuse(context.where, ": materials[", source.material, "] is not in the file");
  }
  const int positions = attribute(source.attributes, "POSITION");
  if (source.mode < TINYGLTF_MODE_TRIANGLES || positions < 0 || !has_data(context, source)) return std::nullopt;
  context.vertex_count = context.accessors.count(positions, context.where + ": POSITION");
  if (context.vertex_count > 0xffffffffu) refuse(context.where, ": has more than 4294967295 vertices");

  Primitive primitive{.material = static_cast<uint32_t>(source.material >= 0 ? source.material : default_material)};
  primitive.indices = as_triangle_list(read_indices(context, source), source.mode);
  if (primitive.indices.empty()) return std::nullopt;
  read_attributes(context, source.attributes, uv_sets[primitive.material], primitive);
  read_targets(context, source.targets, primitive);
  if (primitive.normals.empty()) {
    context.accessors.charge(primitive.indices.size() * sizeof(glm::vec3) * (4 + source.targets.size()), context.where);
    make_flat_normals(primitive);
  } else {
    mend_normals(primitive);
  }
  return primitive;
}

/// Primitives without triangles are gone by now, so targets are counted in the file.
std::vector<float> default_weights(const tinygltf::Mesh& source, const std::string& where) {
  const size_t targets = source.primitives.empty() ? 0 : source.primitives.front().targets.size();
  for (const tinygltf::Primitive& primitive : source.primitives) {
    if (primitive.targets.size() != targets) refuse(where, ": its primitives differ in their number of morph targets");
  }
  if (!source.weights.empty() && source.weights.size() != targets) {
    refuse(where, ".weights: has ", source.weights.size(), " elements for ", targets, " morph targets");
  }
  std::vector<float> weights(targets, 0.0f);
  for (size_t i = 0; i < source.weights.size(); ++i) weights[i] = finite_float(source.weights[i], where + ".weights");
  return weights;
}

}  // namespace

std::vector<Mesh> import_meshes(const Model& model, Accessors& accessors, const std::vector<UvSets>& uv_sets) {
  std::vector<Mesh> meshes;
  meshes.reserve(model.parsed.meshes.size());
  for (size_t m = 0; m < model.parsed.meshes.size(); ++m) {
    const tinygltf::Mesh& source = model.parsed.meshes[m];
    Mesh mesh{.name = source.name, .weights = default_weights(source, place("meshes", m))};
    for (size_t p = 0; p < source.primitives.size(); ++p) {
      Context context{model, accessors, place(place("meshes", m) + ".primitives", p), {}, 0};
      if (auto primitive = import_primitive(context, source.primitives[p], uv_sets)) {
        mesh.primitives.push_back(std::move(*primitive));
      }
    }
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace app::gltf
