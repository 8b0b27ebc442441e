// Greedy: a group takes the next layer's views while everything fits.
#include "layered/split_views.hpp"

#include <algorithm>
#include <limits>

namespace umbrage::layered {

namespace {
constexpr uint32_t kAny = std::numeric_limits<uint32_t>::max();

struct Room {
  uint32_t views = kAny, layers = kAny;
};

Room room_of(LayeredWriter writer, const SplitLimits& limits) {
  switch (writer) {
    case LayeredWriter::traditional:
      return {1, 1};
    case LayeredWriter::geometry_invocations:
      return {limits.invocation_views, limits.framebuffer_layers};
    case LayeredWriter::geometry_loop:
      return {limits.loop_views, limits.framebuffer_layers};
    case LayeredWriter::vertex_layer:
      return {kAny, limits.framebuffer_layers};
    case LayeredWriter::multiview:
      return {limits.multiview_views, std::min(limits.multiview_views, limits.framebuffer_layers)};
    case LayeredWriter::mesh:
      return {kAny, std::min(limits.mesh_layers, limits.framebuffer_layers)};
    case LayeredWriter::atlas:
      return {kAny, 1};
    case LayeredWriter::compute:
      return {kAny, limits.compute_layers};
  }
  return {};
}
}  // namespace

std::vector<ViewGroup> split_views(LayeredWriter writer, const SplitLimits& limits, std::span<const SplitView> views,
                                   bool splits_mirrored) {
  const Room room = room_of(writer, limits);
  std::vector<ViewGroup> groups;
  for (uint32_t at = 0; at < views.size();) {
    // The views of one layer that may share a draw.
    uint32_t count = 1;
    while (at + count < views.size() && views[at + count].layer == views[at].layer && count < room.views &&
           (!splits_mirrored || views[at + count].is_mirrored == views[at].is_mirrored))
      ++count;
    const bool continues = at > 0 && views[at - 1].layer == views[at].layer;
    ViewGroup* group = groups.empty() ? nullptr : &groups.back();
    const bool joins = group && !continues && !group->continues && group->view_count + count <= room.views &&
                       group->layer_count < room.layers && views[at].layer == group->first_layer + group->layer_count &&
                       (!splits_mirrored || group->is_mirrored == views[at].is_mirrored);
    if (joins) {
      group->view_count += count;
      ++group->layer_count;
    } else {
      groups.push_back({at, count, views[at].layer, 1, views[at].is_mirrored, continues});
    }
    at += count;
  }
  return groups;
}

}  // namespace umbrage::layered
