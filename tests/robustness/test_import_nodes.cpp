// Scenes, nodes, lights, cameras, skins and animations: what small documents become.
#include <cmath>

#include "import_test_files.hpp"

namespace import_test {
namespace {

const std::string asset = R"({"asset": {"version": "2.0"}, )";

TEST(Nodes, EmptyDocuments) {
  for (const char* text : {R"({"asset": {"version": "2.0"}})", R"({"asset": {"version": "2.1"}, "scenes": [{}]})"}) {
    const auto scene = import_text(text);
    ASSERT_LOADS(scene);
    EXPECT_TRUE(scene.value().nodes.empty());
    EXPECT_EQ(scene.value().name, "test");
    EXPECT_TRUE(app::pose(scene.value(), 1).instances.empty());
  }
}

TEST(Nodes, Versions) {
  EXPECT_REFUSED(import_text(R"({"asset": {"version": "1.0"}})"), "glTF 1.0 is not read");
  EXPECT_REFUSED(import_text(R"({"asset": {"version": "2.1", "minVersion": "2.1"}})"), "glTF 2.1 is not read");
  EXPECT_REFUSED(import_text("{}"), "asset: is missing");
  EXPECT_REFUSED(import_text("not JSON"), "JSON: there is none");
  EXPECT_REFUSED(import_text("{]"), "JSON: parse error");
  EXPECT_REFUSED(import_text(""), "JSON: ");
}

TEST(Nodes, RequiredExtensions) {
  ASSERT_LOADS(import_text(asset + R"("extensionsRequired": ["KHR_texture_transform", "KHR_mesh_quantization"]})"));
  ASSERT_LOADS(import_text(asset + R"("extensionsUsed": ["KHR_draco_mesh_compression"]})"));
  const auto scene = import_text(asset + R"("extensionsRequired": ["KHR_draco_mesh_compression"]})");
  EXPECT_REFUSED(scene, "KHR_draco_mesh_compression is not supported");
  EXPECT_EQ(scene.error().code, umbrage::ErrorCode::unsupported);
}

TEST(Nodes, OnlyTheSceneShownParentsFirst) {
  const auto scene = import_text(asset + R"("scene": 1, "scenes": [{"nodes": [0]}, {"name": "shown", "nodes": [4, 3]}],
    "nodes": [{"name": "a"}, {"name": "b"}, {"name": "c", "children": [1]},
              {"name": "d"}, {"name": "e", "children": [2, 5]}, {"name": "f"}]})");
  ASSERT_LOADS(scene);
  std::string order;
  for (const app::Node& node : scene.value().nodes) order += node.name;
  EXPECT_EQ(order, "ecbfd");
  EXPECT_EQ(scene.value().nodes[2].parent, 1);
  EXPECT_EQ(scene.value().nodes[3].parent, 0);
  EXPECT_EQ(scene.value().nodes[4].parent, -1);
  EXPECT_EQ(scene.value().name, "shown");
}

TEST(Nodes, WithoutScenesAllRootsAreShown) {
  const auto scene = import_text(asset + R"("nodes": [{"children": [1]}, {}, {}]})");
  ASSERT_LOADS(scene);
  EXPECT_EQ(scene.value().nodes.size(), 3u);
}

TEST(Nodes, HierarchyFaults) {
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"children": [0]}]})"), "nodes[0]: is its own ancestor");
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{}, {"children": [2]}, {"children": [1]}]})"),
                 "nodes[1]: is its own ancestor");
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"children": [2]}, {"children": [2]}, {}]})"),
                 "nodes[2]: is a child of nodes[0] and of nodes[1]");
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"children": [1]}]})"), "child nodes[1] is not in the file");
  EXPECT_REFUSED(import_text(asset + R"("scenes": [{"nodes": [0, 0]}], "nodes": [{}]})"), "listed twice");
  EXPECT_REFUSED(import_text(asset + R"("scene": 2, "scenes": [{}]})"), "scenes[2] is not in the file");
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"mesh": 0}]})"), "nodes[0]: meshes[0] is not in the file");
}

TEST(Nodes, Transforms) {
  const auto scene = import_text(asset + R"("nodes": [
    {"translation": [1, 2, 3], "rotation": [0, 0, 2, 2], "scale": [1, 2, 1.0]},
    {"matrix": [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 4, 5, 6, 1]}]})");
  ASSERT_LOADS(scene);
  EXPECT_EQ(scene.value().nodes[0].translation, glm::vec3(1, 2, 3));
  EXPECT_NEAR(scene.value().nodes[0].rotation.z, std::sqrt(0.5f), 1e-6f);
  EXPECT_NEAR(scene.value().nodes[0].rotation.w, std::sqrt(0.5f), 1e-6f);
  ASSERT_TRUE(scene.value().nodes[1].matrix.has_value());
  EXPECT_EQ((*scene.value().nodes[1].matrix)[3], glm::vec4(4, 5, 6, 1));
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"rotation": [0, 0, 0, 0]}]})"),
                 "nodes[0].rotation: must be a unit quaternion");
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"scale": [1, 1]}]})"),
                 "nodes[0].scale: must have 3 elements, has 2");
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"translation": [1e39, 0, 0]}]})"), "is not a finite 32-bit float");
  EXPECT_REFUSED(import_text(asset + R"("nodes": [{"matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]})"),
                 "its last row must be 0 0 0 1");
}

TEST(Nodes, Lights) {
  const auto scene = import_text(asset + R"("extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "point", "color": [1, 0.5, 0], "intensity": 20, "range": 5, "spot": {}},
    {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}, {"type": "directional", "name": "sun"}]}},
    "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 2}}, "rotation": [-0.7071068, 0, 0, 0.7071068]},
              {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 3]},
              {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 1}}}]})");
  ASSERT_LOADS(scene);
  const app::Pose pose = app::pose(scene.value(), 0);
  ASSERT_EQ(pose.lights.size(), 3u);
  EXPECT_EQ(pose.lights[0].kind, app::LightKind::directional);
  EXPECT_EQ(pose.lights[0].name, "sun");
  EXPECT_NEAR(pose.lights[0].direction.y, -1, 1e-6f);
  EXPECT_TRUE(std::isinf(pose.lights[0].range));
  EXPECT_EQ(pose.lights[1].kind, app::LightKind::point);
  EXPECT_EQ(pose.lights[1].position, glm::vec3(1, 2, 3));
  EXPECT_EQ(pose.lights[1].color, glm::vec3(1, 0.5f, 0));
  EXPECT_EQ(pose.lights[1].intensity, 20);
  EXPECT_EQ(pose.lights[1].range, 5);
  EXPECT_EQ(pose.lights[2].kind, app::LightKind::spot);
  EXPECT_EQ(pose.lights[2].name, "lamp");
  EXPECT_EQ(pose.lights[2].inner_cone, 0.1f);
  EXPECT_EQ(pose.lights[2].outer_cone, 0.5f);
}

TEST(Nodes, LightFaults) {
  const auto with_light = [](const std::string& light) {
    return import_text(asset + R"("extensions": {"KHR_lights_punctual": {"lights": [)" + light + "]}}}");
  };
  EXPECT_REFUSED(with_light(R"({"type": "area"})"), "lights[0].type: must be point, spot or directional");
  EXPECT_REFUSED(with_light(R"({"type": "point", "intensity": -1})"), "must not be negative");
  EXPECT_REFUSED(with_light(R"({"type": "point", "range": -1})"), "range: must be greater than 0");
  EXPECT_REFUSED(with_light(R"({"type": "spot", "spot": {"outerConeAngle": 2}})"), "cone angles");
}

TEST(Nodes, Cameras) {
  const auto scene =
      import_text(asset + R"("cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25}},
    {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0, "zfar": 9}},
    {"type": "perspective", "perspective": {"yfov": 4, "znear": 1, "zfar": 10, "aspectRatio": 2}}],
    "nodes": [{"camera": 0, "scale": [9, 9, 9]}, {"camera": 1}, {"camera": 2}]})");
  ASSERT_LOADS(scene);
  const app::Pose pose = app::pose(scene.value(), 0);
  ASSERT_EQ(pose.cameras.size(), 3u);
  EXPECT_EQ(pose.cameras[0].lens.fov_y, 0.5f);
  EXPECT_TRUE(std::isinf(pose.cameras[0].lens.far));
  EXPECT_EQ(pose.cameras[0].world_from_camera, glm::mat4(1));
  EXPECT_TRUE(pose.cameras[1].lens.orthographic);
  EXPECT_EQ(pose.cameras[1].lens.half_height, 3);
  EXPECT_EQ(pose.cameras[2].lens.far, 10);
  EXPECT_EQ(pose.cameras[2].lens.aspect, 2);
  EXPECT_LT(pose.cameras[2].lens.fov_y, 3.14f);
}

/// Three vertices with one joint, and what the caller adds.
std::string skinned(const std::string& joint, const std::string& more) {
  const Bytes bytes = Bytes()
                          .add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0})
                          .add(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})
                          .add(std::vector<uint8_t>(12, static_cast<uint8_t>(std::stoi(joint))));
  return asset + bytes.buffers() + R"(, "bufferViews": [{"buffer": 0, "byteLength": 96}], "accessors": [
    {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
    {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "type": "VEC4", "count": 3},
    {"bufferView": 0, "byteOffset": 84, "componentType": 5121, "type": "VEC4", "count": 3}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "WEIGHTS_0": 1, "JOINTS_0": 2}}]},
               {"primitives": [{"attributes": {"POSITION": 0}}]}], )" +
         more + "}";
}

TEST(Nodes, Skins) {
  const auto scene = import_text(skinned("0", R"("skins": [{"joints": [5]}, {"joints": [1]}],
    "nodes": [{"mesh": 0, "skin": 1, "translation": [9, 9, 9]}, {"translation": [1, 2, 3]}])"));
  ASSERT_LOADS(scene);
  ASSERT_EQ(scene.value().skins.size(), 1u);  // the other one is not used, and refers to nothing
  const app::Pose pose = app::pose(scene.value(), 0);
  const auto positions = app::deformed_positions(scene.value().meshes[0].primitives[0], pose.instances[0], pose);
  EXPECT_EQ(positions[0], glm::vec3(1, 2, 3));  // follows its joint, not its node
}

TEST(Nodes, SkinFaults) {
  EXPECT_REFUSED(import_text(skinned("1", R"("skins": [{"joints": [1]}], "nodes": [{"mesh": 0, "skin": 0}, {}])")),
                 "nodes[0]: meshes[0] uses joint 1 of the 1 in skins[0]");
  EXPECT_REFUSED(import_text(skinned("0", R"("skins": [{"joints": [1]}], "nodes": [{"mesh": 1, "skin": 0}, {}])")),
                 "nodes[0]: has a skin but meshes[1] has primitives without JOINTS_0");
  EXPECT_REFUSED(
      import_text(skinned(
          "0", R"("skins": [{"joints": [1]}], "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "skin": 0}, {}])")),
      "skins[0]: joint nodes[1] is not in the scene");
  EXPECT_REFUSED(
      import_text(skinned(
          "0", R"("skins": [{"joints": [1], "inverseBindMatrices": 0}], "nodes": [{"mesh": 0, "skin": 0}, {}])")),
      "must be 16 x 32-bit float");
}

std::string animated(const std::string& times, const std::string& sampler, const std::string& target) {
  const Bytes bytes = Bytes().add(std::vector<float>{0, 1, 1, 0}).add(std::vector<float>{1, 2, 3, 4, 5, 6});
  return asset + bytes.buffers() + R"(, "bufferViews": [{"buffer": 0, "byteLength": 40}], "accessors": [
    {"bufferView": 0, "componentType": 5126, "type": "SCALAR", )" +
         times + R"(},
    {"bufferView": 0, "byteOffset": 16, "componentType": 5126, "type": "VEC3", "count": 2}],
    "nodes": [{}, {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}],
    "animations": [{"samplers": [{"input": 0, "output": 1)" +
         sampler + R"(}], "channels": [{"sampler": 0, "target": {)" + target + "}}]}]}";
}

TEST(Nodes, Animations) {
  const auto scene = import_text(animated(R"("count": 2)", "", R"("node": 0, "path": "translation")"));
  ASSERT_LOADS(scene);
  ASSERT_EQ(scene.value().animations.size(), 1u);
  EXPECT_EQ(scene.value().animations[0].duration, 1);
  EXPECT_EQ(scene.value().animations[0].channels[0].values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  // Without a node there is nothing to animate.
  const auto none = import_text(animated(R"("count": 2)", "", R"("path": "pointer")"));
  ASSERT_LOADS(none);
  EXPECT_TRUE(none.value().animations.empty());
}

TEST(Nodes, AnimationFaults) {
  const std::string node = R"("node": 0, "path": "translation")";
  EXPECT_REFUSED(import_text(animated(R"("count": 3)", "", node)), "times must increase, 1 follows 1");
  EXPECT_REFUSED(import_text(animated(R"("count": 1)", "", node)), "output has 2 elements; its 1 keys need 1");
  EXPECT_REFUSED(import_text(animated(R"("count": 2)", R"(, "interpolation": "CUBICSPLINE")", node)),
                 "its 2 keys need 6");
  EXPECT_REFUSED(import_text(animated(R"("count": 2)", R"(, "interpolation": "ROUND")", node)),
                 "must be STEP, LINEAR or CUBICSPLINE");
  EXPECT_REFUSED(import_text(animated(R"("count": 2)", "", R"("node": 0, "path": "rotation")")), "must be 4 x");
  EXPECT_REFUSED(import_text(animated(R"("count": 2)", "", R"("node": 0, "path": "weights")")),
                 "without morph targets");
  EXPECT_REFUSED(import_text(animated(R"("count": 2)", "", R"("node": 1, "path": "scale")")),
                 "a node that has a matrix");
  EXPECT_REFUSED(import_text(animated(R"("count": 2)", "", R"("node": 9, "path": "scale")")),
                 "nodes[9] is not in the file");
}

}  // namespace
}  // namespace import_test
