// In-shader culling (E11–E14) changes no texel of closed meshes seen from outside, and drops what it should.
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "layered_rig.hpp"
#include "meshes.hpp"

namespace umbrage::test {
namespace {

class LayeredCulling : public LayeredTest {
 protected:
  /// A plain ring, one with its axes swapped by a mirroring, views that mirror and that do not.
  static app::LayeredArrays rings() {
    app::LayeredArrays arrays;
    arrays.meshes = {torus(1, 0.4f, 48, 28)};
    const glm::mat4 one(1);
    arrays.instances = {{.mesh = 0, .world_from_mesh = app::affine_rows(one)},
                        {.mesh = 0,
                         .world_from_mesh = app::affine_rows(
                             glm::scale(glm::translate(one, {0.9f, 0.9f, 0.2f}), {-0.8f, 0.9f, 1.2f}))}};
    return arrays;
  }
  static std::vector<LayeredView> mixed_views() {
    std::vector<LayeredView> views = views_around(6, 5);
    glm::mat4 flip(1);
    flip[1][1] = -1;
    for (uint32_t i = 0; i < 6; i += 2) {
      glm::mat4 matrix;
      std::memcpy(&matrix, views[i].clip_from_world.m, sizeof matrix);
      views[i].clip_from_world = app::mat4(flip * matrix);
    }
    const glm::mat4 sun = glm::orthoRH_ZO(-3.0f, 3.0f, -3.0f, 3.0f, 0.1f, 20.0f) *
                          glm::lookAtRH(glm::vec3(4, 8, 2), glm::vec3(0), glm::vec3(0, 1, 0));
    views.push_back({.clip_from_world = app::mat4(sun), .layer = 6});
    return views;
  }
};

TEST_F(LayeredCulling, OfBackFacesAndFrustaChangesNothingOnClosedMeshes) {
  LayeredScene drawn_scene = scene(rings());
  const std::vector<LayeredView> views = mixed_views();
  for (const LayeredWriter writer : kAllWriters) {
    // Multiview needs groups it was created for, and views that wind both ways would split them.
    if (!has(writer) || writer == LayeredWriter::multiview) continue;
    const Drawn expected = draw(drawn_scene, {.writer = writer}, views, 128, 128);
    for (const bool frustum : {false, true}) {
      const Drawn found = draw(
          drawn_scene, {.writer = writer, .cull_frustum = frustum, .culled_faces = CulledFaces::back}, views, 128, 128);
      const Difference difference = compare(expected.depth, found.depth, 1);
      EXPECT_GT(difference.covered, 10000u);
      // A back face seen edge-on may win a texel of the silhouette that no front face covers.
      EXPECT_LE(difference.coverage, difference.covered / 2000) << name_of(writer);
      EXPECT_LE(difference.depth, 0.002f) << name_of(writer);
    }
  }
}

TEST_F(LayeredCulling, OfFrustaIsExact) {
  LayeredScene drawn_scene = scene(rings());
  const std::vector<LayeredView> views = cube_views({0.9f, 0.1f, 0.2f}, 0.01f, 9);
  for (const LayeredWriter writer :
       {LayeredWriter::geometry_invocations, LayeredWriter::geometry_loop, LayeredWriter::mesh}) {
    if (!has(writer)) continue;
    const Drawn expected = draw(drawn_scene, {.writer = writer}, views, 96, 96);
    const Drawn found = draw(drawn_scene, {.writer = writer, .cull_frustum = true}, views, 96, 96);
    EXPECT_EQ(expected.depth, found.depth) << name_of(writer);
  }
}

TEST_F(LayeredCulling, OfFrontFacesLeavesTheFarSide) {
  LayeredScene drawn_scene = scene(rings());
  const std::vector<LayeredView> views = mixed_views();
  const Drawn near = draw(drawn_scene, {.culled_faces = CulledFaces::back}, views, 96, 96);
  Drawn reference = draw(drawn_scene, {.culled_faces = CulledFaces::front}, views, 96, 96);
  size_t farther = 0, covered = 0;
  for (size_t i = 0; i < near.depth.size(); ++i) {
    if (near.depth[i] == 1.0f || reference.depth[i] == 1.0f) continue;
    ++covered;
    farther += reference.depth[i] > near.depth[i];
  }
  EXPECT_GT(covered, 5000u);
  EXPECT_GT(farther, covered * 99 / 100);
  // The shader's test and the fixed function's agree for every writer.
  for (const LayeredWriter writer : kAllWriters) {
    if (!has(writer) || writer == LayeredWriter::multiview) continue;
    const Difference difference =
        compare(reference.depth,
                draw(drawn_scene, {.writer = writer, .culled_faces = CulledFaces::front}, views, 96, 96).depth, 1);
    EXPECT_LE(difference.coverage, 20u) << name_of(writer);
  }
}

TEST_F(LayeredCulling, SelectionDrawsNoLessThanEverything) {
  app::LayeredArrays arrays;
  arrays.meshes = {torus(1, 0.4f, 40, 20)};
  for (int i = 0; i < 27; ++i)
    arrays.instances.push_back({.mesh = 0,
                                .world_from_mesh = app::affine_rows(glm::rotate(
                                    glm::translate(glm::mat4(1), 4.0f * glm::vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)),
                                    float(i), {0.3f, 1, 0}))});
  LayeredScene drawn_scene = scene(arrays);
  const std::vector<LayeredView> views = cube_views({1, 2, 1.5f}, 0.05f, 30);
  for (const LayeredWriter writer : kAllWriters) {
    if (!has(writer)) continue;
    const Drawn expected = draw(drawn_scene, {.writer = writer, .selection = CasterSelection::all}, views, 96, 96);
    for (const CasterSelection selection : {CasterSelection::any_view, CasterSelection::each_view})
      EXPECT_EQ(expected.depth, draw(drawn_scene, {.writer = writer, .selection = selection}, views, 96, 96).depth)
          << name_of(writer);
  }
}

}  // namespace
}  // namespace umbrage::test
