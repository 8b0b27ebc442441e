// Meshes and accessors: what small documents become.
#include <limits>

#include "import_test_files.hpp"

namespace import_test {
namespace {

const std::string asset = R"({"asset": {"version": "2.0"}, )";

/// A document with one primitive over these bytes; views and accessors as JSON lists, members as JSON.
std::string document(const Bytes& bytes, const std::string& views, const std::string& accessors,
                     const std::string& primitive) {
  return asset + bytes.buffers() + R"(, "bufferViews": [)" + views + R"(], "accessors": [)" + accessors +
         R"(], "meshes": [{"primitives": [{)" + primitive + R"(}]}], "nodes": [{"mesh": 0}]})";
}

std::string view(size_t offset, size_t length, const std::string& more = "") {
  return R"({"buffer": 0, "byteOffset": )" + std::to_string(offset) + R"(, "byteLength": )" + std::to_string(length) +
         more + "}";
}

std::string accessor(int buffer_view, int component_type, const std::string& type, size_t count,
                     const std::string& more = "") {
  return R"({"bufferView": )" + std::to_string(buffer_view) + R"(, "componentType": )" +
         std::to_string(component_type) + R"(, "type": ")" + type + R"(", "count": )" + std::to_string(count) + more +
         "}";
}

constexpr int i8 = 5120, u8 = 5121, u16 = 5123, f32 = 5126;

/// Vertices 0 … n-1 on a parabola, so that no three lie on a line.
std::vector<float> parabola(size_t vertices) {
  std::vector<float> positions;
  for (size_t i = 0; i < vertices; ++i) {
    const auto x = static_cast<float>(i);
    positions.insert(positions.end(), {x, x * x, 0});
  }
  return positions;
}

/// Triangles by the x of their corners, which is the vertex number.
std::vector<int> corners(const app::Primitive& primitive) {
  std::vector<int> result;
  for (const uint32_t index : primitive.indices) result.push_back(static_cast<int>(primitive.positions[index].x));
  return result;
}

const app::Primitive& only_primitive(const umbrage::Result<app::Scene>& scene) {
  return scene.value().meshes.at(0).primitives.at(0);
}

umbrage::Result<app::Scene> import_mode(int mode, size_t vertices) {
  return import_text(document(Bytes().add(parabola(vertices)), view(0, vertices * 12),
                              accessor(0, f32, "VEC3", vertices),
                              R"("mode": )" + std::to_string(mode) + R"(, "attributes": {"POSITION": 0})"));
}

TEST(Geometry, ModesBecomeTriangleLists) {
  const auto list = import_mode(4, 7), strip = import_mode(5, 5), fan = import_mode(6, 5);
  ASSERT_LOADS(list);
  ASSERT_LOADS(strip);
  ASSERT_LOADS(fan);
  EXPECT_EQ(corners(only_primitive(list)), (std::vector<int>{0, 1, 2, 3, 4, 5}));  // the incomplete one is left out
  EXPECT_EQ(corners(only_primitive(strip)), (std::vector<int>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(corners(only_primitive(fan)), (std::vector<int>{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

TEST(Geometry, PointsAndLinesAreLeftOut) {
  for (int mode = 0; mode < 4; ++mode) {
    const auto scene = import_mode(mode, 6);
    ASSERT_LOADS(scene);
    EXPECT_TRUE(scene.value().meshes.at(0).primitives.empty());
  }
  EXPECT_REFUSED(import_mode(7, 6), "meshes[0].primitives[0].mode: 7");
}

TEST(Geometry, MissingNormalsAreFlat) {
  // Two triangles that share an edge and face along z and along y.
  const Bytes bytes =
      Bytes().add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}).add(std::vector<uint16_t>{0, 1, 2, 1, 0, 3});
  const auto scene = import_text(document(bytes, view(0, 48) + "," + view(48, 12),
                                          accessor(0, f32, "VEC3", 4) + "," + accessor(1, u16, "SCALAR", 6),
                                          R"("attributes": {"POSITION": 0}, "indices": 1)"));
  ASSERT_LOADS(scene);
  const app::Primitive& primitive = only_primitive(scene);
  ASSERT_EQ(primitive.normals.size(), 6u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(primitive.normals[primitive.indices[i]], glm::vec3(0, 0, 1));
  for (size_t i = 3; i < 6; ++i) EXPECT_EQ(primitive.normals[primitive.indices[i]], glm::vec3(0, 1, 0));
}

TEST(Geometry, NormalsWithoutLengthAreMended) {
  const Bytes bytes =
      Bytes().add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}).add(std::vector<float>{0, 0, 0, 0, 3, 0, 0, 0, 0});
  const auto scene = import_text(document(
      bytes, view(0, 72), accessor(0, f32, "VEC3", 3) + "," + accessor(0, f32, "VEC3", 3, R"(, "byteOffset": 36)"),
      R"("attributes": {"POSITION": 0, "NORMAL": 1})"));
  ASSERT_LOADS(scene);
  const app::Primitive& primitive = only_primitive(scene);
  EXPECT_EQ(primitive.normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(Geometry, OnlyTheVerticesInUseAreKept) {
  const Bytes bytes =
      Bytes().add(parabola(100)).add(std::vector<float>(300, 1.0f)).add(std::vector<uint8_t>{52, 50, 51});
  const auto scene = import_text(
      document(bytes, view(0, 1200) + "," + view(1200, 1200) + "," + view(2400, 3),
               accessor(0, f32, "VEC3", 100) + "," + accessor(1, f32, "VEC3", 100) + "," + accessor(2, u8, "SCALAR", 3),
               R"("attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2)"));
  ASSERT_LOADS(scene);
  EXPECT_EQ(only_primitive(scene).positions.size(), 3u);
  EXPECT_EQ(corners(only_primitive(scene)), (std::vector<int>{52, 50, 51}));
}

TEST(Geometry, IndexBeyondTheVertices) {
  const Bytes bytes = Bytes().add(parabola(3)).add(std::vector<uint16_t>{0, 1, 3});
  EXPECT_REFUSED(import_text(document(bytes, view(0, 36) + "," + view(36, 6),
                                      accessor(0, f32, "VEC3", 3) + "," + accessor(1, u16, "SCALAR", 3),
                                      R"("attributes": {"POSITION": 0}, "indices": 1)")),
                 "test.gltf: meshes[0].primitives[0]: index 3 is beyond its 3 vertices");
}

TEST(Geometry, PositionsMustBeFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<float> positions = parabola(3);
    positions[7] = bad;
    EXPECT_REFUSED(import_text(document(Bytes().add(positions), view(0, 36), accessor(0, f32, "VEC3", 3),
                                        R"("attributes": {"POSITION": 0})")),
                   "meshes[0].primitives[0]: POSITION: element 2 is not a finite number");
  }
}

TEST(Geometry, StridesOffsetsAndSparseElements) {
  // Positions every 16 bytes, the second one replaced.
  Bytes bytes;
  bytes.add(std::vector<float>{0, 0, 0, -7, 1, 0, 0, -7, 0, 1, 0, -7})
      .add(std::vector<uint16_t>{1, 0})
      .add(std::vector<float>{5, 6, 7});
  const auto scene = import_text(document(
      bytes, view(0, 48, R"(, "byteStride": 16)") + "," + view(48, 16),
      accessor(0, f32, "VEC3", 3, R"(, "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5123},
        "values": {"bufferView": 1, "byteOffset": 4}})"),
      R"("attributes": {"POSITION": 0})"));
  ASSERT_LOADS(scene);
  EXPECT_EQ(only_primitive(scene).positions, (std::vector<glm::vec3>{{0, 0, 0}, {5, 6, 7}, {0, 1, 0}}));
}

TEST(Geometry, SparseElementsOfNothingAreOverZeros) {
  const Bytes bytes = Bytes().add(std::vector<uint8_t>{0, 2, 0, 0}).add(std::vector<float>{1, 2, 3, 4, 5, 6});
  const std::string sparse = R"({"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {"count": 2,
    "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0, "byteOffset": 4}}})";
  const auto scene = import_text(document(bytes, view(0, 28), sparse, R"("attributes": {"POSITION": 0})"));
  ASSERT_LOADS(scene);
  EXPECT_EQ(only_primitive(scene).positions, (std::vector<glm::vec3>{{1, 2, 3}, {0, 0, 0}, {4, 5, 6}}));
}

TEST(Geometry, SparseIndicesMustIncreaseAndFit) {
  for (const std::vector<uint8_t>& indices : {std::vector<uint8_t>{1, 1, 0, 0}, std::vector<uint8_t>{0, 3, 0, 0}}) {
    const Bytes bytes = Bytes().add(indices).add(std::vector<float>(6, 1.0f));
    const std::string sparse = R"({"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {"count": 2,
      "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0, "byteOffset": 4}}})";
    EXPECT_REFUSED(import_text(document(bytes, view(0, 28), sparse, R"("attributes": {"POSITION": 0})")),
                   "sparse index");
  }
}

TEST(Geometry, QuantizedAttributes) {
  Bytes bytes;
  bytes.add(std::vector<int8_t>{0, 0, 0, 0, 100, 0, 0, 0, 0, -128, 0, 0});       // positions, not normalized
  bytes.add(std::vector<uint16_t>{0, 65535, 13107, 0, 65535, 65535});            // texture coordinates, normalized
  bytes.add(std::vector<uint8_t>{255, 0, 51, 0, 255, 0, 51, 0, 255, 0, 51, 0});  // colours, normalized
  const auto scene =
      import_text(document(bytes, view(0, 12, R"(, "byteStride": 4)") + "," + view(12, 12) + "," + view(24, 12),
                           accessor(0, i8, "VEC3", 3) + "," + accessor(1, u16, "VEC2", 3, R"(, "normalized": true)") +
                               "," + accessor(2, u8, "VEC4", 3, R"(, "normalized": true)"),
                           R"("attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2})"));
  ASSERT_LOADS(scene);
  const app::Primitive& primitive = only_primitive(scene);
  EXPECT_EQ(primitive.positions[1], glm::vec3(100, 0, 0));
  EXPECT_EQ(primitive.positions[2], glm::vec3(0, -128, 0));
  EXPECT_FLOAT_EQ(primitive.uv[0][1].x, 0.2f);
  EXPECT_FLOAT_EQ(primitive.uv[0][0].y, 1.0f);
  EXPECT_FLOAT_EQ(primitive.colors[0].z, 0.2f);
}

TEST(Geometry, FourStrongestInfluences) {
  Bytes bytes = Bytes().add(parabola(3));
  for (int set = 0; set < 2; ++set) {
    for (int vertex = 0; vertex < 3; ++vertex) {
      bytes.add(set == 0 ? std::vector<float>{0.25f, 0.05f, 0.125f, 0.025f} : std::vector<float>{0.125f, 0.375f, 0, 0});
    }
  }
  bytes.add(std::vector<uint8_t>{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7});
  const auto at = [](int component_type, size_t offset) {
    return accessor(0, component_type, "VEC4", 3, R"(, "byteOffset": )" + std::to_string(offset));
  };
  const auto scene = import_text(document(
      bytes, view(0, bytes.size()),
      accessor(0, f32, "VEC3", 3) + "," + at(f32, 36) + "," + at(f32, 84) + "," + at(u8, 132) + "," + at(u8, 144),
      R"("attributes": {"POSITION": 0, "WEIGHTS_0": 1, "WEIGHTS_1": 2, "JOINTS_0": 3, "JOINTS_1": 4})"));
  ASSERT_LOADS(scene);
  EXPECT_EQ(only_primitive(scene).joints[1], glm::u16vec4(5, 0, 2, 4));
  const glm::vec4 expected = glm::vec4(0.375f, 0.25f, 0.125f, 0.125f) / 0.875f;
  for (int k = 0; k < 4; ++k) EXPECT_FLOAT_EQ(only_primitive(scene).weights[1][k], expected[k]);
}

TEST(Geometry, IndicesWithoutDataAreZero) {
  const auto scene =
      import_text(document(Bytes().add(parabola(3)), view(0, 36),
                           accessor(0, f32, "VEC3", 3) + R"(, {"componentType": 5123, "type": "SCALAR", "count": 3})",
                           R"("attributes": {"POSITION": 0}, "indices": 1)"));
  ASSERT_LOADS(scene);
  EXPECT_EQ(corners(only_primitive(scene)), (std::vector<int>{0, 0, 0}));
}

TEST(Geometry, BufferFiles) {
  const TemporaryFolder folder;
  const std::vector<float> positions = parabola(3);
  const std::string_view bytes(reinterpret_cast<const char*>(positions.data()), 36);
  const auto text = [](const std::string& uri, int length) {
    return asset + R"("buffers": [{"byteLength": )" + std::to_string(length) + R"(, "uri": ")" + uri +
           R"("}], "bufferViews": [)" + view(0, 36) + R"(], "accessors": [)" + accessor(0, f32, "VEC3", 3) +
           R"(], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})";
  };
  folder.write("with space.bin", std::string(bytes) + "tail");
  folder.write("short.bin", bytes.substr(0, 35));
  ASSERT_LOADS(app::import_gltf(folder.write("a.gltf", text("with%20space.bin", 36))));
  EXPECT_REFUSED(app::import_gltf(folder.write("b.gltf", text("short.bin", 36))), "has 35 bytes where 36 are declared");
  EXPECT_REFUSED(app::import_gltf(folder.write("c.gltf", text("none.bin", 36))), "buffers[0]: there is no file");
  EXPECT_REFUSED(app::import_gltf(folder.write("d.gltf", text("with%20space.bin", 35))),
                 "are beyond the 35 of buffers[0]");
}

}  // namespace
}  // namespace import_test
