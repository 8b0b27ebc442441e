// The chapter's vertex shaders: simple, instanced, skeletal with 3×4 bones, and the skeletal listing as printed (E12).
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "layered_rig.hpp"
#include "meshes.hpp"

namespace umbrage::test {
namespace {

constexpr uint32_t kBones = 64;

using LayeredVertices_ = LayeredVertices;

class LayeredVertices : public LayeredTest {
 protected:
  /// A ring whose vertices follow up to four of 64 bones.
  static app::LayeredArrays skinned_ring() {
    app::LayeredArrays arrays;
    arrays.meshes = {torus(1, 0.4f, 64, 16)};
    auto& mesh = arrays.meshes[0];
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      const auto bone = static_cast<uint8_t>(v / 16);
      LayeredSkin skin;
      const uint32_t used = 1 + static_cast<uint32_t>(v % 4);
      for (uint32_t i = 0; i < used; ++i) {
        skin.bones[i] = static_cast<uint8_t>((bone + i) % kBones);
        skin.weights[i] = 1.0f / static_cast<float>(used);
      }
      mesh.skin.push_back(skin);
    }
    arrays.instances = {{.mesh = 0,
                         .world_from_mesh = app::affine_rows(glm::rotate(glm::mat4(1), 0.7f, {1, 0, 0.4f})),
                         .bones = kBones}};
    return arrays;
  }
  static std::vector<glm::mat4> bones(bool with_translation) {
    std::vector<glm::mat4> out;
    for (uint32_t i = 0; i < kBones; ++i) {
      const float t = 0.1f * static_cast<float>(i);
      glm::mat4 bone = glm::rotate(glm::mat4(1), 0.2f * std::sin(t), {0, 1, 0.2f});
      if (with_translation) bone[3] = glm::vec4(0.2f * std::sin(2 * t), 0.3f * std::cos(t), 0, 1);
      out.push_back(bone);
    }
    return out;
  }
  static void pose(LayeredScene& posed, const std::vector<glm::mat4>& matrices) {
    std::vector<Affine> rows;
    for (const glm::mat4& m : matrices) rows.push_back(app::affine_rows(m));
    take(posed.set_bones(0, rows));
  }
  /// The same, skinned on the CPU; the instance keeps its transform or, as listing 19.7 has it, loses it.
  static app::LayeredArrays skinned_by_cpu(const std::vector<glm::mat4>& matrices, bool keeps_transform) {
    app::LayeredArrays arrays = skinned_ring();
    auto& mesh = arrays.meshes[0];
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      glm::vec3 sum(0);
      for (int i = 0; i < 4; ++i)
        if (mesh.skin[v].bones[i] != 255)
          sum += mesh.skin[v].weights[i] *
                 glm::vec3(matrices[mesh.skin[v].bones[i]] *
                           glm::vec4(mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z, 1));
      mesh.positions[v] = {sum.x, sum.y, sum.z};
    }
    mesh.skin.clear();
    arrays.instances[0].bones = 0;
    if (!keeps_transform) arrays.instances[0].world_from_mesh = {};
    return arrays;
  }
  static void expect_close(const Drawn& a, const Drawn& b, LayeredWriter writer) {
    const Difference difference = compare(a.depth, b.depth, 1);
    EXPECT_GT(difference.covered, 3000u);
    EXPECT_LE(difference.coverage, 8u) << name_of(writer);  // positions round otherwise on the CPU
    EXPECT_LE(difference.depth, 1e-3f) << name_of(writer);
  }
};

TEST_F(LayeredVertices, SimpleIsInstancedWithOneInstance) {
  app::LayeredArrays arrays;
  arrays.meshes = {torus(1, 0.4f, 40, 20)};
  arrays.instances = {{.mesh = 0, .world_from_mesh = app::affine_rows(glm::rotate(glm::mat4(1), 0.5f, {1, 0, 0}))}};
  LayeredScene drawn_scene = scene(arrays);
  const auto views = views_around(4, 5);
  for (const LayeredWriter writer : kAllWriters) {
    if (!has(writer)) continue;
    EXPECT_EQ(draw(drawn_scene, {.writer = writer, .vertices = LayeredVertices_::simple}, views, 64, 64).depth,
              draw(drawn_scene, {.writer = writer, .vertices = LayeredVertices_::instanced}, views, 64, 64).depth)
        << name_of(writer);
  }
}

TEST_F(LayeredVertices, SkinnedIsWhatTheCpuSkins) {
  const auto matrices = bones(true);
  LayeredScene expected_scene = scene(skinned_by_cpu(matrices, true)), drawn_scene = scene(skinned_ring());
  pose(drawn_scene, matrices);
  const auto views = views_around(4, 5);
  const Drawn expected = draw(expected_scene, {}, views, 96, 96);
  for (const LayeredWriter writer : kAllWriters)
    if (has(writer))
      expect_close(expected,
                   draw(drawn_scene, {.writer = writer, .vertices = LayeredVertices_::skinned}, views, 96, 96), writer);
}

TEST_F(LayeredVertices, ThePrintedListingLosesTranslationsAndTheModelMatrix) {
  const auto views = views_around(4, 5);
  LayeredScene drawn_scene = scene(skinned_ring());
  pose(drawn_scene, bones(true));
  LayeredScene without = scene(skinned_by_cpu(bones(false), false)), with = scene(skinned_by_cpu(bones(true), true));
  const Drawn expected = draw(without, {}, views, 96, 96), meant = draw(with, {}, views, 96, 96);
  for (const LayeredWriter writer : kAllWriters) {
    if (!has(writer)) continue;
    const Drawn found =
        draw(drawn_scene, {.writer = writer, .vertices = LayeredVertices_::skinned_mat3}, views, 96, 96);
    expect_close(expected, found, writer);
    EXPECT_GT(compare(meant.depth, found.depth, 1).coverage, 1000u) << "the listing's fault does not show";
  }
}

TEST_F(LayeredVertices, TransformsFollowFromFrameToFrame) {
  app::LayeredArrays arrays;
  arrays.meshes = {torus(1, 0.4f, 30, 16)};
  arrays.instances = {{.mesh = 0}};
  LayeredScene drawn_scene = scene(arrays);
  const auto views = views_around(3, 6);
  const glm::mat4 moved = glm::translate(glm::mat4(1), {0.5f, 0.6f, 0});
  const Drawn before = draw(drawn_scene, {}, views, 64, 64);
  take(drawn_scene.set_transform(0, app::affine_rows(moved)));
  const Drawn after = draw(drawn_scene, {}, views, 64, 64);
  arrays.instances[0].world_from_mesh = app::affine_rows(moved);
  LayeredScene expected_scene = scene(arrays);
  EXPECT_EQ(after.depth, draw(expected_scene, {}, views, 64, 64).depth);
  EXPECT_NE(after.depth, before.depth);
}

}  // namespace
}  // namespace umbrage::test
