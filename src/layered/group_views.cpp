// Views worth drawing together: two groups are merged while that saves work, the pair that saves most first.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "umbrage/layered_pass.hpp"

namespace umbrage {

namespace {

/// Which casters something sees.
using Bits = std::vector<uint64_t>;

struct Group {
  std::vector<uint32_t> views;
  Bits sees;
};

/// As may_see in select_casters.comp: false only if the box lies outside of one clip plane.
bool may_see(const Mat4& clip, const Aabb& box) {
  const auto row = [&](int r, int c) { return double(clip.m[4 * c + r]); };
  for (int plane = 0; plane < 6; ++plane) {
    const int axis = plane / 2;
    const double sign = plane % 2 ? 1 : -1;
    double p[4];
    for (int c = 0; c < 4; ++c)
      p[c] = axis < 2 ? row(3, c) + sign * row(axis, c) : plane % 2 ? row(2, c) : row(3, c) - row(2, c);
    const double farthest = p[3] + p[0] * (p[0] > 0 ? box.max.x : box.min.x) +
                            p[1] * (p[1] > 0 ? box.max.y : box.min.y) + p[2] * (p[2] > 0 ? box.max.z : box.min.z);
    if (farthest < -1e-5 * (std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]) + std::abs(p[3]))) return false;
  }
  return true;
}

uint64_t count_of(const Bits& a, const Bits& b) {
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += static_cast<uint64_t>(std::popcount(a[i] | b[i]));
  return count;
}

double cost_of(uint64_t casters, size_t views, const GroupingCosts& costs) {
  return static_cast<double>(casters) * (costs.caster + costs.caster_in_view * static_cast<double>(views)) + costs.pass;
}

}  // namespace

std::vector<std::vector<uint32_t>> group_overlapping_views(std::span<const LayeredView> views,
                                                           std::span<const Aabb> casters, const GroupingCosts& costs) {
  std::vector<Group> groups;
  for (uint32_t v = 0; v < views.size(); ++v) {
    Group group{{v}, Bits((casters.size() + 63) / 64)};
    for (size_t c = 0; c < casters.size(); ++c)
      if (may_see(views[v].clip_from_world, casters[c])) group.sees[c / 64] |= uint64_t{1} << (c % 64);
    groups.push_back(std::move(group));
  }
  for (;;) {
    double best = 0;
    size_t into = 0, from = 0;
    for (size_t a = 0; a < groups.size(); ++a)
      for (size_t b = a + 1; b < groups.size(); ++b) {
        const size_t together = groups[a].views.size() + groups[b].views.size();
        if (together > costs.most_views) continue;
        const double saved = cost_of(count_of(groups[a].sees, groups[a].sees), groups[a].views.size(), costs) +
                             cost_of(count_of(groups[b].sees, groups[b].sees), groups[b].views.size(), costs) -
                             cost_of(count_of(groups[a].sees, groups[b].sees), together, costs);
        if (saved > best) best = saved, into = a, from = b;
      }
    if (best <= 0) break;
    Group& target = groups[into];
    target.views.insert(target.views.end(), groups[from].views.begin(), groups[from].views.end());
    for (size_t i = 0; i < target.sees.size(); ++i) target.sees[i] |= groups[from].sees[i];
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(from));
  }
  std::vector<std::vector<uint32_t>> out;
  for (Group& group : groups) {
    std::sort(group.views.begin(), group.views.end());
    out.push_back(std::move(group.views));
  }
  return out;
}

}  // namespace umbrage
