// Where grouping pays: eight places with four views each, drawn at once, by groups, and with casters selected for each view.
// Off by default; docs/layered-rendering.md quotes it.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "host/gpu_timers.hpp"
#include "layered_rig.hpp"
#include "meshes.hpp"

namespace umbrage::test {
namespace {

using LayeredGrouping = LayeredTest;

TEST_F(LayeredGrouping, DISABLED_MeasuresGroups) {
  auto quiet = take(app::GpuContext::create("", false));
  app::LayeredArrays arrays;
  arrays.meshes = {torus(1, 0.4f, 120, 60)};
  std::vector<Aabb> boxes;
  std::vector<LayeredView> views;
  for (int place = 0; place < 8; ++place) {
    const glm::vec3 at(40.0f * static_cast<float>(place), 0, 0);
    arrays.instances.push_back({.mesh = 0, .world_from_mesh = app::affine_rows(glm::translate(glm::mat4(1), at))});
    boxes.push_back({{at.x - 1.4f, -0.4f, -1.4f}, {at.x + 1.4f, 0.4f, 1.4f}});
    for (const LayeredView& around : views_around(4, 5)) {
      glm::mat4 matrix;
      std::memcpy(&matrix, around.clip_from_world.m, sizeof matrix);
      views.push_back(
          {.clip_from_world = app::mat4(glm::translate(matrix, -at)), .layer = static_cast<uint32_t>(views.size())});
    }
  }
  const auto groups = group_overlapping_views(views, boxes);
  LayeredScene drawn_scene = take(arrays.create(quiet->headless().desc()));
  auto images = take(app::LayerImages::create(*quiet, {.width = 128, .height = 128, .layers = 32}));
  const LayeredTarget target = take(LayeredTarget::create(drawn_scene, images.target()));
  app::GpuTimers timers = take(app::GpuTimers::create(*quiet));
  uint64_t serial = 0;
  const auto best_ms = [&](LayeredWriter writer, CasterSelection selection,
                           const std::vector<std::vector<uint32_t>>& passes) {
    std::vector<LayeredPass> made;
    for (const auto& group : passes)
      made.push_back(take(LayeredPass::create(
          drawn_scene, {.writer = writer, .views = static_cast<uint32_t>(group.size()), .selection = selection})));
    double best = 1e9;
    for (int run = 0; run < 7; ++run) {
      take(drawn_scene.begin_frame(++serial));
      const VkCommandBuffer commands = take(quiet->begin());
      drawn_scene.record(commands);
      timers.begin(*quiet, commands);
      for (size_t i = 0; i < passes.size(); ++i) {
        std::vector<LayeredView> chosen;
        for (const uint32_t view : passes[i]) chosen.push_back(views[view]);
        take(made[i].prepare({.target = target, .views = chosen}));
        made[i].record(commands);
      }
      timers.mark(*quiet, commands, "passes");
      take(quiet->submit_and_wait());
      best = std::min(best, take(timers.read(*quiet)).frame_ms);
    }
    return best;
  };
  std::vector<uint32_t> all(views.size());
  for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  std::printf("%zu groups\n", groups.size());
  for (const LayeredWriter writer : {LayeredWriter::geometry_invocations, LayeredWriter::vertex_layer,
                                     LayeredWriter::multiview, LayeredWriter::compute})
    if (has(writer))
      std::printf("%s: at once %.1f ms, grouped %.1f ms, each view its casters %.1f ms\n", name_of(writer).data(),
                  best_ms(writer, CasterSelection::any_view, {all}), best_ms(writer, CasterSelection::any_view, groups),
                  best_ms(writer, CasterSelection::each_view, {all}));
}

}  // namespace
}  // namespace umbrage::test
