// Materials, textures and images: what small documents become.
#include <cmath>

#include "import_test_files.hpp"

namespace import_test {
namespace {

const std::string asset = R"({"asset": {"version": "2.0"}, )";

/// A PNG of 2 x 1 pixels: red, and green with alpha 128.
const std::string png_uri =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR4nGP4z8DwHwgbABB5A359Y87XAAAAAElFTkSuQmCC";

std::string textured(const std::string& material, const std::string& more = "") {
  return asset + R"("images": [{"uri": ")" + png_uri + R"("}], "textures": [{"source": 0}, {"source": 0, "sampler": 0}],
    "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}], "materials": [{)" +
         material + "}]" + more + "}";
}

TEST(Materials, Defaults) {
  const auto scene = import_text(asset + R"("materials": [{}]})");
  ASSERT_LOADS(scene);
  ASSERT_EQ(scene.value().materials.size(), 2u);
  for (const app::Material& material : scene.value().materials) {
    EXPECT_EQ(material.base_color, glm::vec4(1));
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.roughness, 1);
    EXPECT_EQ(material.emissive, glm::vec3(0));
    EXPECT_EQ(material.alpha_mode, app::AlphaMode::opaque);
    EXPECT_EQ(material.base_color_texture.image, -1);
    EXPECT_FALSE(material.double_sided);
    EXPECT_FALSE(material.unlit);
  }
}

TEST(Materials, Everything) {
  const auto scene = import_text(textured(
      R"("name": "m", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true, "emissiveFactor": [0.5, 0.25, 1],
      "normalTexture": {"index": 0, "scale": 0.5}, "emissiveTexture": {"index": 1},
      "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "baseColorTexture": {"index": 1, "texCoord": 1},
        "metallicFactor": 0.75, "roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0}},
      "extensions": {"KHR_materials_unlit": {}, 
        "KHR_materials_emissive_strength": {"emissiveStrength": 4294967296}})"));
  ASSERT_LOADS(scene);
  const app::Material& material = scene.value().materials[0];
  EXPECT_EQ(material.name, "m");
  EXPECT_EQ(material.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic, 0.75f);
  EXPECT_EQ(material.roughness, 0.5f);
  EXPECT_EQ(material.normal_scale, 0.5f);
  EXPECT_EQ(material.emissive, glm::vec3(0.5f, 0.25f, 1) * 4294967296.0f);
  EXPECT_EQ(material.alpha_mode, app::AlphaMode::mask);
  EXPECT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_TRUE(material.double_sided);
  EXPECT_TRUE(material.unlit);
  EXPECT_EQ(material.base_color_texture.wrap_u, app::Wrap::clamp);
  EXPECT_EQ(material.base_color_texture.wrap_v, app::Wrap::mirror);
  EXPECT_TRUE(material.base_color_texture.nearest);
  EXPECT_EQ(material.normal_texture.wrap_u, app::Wrap::repeat);
  EXPECT_FALSE(material.normal_texture.nearest);
  EXPECT_NE(material.base_color_texture.uv_set, material.normal_texture.uv_set);
  ASSERT_EQ(scene.value().images.size(), 1u);  // one image, however often it is used
  EXPECT_EQ(scene.value().images[0].width, 2u);
  EXPECT_EQ(scene.value().images[0].height, 1u);
  EXPECT_EQ(scene.value().images[0].rgba, (std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 128}));
}

TEST(Materials, TextureTransform) {
  const auto scene = import_text(textured(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
    {"KHR_texture_transform": {"offset": [0.5, 3], "rotation": 1.5707963267948966, "scale": [2, 4]}}}})"));
  ASSERT_LOADS(scene);
  const glm::mat3x2 transform = scene.value().materials[0].base_color_texture.uv_transform;
  // Counter-clockwise with v pointing down: u goes to -v, v goes to u.
  const glm::vec2 u = transform * glm::vec3(1, 0, 1), v = transform * glm::vec3(0, 1, 1);
  EXPECT_NEAR(u.x, 0.5f, 1e-6f);
  EXPECT_NEAR(u.y, 3 - 2, 1e-6f);
  EXPECT_NEAR(v.x, 0.5f + 4, 1e-6f);
  EXPECT_NEAR(v.y, 3, 1e-6f);
}

TEST(Materials, TextureCoordinateSetsAreMappedToTwo) {
  const Bytes bytes = Bytes()
                          .add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0})
                          .add(std::vector<float>(6, 0.25f))
                          .add(std::vector<float>(6, 0.75f));
  const auto scene = import_text(textured(
      R"("normalTexture": {"index": 0, "texCoord": 3},
      "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}})",
      ", " + bytes.buffers() + R"(, "bufferViews": [{"buffer": 0, "byteLength": 84}], "accessors": [
      {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
      {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "type": "VEC2", "count": 3},
      {"bufferView": 0, "byteOffset": 60, "componentType": 5126, "type": "VEC2", "count": 3}],
      "meshes": [{"primitives": [{"material": 0,
        "attributes": {"POSITION": 0, "TEXCOORD_1": 1, "TEXCOORD_3": 2}}]}])"));
  ASSERT_LOADS(scene);
  const app::Material& material = scene.value().materials[0];
  const app::Primitive& primitive = scene.value().meshes[0].primitives[0];
  ASSERT_LT(material.base_color_texture.uv_set, 2u);
  ASSERT_LT(material.normal_texture.uv_set, 2u);
  EXPECT_EQ(primitive.uv[material.base_color_texture.uv_set].at(0), glm::vec2(0.25f));
  EXPECT_EQ(primitive.uv[material.normal_texture.uv_set].at(0), glm::vec2(0.75f));
}

TEST(Materials, ThreeTextureCoordinateSetsAreRefused) {
  EXPECT_REFUSED(import_text(textured(R"("normalTexture": {"index": 0, "texCoord": 2}, "emissiveTexture": {"index": 0},
    "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}})")),
                 "a material may use two sets");
}

TEST(Materials, SpecularGlossinessKeepsItsDiffusePart) {
  const auto scene = import_text(textured(R"("extensions": {"KHR_materials_pbrSpecularGlossiness": {
    "diffuseFactor": [0.5, 0.25, 0.125, 1], "diffuseTexture": {"index": 0}, "glossinessFactor": 0.75}})"));
  ASSERT_LOADS(scene);
  EXPECT_EQ(scene.value().materials[0].base_color, glm::vec4(0.5f, 0.25f, 0.125f, 1));
  EXPECT_EQ(scene.value().materials[0].base_color_texture.image, 0);
  EXPECT_EQ(scene.value().materials[0].metallic, 0);
  EXPECT_EQ(scene.value().materials[0].roughness, 0.25f);
}

TEST(Materials, Faults) {
  EXPECT_REFUSED(import_text(textured(R"("emissiveTexture": {"index": 7})")),
                 "materials[0]: textures[7] is not in the file");
  EXPECT_REFUSED(import_text(textured(R"("alphaMode": "GLASS")")),
                 "materials[0].alphaMode: must be OPAQUE, MASK or BLEND");
  EXPECT_REFUSED(import_text(textured(R"("emissiveFactor": [1, 1])")),
                 "materials[0].emissiveFactor: must have 3 elements, has 2");
  EXPECT_REFUSED(import_text(textured(R"("emissiveFactor": [-1, 1, 1])")), "must not be negative");
}

TEST(Materials, UnusedImagesAreNotRead) {
  ASSERT_LOADS(import_text(asset + R"("images": [{"uri": "nowhere.png"}], "textures": [{"source": 0}]})"));
}

}  // namespace
}  // namespace import_test
