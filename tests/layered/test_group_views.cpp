// Views that see the same casters come together, others stay apart, and no view is lost.
#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "umbrage/layered_pass.hpp"

namespace umbrage {
namespace {

/// Looks at a place from above; sees a few metres around it.
LayeredView view_of(float x) {
  const glm::mat4 matrix = glm::perspectiveRH_ZO(0.8f, 1.0f, 1.0f, 20.0f) *
                           glm::lookAtRH(glm::vec3(x, 10, 0), glm::vec3(x, 0, 0), glm::vec3(0, 0, 1));
  LayeredView view;
  std::memcpy(view.clip_from_world.m, &matrix, sizeof matrix);
  return view;
}

/// Boxes around places along x.
std::vector<Aabb> boxes_at(std::initializer_list<float> places) {
  std::vector<Aabb> boxes;
  for (const float x : places)
    for (int i = 0; i < 100; ++i) {
      const float at = x + 0.02f * static_cast<float>(i);
      boxes.push_back({{at - 0.1f, 0, -0.1f}, {at + 0.1f, 0.2f, 0.1f}});
    }
  return boxes;
}

void expect_partition(const std::vector<std::vector<uint32_t>>& groups, size_t count) {
  std::multiset<uint32_t> seen;
  for (const auto& group : groups) seen.insert(group.begin(), group.end());
  EXPECT_EQ(seen.size(), count);
  EXPECT_EQ(std::set<uint32_t>(seen.begin(), seen.end()).size(), count);
}

TEST(GroupViews, KeepsPlacesApartAndNeighboursTogether) {
  const std::vector<Aabb> boxes = boxes_at({0, 100, 200});
  std::vector<LayeredView> views;
  for (const float x : {0.0f, 100.0f, 200.0f, 0.3f, 100.2f, 200.1f}) views.push_back(view_of(x));
  const auto groups = group_overlapping_views(views, boxes);
  expect_partition(groups, views.size());
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0], (std::vector<uint32_t>{0, 3}));
  EXPECT_EQ(groups[1], (std::vector<uint32_t>{1, 4}));
  EXPECT_EQ(groups[2], (std::vector<uint32_t>{2, 5}));
}

TEST(GroupViews, FollowsTheCosts) {
  const std::vector<Aabb> boxes = boxes_at({0, 100});
  const std::vector<LayeredView> views{view_of(0), view_of(0.3f), view_of(0.6f), view_of(100)};
  EXPECT_EQ(group_overlapping_views(views, boxes, {.caster = 1, .caster_in_view = 0.5, .pass = 1e9}).size(), 1u)
      << "passes are dear";
  EXPECT_EQ(group_overlapping_views(views, boxes, {.caster = 0, .caster_in_view = 1, .pass = 0}).size(), 4u)
      << "nothing is shared";
  const auto pairs = group_overlapping_views(views, boxes, {.most_views = 2});
  expect_partition(pairs, views.size());
  for (const auto& group : pairs) EXPECT_LE(group.size(), 2u);
  EXPECT_TRUE(group_overlapping_views({}, boxes).empty());
  expect_partition(group_overlapping_views(views, {}), views.size());
}

}  // namespace
}  // namespace umbrage
