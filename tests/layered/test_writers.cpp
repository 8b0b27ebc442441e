// Every writer draws the same layers: vertex-shader writers bit by bit, the others as close as docs/layered-rendering.md says.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "import/gltf_import.hpp"
#include "layered_rig.hpp"
#include "meshes.hpp"

namespace umbrage::test {
namespace {

constexpr uint32_t kWriteInputs[] =
#include "shaders/write_inputs.frag.inc"
    ;

app::LayeredArrays some_rings() {
  app::LayeredArrays arrays;
  arrays.meshes = {torus(1, 0.4f, 40, 24), square(2)};
  const glm::mat4 one(1);
  arrays.instances = {
      {.mesh = 0, .world_from_mesh = app::affine_rows(one), .host_index = 3},
      {.mesh = 0,
       .world_from_mesh = app::affine_rows(glm::translate(one, {1.2f, 0.3f, 0}) * glm::rotate(one, 1.3f, {1, 0.3f, 0})),
       .host_index = 4},
      {.mesh = 0,
       .world_from_mesh = app::affine_rows(glm::scale(glm::translate(one, {-1.5f, -0.4f, 0.5f}), {-0.7f, 1.1f, 0.8f})),
       .host_index = 5},
      {.mesh = 1, .world_from_mesh = app::affine_rows(glm::translate(one, {0, -0.8f, 0})), .host_index = 6}};
  return arrays;
}

class LayeredWriters : public LayeredTest {
 protected:
  /// Vertex shaders make the same bits. A driver may place the vertices of other stages with another rounding. Compute takes depth
  /// from vertices as they are snapped, which moves it by a fraction of what it changes by from texel to texel.
  static void expect_same(LayeredWriter writer, const Drawn& expected, const Drawn& found, float unit = 4e-6f) {
    const bool is_compute = writer == LayeredWriter::compute;
    const Difference difference = compare(expected.depth, found.depth, unit, is_compute ? expected.width : 0);
    EXPECT_GT(difference.covered, 100u) << "nothing was drawn";
    const bool is_vertex_stage = writer == LayeredWriter::traditional || writer == LayeredWriter::vertex_layer ||
                                 writer == LayeredWriter::multiview;
    if (is_vertex_stage) {
      EXPECT_EQ(expected.depth, found.depth) << name_of(writer);
      return;
    }
    EXPECT_LE(difference.coverage, is_compute ? 1 + expected.depth.size() / 50000 : expected.depth.size() / 1000000)
        << name_of(writer);
    EXPECT_LE(difference.deeper, is_compute ? difference.covered / 2000 : 0) << name_of(writer);
  }

  static void expect_all_same(const app::LayeredArrays& arrays, LayeredPassSettings settings,
                              const std::vector<LayeredView>& views, uint32_t side, float unit = 4e-6f) {
    LayeredScene drawn_scene = scene(arrays);
    const Drawn expected = draw(drawn_scene, settings, views, side, side);
    for (const LayeredWriter writer : kAllWriters) {
      if (!has(writer)) continue;
      settings.writer = writer;
      expect_same(writer, expected, draw(drawn_scene, settings, views, side, side), unit);
    }
  }
};

using LayeredScenes = LayeredWriters;

TEST_F(LayeredWriters, DrawTheSameLayersForAnyNumberOfViews) {
  for (const uint32_t count : {1u, 6u, 32u, 33u, 100u}) {
    SCOPED_TRACE(count);
    expect_all_same(some_rings(), {}, views_around(count, 6), count > 6 ? 48 : 160);
  }
}

TEST_F(LayeredWriters, DrawTheSameWithEverySelectionAndSixteenBits) {
  for (const CasterSelection selection : {CasterSelection::all, CasterSelection::any_view, CasterSelection::each_view})
    expect_all_same(some_rings(), {.selection = selection}, cube_views({0.2f, 0.1f, 0.3f}, 0.05f, 20), 96);
  expect_all_same(some_rings(), {.depth_format = VK_FORMAT_D16_UNORM}, views_around(6, 6), 97, 1.1f / 65535);
}

TEST_F(LayeredWriters, DrawLargerIsNearerToo) {
  LayeredScene drawn_scene = scene(some_rings());
  std::vector<LayeredView> views;
  for (uint32_t i = 0; i < 4; ++i) {
    const glm::vec3 eye(4 * std::cos(float(i)), 2, 4 * std::sin(float(i)));
    views.push_back({.clip_from_world = app::mat4(glm::perspectiveRH_ZO(0.9f, 1.0f, 30.0f, 0.2f) *
                                                  glm::lookAtRH(eye, glm::vec3(0), glm::vec3(0, 1, 0))),
                     .layer = i});
  }
  LayeredPassSettings settings{.depth_order = DepthOrder::larger_is_nearer};
  const Drawn expected = draw(drawn_scene, settings, views, 128, 128);
  settings.writer = LayeredWriter::compute;
  const Difference difference =
      compare(expected.depth, draw(drawn_scene, settings, views, 128, 128).depth, 4e-6f, 128, 0.0f);
  EXPECT_GT(difference.covered, 1000u);
  EXPECT_LE(difference.coverage, 1u);
  EXPECT_LE(difference.deeper, difference.covered / 2000);
}

TEST_F(LayeredWriters, DrawLayersOfDifferentSize) {
  const std::vector<LayeredView> whole = views_around(4, 6);
  const VkRect2D areas[] = {{{0, 0}, {128, 128}}, {{128, 0}, {64, 96}}, {{130, 100}, {61, 27}}, {{0, 128}, {192, 64}}};
  for (const bool one_layer : {true, false}) {
    std::vector<LayeredView> views = whole;
    for (uint32_t i = 0; i < 4; ++i) views[i].area = areas[i], views[i].layer = one_layer ? 0 : i;
    LayeredScene drawn_scene = scene(some_rings());
    LayeredPassSettings settings{.areas = true};
    const Drawn expected = draw(drawn_scene, settings, views, 192, 192);
    // Nothing outside of the areas.
    for (uint32_t y = 0; y < 192; ++y)
      for (uint32_t x = 0; x < 192; ++x) {
        const bool inside = std::any_of(std::begin(areas), std::end(areas), [&](const VkRect2D& a) {
          return int(x) >= a.offset.x && int(y) >= a.offset.y && x < a.offset.x + a.extent.width &&
                 y < a.offset.y + a.extent.height;
        });
        if (!inside && one_layer) { ASSERT_EQ(expected.depth[y * 192 + x], 1.0f) << x << ", " << y; }
      }
    for (const LayeredWriter writer : kAllWriters) {
      if (!has(writer) || writer == LayeredWriter::multiview) continue;
      settings.writer = writer;
      const Drawn found = draw(drawn_scene, settings, views, 192, 192);
      if (writer == LayeredWriter::compute) {
        // Vertices snap to the grid of the area, not of the layer: a texel in some thousand differs at silhouettes.
        EXPECT_LE(compare(expected.depth, found.depth, 1).coverage, expected.depth.size() / 2000);
      } else {
        expect_same(writer, expected, found);
      }
    }
  }
}

TEST_F(LayeredWriters, LeaveClearLayersWhereViewsSeeNothing) {
  LayeredScene drawn_scene = scene(some_rings());
  std::vector<LayeredView> views = views_around(3, 6);
  const glm::mat4 away = glm::perspectiveRH_ZO(0.8f, 1.0f, 0.1f, 50.0f) *
                         glm::lookAtRH(glm::vec3(0, 0, 30), glm::vec3(0, 0, 60), glm::vec3(0, 1, 0));
  views[1].clip_from_world = app::mat4(away);
  for (const LayeredWriter writer : kAllWriters) {
    if (!has(writer)) continue;
    for (const bool nothing_at_all : {false, true}) {
      std::vector<LayeredView> shown = views;
      if (nothing_at_all) shown = {{.clip_from_world = app::mat4(away), .layer = 0}};
      const Drawn drawn = draw(drawn_scene, {.writer = writer}, shown, 64, 64);
      const size_t empty = nothing_at_all ? 0 : 64 * 64;
      EXPECT_TRUE(std::all_of(drawn.depth.begin() + long(empty), drawn.depth.begin() + long(empty) + 64 * 64,
                              [](float d) { return d == 1.0f; }))
          << name_of(writer);
    }
  }
}

TEST_F(LayeredWriters, HandTheSameInputsToColourShaders) {
  LayeredScene drawn_scene = scene(some_rings());
  const std::vector<LayeredView> views = views_around(7, 6);
  LayeredPassSettings settings{.color_fragment = kWriteInputs};
  const Drawn expected = draw(drawn_scene, settings, views, 96, 96);
  size_t seen_views = 0;
  for (uint32_t layer = 0; layer < 7; ++layer)
    for (size_t i = 0; i < 96 * 96; ++i) {
      const size_t at = layer * 96 * 96 + i;
      if (expected.depth[at] == 1.0f) continue;
      ASSERT_EQ(std::fmod(expected.color[4 * at + 3], 1000.0f), float(layer));
      ++seen_views;
    }
  EXPECT_GT(seen_views, 1000u);
  for (const LayeredWriter writer : kAllWriters) {
    if (!has(writer) || writer == LayeredWriter::compute) continue;
    settings.writer = writer;
    const Drawn found = draw(drawn_scene, settings, views, 96, 96);
    size_t different = 0;
    for (size_t i = 0; i < expected.color.size(); ++i)
      different += std::abs(expected.color[i] - found.color[i]) > 1e-4f;
    // Where triangles meet at the same depth, whichever comes first stays.
    EXPECT_LE(different, expected.color.size() / 10000) << name_of(writer);
  }
}

TEST_F(LayeredScenes, DragonIsTheSame) {
  const std::string file = scene_file("stanford_dragon/dragon_35578.glb");
  if (file.empty()) GTEST_SKIP() << "no dragon";
  const app::Scene dragon = take(app::import_gltf(file));
  const app::Pose pose = app::pose(dragon, 0);
  const app::LayeredArrays arrays = app::layered_arrays(dragon, pose, nullptr);
  glm::vec3 lo(1e9f), hi(-1e9f);
  for (const Vec3& p : arrays.meshes[0].positions) {
    const glm::vec3 world = glm::vec3(pose.instances[0].world_from_mesh * glm::vec4(p.x, p.y, p.z, 1));
    lo = glm::min(lo, world), hi = glm::max(hi, world);
  }
  std::vector<LayeredView> views = views_around(6, 1.2f * glm::length(hi - lo));
  for (LayeredView& view : views) {
    glm::mat4 matrix;
    std::memcpy(&matrix, view.clip_from_world.m, sizeof matrix);
    view.clip_from_world = app::mat4(glm::translate(matrix, -0.5f * (lo + hi)));
  }
  expect_all_same(arrays, {.vertices = LayeredVertices::simple}, views, 256, 1e-5f);
}

TEST_F(LayeredScenes, SponzaWithItsMasksIsTheSame) {
  const std::string file = scene_file("sponza/sponza.gltf");
  if (file.empty()) GTEST_SKIP() << "no sponza";
  const app::Scene sponza = take(app::import_gltf(file));
  const app::TextureTable textures = take(app::TextureTable::create(gpu(), sponza));
  const app::LayeredArrays arrays = app::layered_arrays(sponza, app::pose(sponza, 0), &textures);
  ASSERT_GE(arrays.masks.size(), 3u);
  LayeredScene drawn_scene = scene(arrays);
  const std::vector<LayeredView> views = cube_views({-5, 3, 0}, 0.1f, 60);
  LayeredPassSettings settings{.selection = CasterSelection::each_view};
  const Drawn expected = draw(drawn_scene, settings, views, 128, 128);
  for (const LayeredWriter writer : kAllWriters) {
    if (!has(writer)) continue;
    settings.writer = writer;
    settings.cull_frustum = writer == LayeredWriter::geometry_invocations || writer == LayeredWriter::geometry_loop ||
                            writer == LayeredWriter::mesh;
    const Drawn found = draw(drawn_scene, settings, views, 128, 128);
    const Difference difference = compare(expected.depth, found.depth, 4e-6f, 128);
    EXPECT_GT(difference.covered, expected.depth.size() * 9 / 10);
    // Masks: the compute writer takes one level of detail for a triangle. Elsewhere clipping by clip distances rounds anew.
    EXPECT_LE(difference.coverage, 2u) << name_of(writer);
    EXPECT_LE(difference.deeper, writer == LayeredWriter::compute ? difference.covered / 500 : 0) << name_of(writer);
  }
}

/// Mirrored instances have lists of their own where the hardware culls; in colour passes their fragment shader is the host's.
TEST_F(LayeredScenes, ColourPassesDrawMaskedBatchesWhereFacesAreCulled) {
  const std::string file = scene_file("sponza/sponza.gltf");
  if (file.empty()) GTEST_SKIP() << "no sponza";
  if (!has(LayeredWriter::geometry_loop)) GTEST_SKIP() << "no geometry shader to compare with";
  const app::Scene sponza = take(app::import_gltf(file));
  const app::TextureTable textures = take(app::TextureTable::create(gpu(), sponza));
  app::LayeredArrays arrays = app::layered_arrays(sponza, app::pose(sponza, 0), &textures);
  ASSERT_GE(arrays.masks.size(), 3u);
  const size_t instances = arrays.instances.size();
  for (size_t i = 0; i < instances; ++i) {
    arrays.instances.push_back(arrays.instances[i]);
    for (int row = 0; row < 3; ++row) arrays.instances.back().world_from_mesh.m[4 * row] *= -1;
  }
  LayeredScene drawn_scene = scene(arrays);
  const std::vector<LayeredView> views = cube_views({-5, 3, 0}, 0.1f, 60);
  LayeredPassSettings settings{
      .writer = LayeredWriter::geometry_loop, .culled_faces = CulledFaces::back, .color_fragment = kWriteInputs};
  const Drawn expected = draw(drawn_scene, settings, views, 128, 128);
  for (const LayeredWriter writer : {LayeredWriter::traditional, LayeredWriter::vertex_layer}) {
    if (!has(writer)) continue;
    settings.writer = writer;
    const Drawn found = draw(drawn_scene, settings, views, 128, 128);
    const Difference difference = compare(expected.depth, found.depth, 4e-6f, 128);
    EXPECT_GT(difference.covered, expected.depth.size() * 9 / 10);
    EXPECT_LE(difference.coverage, difference.covered / 1000) << name_of(writer);
    EXPECT_LE(difference.deeper, difference.covered / 1000) << name_of(writer);
  }
}

}  // namespace
}  // namespace umbrage::test
