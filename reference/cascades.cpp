#include "reference/cascades.hpp"

#include <algorithm>
#include <cmath>

namespace reference {

namespace {
constexpr int kFar = 65534;
}

bool CascadeVolume::holds_texel(int x, int y) const {
  return x >= origin.x && y >= origin.y && x < origin.x + side && y < origin.y + side;
}

bool CascadeVolume::holds(const GridCells& box) const {
  return box.hi.x >= origin.x && box.lo.x < origin.x + side && box.hi.y >= origin.y && box.lo.y < origin.y + side &&
         box.lo.z <= origin.z + kFar;
}

CascadeDecision CascadeListing::frame(const CascadeVolume& volume, const std::map<uint32_t, CascadeCaster>& casters,
                                      bool projection_changed) {
  const CascadeVolume former = volume_;
  volume_ = volume;
  if (projection_changed || (scheme_ == CascadeScheme::cached && !(volume == former))) is_valid_ = false;

  const std::map<uint32_t, GridCells> former_static = std::move(static_);
  static_ = {};
  CascadeDecision decision;
  for (const auto& [id, caster] : casters) {
    if (!volume.holds(caster.box)) continue;
    if (caster.is_static)
      static_[id] = caster.box;
    else
      decision.into_working.insert(id);
  }

  // Members of S' that stand in V ∩ V' by their cached positions, and are no longer static or have been deleted.
  const glm::ivec2 both_lo = glm::max(glm::ivec2(volume.origin), glm::ivec2(former.origin));
  const glm::ivec2 both_hi =
      glm::min(glm::ivec2(volume.origin) + volume.side, glm::ivec2(former.origin) + former.side) - 1;
  const int both_far = std::min(volume.origin.z, former.origin.z) + kFar;
  for (const auto& [id, box] : former_static) {
    const bool meets = box.hi.x >= both_lo.x && box.lo.x <= both_hi.x && box.hi.y >= both_lo.y &&
                       box.lo.y <= both_hi.y && both_lo.x <= both_hi.x && both_lo.y <= both_hi.y &&
                       box.lo.z <= both_far;
    const auto now = casters.find(id);
    if (meets && (now == casters.end() || !now->second.is_static)) is_valid_ = false;
  }

  decision.redraws = !is_valid_;
  if (is_valid_ && !(volume == former)) decision.scrolls_by = volume.origin - former.origin;
  for (const auto& [id, box] : static_) {
    bool is_drawn = !is_valid_ || !former_static.contains(id);
    if (!is_drawn && errata_ == CascadeErrata::corrected) {
      const std::vector<bool> texels = texels_to_draw(volume, former, box);
      is_drawn = std::find(texels.begin(), texels.end(), true) != texels.end();
    }
    if (is_drawn) decision.into_static.insert(id);
  }
  is_valid_ = true;
  return decision;
}

std::vector<bool> texels_to_draw(const CascadeVolume& now, const CascadeVolume& former, const GridCells& box) {
  std::vector<bool> texels(static_cast<size_t>(now.side) * now.side, false);
  if (box.lo.z > now.origin.z + kFar) return texels;
  // Depths before the near side of V' were clamped to it, those beyond its far side forgotten; that matters where V has them.
  const bool was_clamped = box.lo.z < former.origin.z && now.origin.z < former.origin.z;
  const bool was_forgotten = box.hi.z > former.origin.z + kFar && now.origin.z > former.origin.z;
  for (int y = 0; y < now.side; ++y)
    for (int x = 0; x < now.side; ++x) {
      const glm::ivec2 at = glm::ivec2(now.origin) + glm::ivec2(x, y);
      const bool is_covered = at.x >= box.lo.x && at.x <= box.hi.x && at.y >= box.lo.y && at.y <= box.hi.y;
      texels[static_cast<size_t>(y) * now.side + x] =
          is_covered && (!former.holds_texel(at.x, at.y) || was_clamped || was_forgotten);
    }
  return texels;
}

CascadeMap scrolled(const CascadeMap& map, const CascadeVolume& volume) {
  CascadeMap out(volume);
  for (int y = 0; y < volume.side; ++y)
    for (int x = 0; x < volume.side; ++x) {
      const glm::ivec2 from = glm::ivec2(volume.origin - map.volume.origin) + glm::ivec2(x, y);
      if (from.x < 0 || from.y < 0 || from.x >= map.volume.side || from.y >= map.volume.side) continue;
      const uint32_t depth = map.depth[static_cast<size_t>(from.y) * map.volume.side + from.x];
      if (depth == 65535) continue;
      const int moved = static_cast<int>(depth) + map.volume.origin.z - volume.origin.z;
      if (moved <= kFar)
        out.depth[static_cast<size_t>(y) * volume.side + x] = static_cast<uint32_t>(std::max(moved, 0));
    }
  return out;
}

void draw_triangle(CascadeMap& map, const std::array<glm::dvec3, 3>& grid) {
  std::array<glm::i64vec2, 3> p;
  std::array<double, 3> z;
  for (size_t i = 0; i < 3; ++i) {
    p[i] = {std::llround(grid[i].x * 256), std::llround(grid[i].y * 256)};
    z[i] = grid[i].z;
  }
  const auto edge = [&](size_t a, size_t b, const glm::i64vec2& at) {
    return (p[b].x - p[a].x) * (at.y - p[a].y) - (p[b].y - p[a].y) * (at.x - p[a].x);
  };
  if (edge(0, 1, p[2]) == 0) return;
  if (edge(0, 1, p[2]) < 0) std::swap(p[1], p[2]), std::swap(z[1], z[2]);
  const auto area = static_cast<double>(edge(0, 1, p[2]));
  const auto is_inside = [&](size_t a, size_t b, int64_t value) {
    const int64_t step_x = p[a].y - p[b].y, step_y = p[b].x - p[a].x;
    return value > 0 || (value == 0 && (step_x > 0 || (step_x == 0 && step_y > 0)));
  };
  for (int y = 0; y < map.volume.side; ++y)
    for (int x = 0; x < map.volume.side; ++x) {
      const glm::i64vec2 at((map.volume.origin.x + x) * 256LL + 128, (map.volume.origin.y + y) * 256LL + 128);
      const int64_t w0 = edge(1, 2, at), w1 = edge(2, 0, at), w2 = edge(0, 1, at);
      if (!is_inside(1, 2, w0) || !is_inside(2, 0, w1) || !is_inside(0, 1, w2)) continue;
      const double depth = (double(w0) * z[0] + double(w1) * z[1] + double(w2) * z[2]) / area;
      const auto relative = static_cast<int64_t>(std::floor(depth + 0.5)) - map.volume.origin.z;
      uint32_t& texel = map.depth[static_cast<size_t>(y) * map.volume.side + x];
      if (relative <= kFar) texel = std::min(texel, static_cast<uint32_t>(std::max<int64_t>(relative, 0)));
    }
}

double quad_u(double x, double y, double u0, double u1, bool as_printed) {
  // Vertices (0,0) (0,1) (1,0) (1,1); triangles 0-1-2 and 1-2-3 meet on the line x + y = 1.
  const double u2 = as_printed ? u0 : u1;
  if (x + y <= 1) return u0 + x * (u2 - u0);
  return u1 + (1 - x) * (u0 - u1) + (1 - y) * (u2 - u1);
}

uint32_t depth_after_moves(uint32_t depth, int moves, int steps, double steps_per_range) {
  for (int i = 0; i < moves; ++i)
    depth = static_cast<uint32_t>(std::lround(std::clamp(depth / 65535.0 + steps / steps_per_range, 0.0, 1.0) * 65535));
  return depth;
}

}  // namespace reference
