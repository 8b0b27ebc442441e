// Views → groups: every view once, within the limits, whole layers together.
#include <gtest/gtest.h>

#include <algorithm>

#include "layered/patch_spirv.hpp"
#include "layered/split_views.hpp"

namespace umbrage::layered {
namespace {

constexpr SplitLimits kLimits{.framebuffer_layers = 64,
                              .loop_views = 10,
                              .invocation_views = 40,
                              .multiview_views = 6,
                              .mesh_layers = 8,
                              .compute_layers = 16};

std::vector<SplitView> one_a_layer(uint32_t count) {
  std::vector<SplitView> views;
  for (uint32_t i = 0; i < count; ++i) views.push_back({.layer = i});
  return views;
}

void expect_partition(const std::vector<ViewGroup>& groups, const std::vector<SplitView>& views) {
  uint32_t next = 0;
  for (const ViewGroup& group : groups) {
    EXPECT_EQ(group.first_view, next);
    ASSERT_GT(group.view_count, 0u);
    next += group.view_count;
    ASSERT_LE(next, views.size());
    EXPECT_EQ(group.first_layer, views[group.first_view].layer);
    EXPECT_EQ(group.first_layer + group.layer_count - 1, views[next - 1].layer);
    EXPECT_EQ(group.continues, group.first_view > 0 && views[group.first_view - 1].layer == group.first_layer);
    for (uint32_t i = group.first_view + 1; i < next; ++i)
      EXPECT_LE(views[i].layer - views[i - 1].layer, 1u) << "a gap would be cleared";
  }
  EXPECT_EQ(next, views.size());
}

size_t group_count(LayeredWriter writer, const std::vector<SplitView>& views, bool mirrored = false) {
  const auto groups = split_views(writer, kLimits, views, mirrored);
  expect_partition(groups, views);
  return groups.size();
}

TEST(SplitViews, TakesAsManyViewsAsTheWriterCan) {
  for (const uint32_t count : {1u, 6u, 32u, 33u, 100u}) {
    const auto views = one_a_layer(count);
    const auto rounds = [&](uint32_t most) { return (count + most - 1) / most; };
    EXPECT_EQ(group_count(LayeredWriter::traditional, views), count);
    EXPECT_EQ(group_count(LayeredWriter::geometry_invocations, views), rounds(40));
    EXPECT_EQ(group_count(LayeredWriter::geometry_loop, views), rounds(10));
    EXPECT_EQ(group_count(LayeredWriter::vertex_layer, views), rounds(64));
    EXPECT_EQ(group_count(LayeredWriter::multiview, views), rounds(6));
    EXPECT_EQ(group_count(LayeredWriter::mesh, views), rounds(8));
    EXPECT_EQ(group_count(LayeredWriter::atlas, views), count);
    EXPECT_EQ(group_count(LayeredWriter::compute, views), rounds(16));
  }
}

TEST(SplitViews, KeepsALayersViewsTogetherOrContinuesIt) {
  std::vector<SplitView> views(25, SplitView{.layer = 3});
  EXPECT_EQ(group_count(LayeredWriter::atlas, views), 1u);
  const auto loops = split_views(LayeredWriter::geometry_loop, kLimits, views, false);
  expect_partition(loops, views);
  ASSERT_EQ(loops.size(), 3u);
  EXPECT_FALSE(loops[0].continues);
  EXPECT_TRUE(loops[1].continues);
  views.push_back({.layer = 4});  // what follows a continued layer does not share its load
  EXPECT_EQ(group_count(LayeredWriter::geometry_loop, views), 4u);
}

TEST(SplitViews, LeavesGapsAlone) {
  const std::vector<SplitView> views{{.layer = 0}, {.layer = 1}, {.layer = 5}, {.layer = 6}};
  EXPECT_EQ(group_count(LayeredWriter::vertex_layer, views), 2u);
}

TEST(SplitViews, KeepsWindingsApartOnlyWhereAsked) {
  const std::vector<SplitView> views{{.layer = 0}, {.layer = 1, .is_mirrored = true}, {.layer = 2}};
  EXPECT_EQ(group_count(LayeredWriter::vertex_layer, views, false), 1u);
  EXPECT_EQ(group_count(LayeredWriter::vertex_layer, views, true), 3u);
}

TEST(PatchSpirv, SetsTheLiteralOfOneMode) {
  // Header, OpExecutionMode %4 Invocations 32, OpExecutionMode %4 OutputVertices 3.
  const std::vector<uint32_t> module{0x07230203, 0x00010600,    0, 10, 0, 4u << 16 | 16, 4, 0,
                                     32,         4u << 16 | 16, 4, 26, 3};
  auto expected = module;
  expected[8] = 5;
  EXPECT_EQ(with_execution_mode(module, kInvocations, 5), expected);
  expected = module;
  expected[12] = 96;
  EXPECT_EQ(with_execution_mode(module, kOutputVertices, 96), expected);
}

}  // namespace
}  // namespace umbrage::layered
