// Every real scene loads, with the triangles and lights that its table or README states.
#include "import_test_files.hpp"

namespace import_test {
namespace {

struct Expected {
  const char* file;
  size_t triangles;  ///< Summed over instances.
  size_t points, spots, directionals;
};

/// gtest names failing parameters with it.
void PrintTo(const Expected& expected, std::ostream* stream) { *stream << expected.file; }

constexpr Expected scenes[] = {
    {"sponza/sponza.gltf", 262239, 0, 0, 0},
    {"stk_black_forest/black_forest.gltf", 1107397, 204, 0, 0},
    {"zad_necropolis/necropolis.gltf", 1930134, 0, 0, 0},
    {"nexuiz_accident/accident.gltf", 38606, 313, 0, 0},
    {"nexuiz_dieselpower/dieselpower.gltf", 35078, 126, 206, 0},
    {"openarena_oacmpctf3/oacmpctf3.gltf", 104485, 1916, 0, 0},
    {"stanford_dragon/dragon_res4.glb", 11102, 0, 0, 0},
    {"stanford_dragon/dragon_35578.glb", 35578, 0, 0, 0},
    {"stanford_dragon/dragon_full_posonly.glb", 871414, 0, 0, 0},
    {"animated/SimpleSkin.gltf", 8, 0, 0, 0},
    {"animated/CesiumMan.glb", 4672, 0, 0, 0},
    {"lights_and_masks/Lights.glb", 12, 1, 2, 1},
    {"lights_and_masks/house.glb", 10497, 0, 0, 0},
    {"lights_and_masks/multiple_animated_lights.gltf", 4938, 1, 32, 0},
    {"lights_and_masks/test_lights.gltf", 1730, 1, 1, 1},
    {"hall/hall_8.glb", 254836, 8, 0, 0},
    {"hall/hall_65.glb", 254836, 65, 0, 0},
    {"hall/hall_256.glb", 254836, 256, 0, 0},
};

size_t drawn_triangles(const app::Scene& scene, const app::Pose& pose) {
  size_t triangles = 0;
  for (const app::PosedInstance& instance : pose.instances) {
    for (const app::Primitive& primitive : scene.meshes[instance.mesh].primitives)
      triangles += primitive.indices.size() / 3;
  }
  return triangles;
}

/// What scene.hpp promises about every primitive.
void expect_consistent(const app::Primitive& primitive, size_t materials) {
  const size_t vertices = primitive.positions.size();
  EXPECT_GT(vertices, 0u);
  EXPECT_EQ(primitive.normals.size(), vertices);
  const auto all_or_none = [&](const auto& array) { EXPECT_TRUE(array.empty() || array.size() == vertices); };
  all_or_none(primitive.tangents);
  all_or_none(primitive.uv[0]);
  all_or_none(primitive.uv[1]);
  all_or_none(primitive.colors);
  all_or_none(primitive.joints);
  all_or_none(primitive.weights);
  for (const app::MorphTarget& target : primitive.targets) {
    all_or_none(target.positions);
    all_or_none(target.normals);
  }
  EXPECT_EQ(primitive.indices.size() % 3, 0u);
  EXPECT_LT(primitive.material, materials);
  for (const uint32_t index : primitive.indices) ASSERT_LT(index, vertices);
  for (const glm::vec3& normal : primitive.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-4f);
  for (const glm::vec4& weights : primitive.weights) {
    ASSERT_NEAR(weights.x + weights.y + weights.z + weights.w, 1, 1e-4f);
  }
}

class RealScene : public testing::TestWithParam<Expected> {};

TEST_P(RealScene, LoadsWithItsTrianglesAndLights) {
  const auto file = scene_file(GetParam().file);
  if (file.empty()) GTEST_SKIP() << "no " << GetParam().file << " in UMBRAGE_SCENES_DIR";
  const auto scene = app::import_gltf(file);
  ASSERT_LOADS(scene);
  const app::Pose pose = app::pose(scene.value(), 0);
  EXPECT_EQ(drawn_triangles(scene.value(), pose), GetParam().triangles);
  size_t kinds[3] = {};
  for (const app::PosedLight& light : pose.lights) ++kinds[static_cast<size_t>(light.kind)];
  EXPECT_EQ(kinds[static_cast<size_t>(app::LightKind::point)], GetParam().points);
  EXPECT_EQ(kinds[static_cast<size_t>(app::LightKind::spot)], GetParam().spots);
  EXPECT_EQ(kinds[static_cast<size_t>(app::LightKind::directional)], GetParam().directionals);
  for (const app::Mesh& mesh : scene.value().meshes) {
    for (const app::Primitive& primitive : mesh.primitives)
      expect_consistent(primitive, scene.value().materials.size());
  }
}

std::string stem(const testing::TestParamInfo<Expected>& parameter) {
  return std::filesystem::path(parameter.param.file).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Scenes, RealScene, testing::ValuesIn(scenes), stem);

TEST(RealScenes, EveryFileLoads) {
  const auto folder = scene_file("");
  if (folder.empty()) GTEST_SKIP() << "UMBRAGE_SCENES_DIR is not there";
  for (const auto& file : gltf_files(folder)) {
    if (file.string().find("/robustness/") != std::string::npos) continue;
    const auto scene = app::import_gltf(file);
    EXPECT_TRUE(scene.ok()) << scene.error().message;
  }
}

TEST(RealScenes, SponzaHasItsMaterials) {
  const auto file = scene_file("sponza/sponza.gltf");
  if (file.empty()) GTEST_SKIP() << "no sponza in UMBRAGE_SCENES_DIR";
  const auto scene = app::import_gltf(file);
  ASSERT_LOADS(scene);
  size_t masked = 0, normal_mapped = 0;
  for (const app::Material& material : scene.value().materials) {
    masked += material.alpha_mode == app::AlphaMode::mask;
    normal_mapped += material.normal_texture.image >= 0;
  }
  EXPECT_EQ(scene.value().materials.size(), 26u);  // 25 and the default one
  EXPECT_EQ(masked, 3u);
  EXPECT_GT(normal_mapped, 0u);
}

}  // namespace
}  // namespace import_test
