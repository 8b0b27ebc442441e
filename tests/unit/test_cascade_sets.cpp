// The sets that shaders decide from times and volume tests, against the paper's listings with real sets; scrolling; and what is
// wrong in the paper (E15…E18).
#include <gtest/gtest.h>

#include <random>

#include "cascades/cascade_grid.shared.h"
#include "reference/cascades.hpp"

namespace umbrage {
namespace {

using reference::CascadeErrata;
using reference::CascadeScheme;
using shared::GridBox;

constexpr int kSide = 32;

shared::CascadeRecord record(const glm::ivec3& origin, const glm::ivec3& former, uint32_t flags) {
  shared::CascadeRecord out{};
  out.origin = origin, out.former = former, out.side = kSide, out.flags = flags | shared::CascadeHolds;
  return out;
}

GridBox grid(const reference::GridCells& cells) { return {cells.lo, cells.hi}; }

struct World {
  struct Caster {
    reference::GridCells box, known;
    uint32_t moved_at = 0;
  };
  std::map<uint32_t, Caster> casters;
  std::vector<reference::GridCells> gone;  // static ones that left or were moved since the last frame, where they stood
  uint32_t now = 1, before = 0, static_after = 3, next = 0;
};

reference::GridCells random_box(std::mt19937& engine) {
  const auto in = [&](int lo, int hi) { return std::uniform_int_distribution(lo, hi)(engine); };
  const glm::ivec3 lo(in(-60, 60), in(-60, 60), in(-90000, 90000));
  return {lo, lo + glm::ivec3(in(0, 30), in(0, 30), in(0, 20000))};
}

/// Moves, deletes, adds; what was static in the frame before goes to `gone`, as note_moved sees it.
void edit(World& world, std::mt19937& engine) {
  world.before = world.now++;
  world.gone.clear();
  const auto note = [&](const World::Caster& caster) {
    if (shared::is_static_at(caster.moved_at, world.before, world.static_after)) world.gone.push_back(caster.box);
  };
  for (auto it = world.casters.begin(); it != world.casters.end();) {
    const auto dice = engine() % 200;
    const bool can_move = (it->second.moved_at & shared::NeverMoves) == 0;
    if (dice < 2 && can_move) note(it->second), it->second.box = random_box(engine), it->second.moved_at = world.now;
    if (dice == 2) {
      note(it->second);
      it = world.casters.erase(it);
    } else {
      ++it;
    }
  }
  if (engine() % 3 == 0) {
    const reference::GridCells box = random_box(engine);
    world.casters[world.next++] = {box, box, world.now | (engine() % 2 ? shared::NeverMoves : 0)};
  }
}

void expect_listing(CascadeScheme scheme, CascadeErrata errata, uint32_t seed) {
  std::mt19937 engine(seed);
  World world;
  for (; world.next < 40; ++world.next) {
    const reference::GridCells box = random_box(engine);
    world.casters[world.next] = {box, box, 1 | (engine() % 2 ? shared::NeverMoves : 0)};
  }
  reference::CascadeListing listing(scheme, errata);
  glm::ivec3 former(0);
  bool begins = true;
  size_t scrolls = 0, redraws = 0, keeps = 0;
  for (int frame = 0; frame < 400; ++frame) {
    if (frame) edit(world, engine);
    glm::ivec3 origin = former;
    const auto in = [&](int most) { return std::uniform_int_distribution(-most, most)(engine); };
    if (engine() % 3) origin += glm::ivec3(in(4), in(4), in(3000));
    if (engine() % 40 == 0) origin = glm::ivec3(in(40), in(40), in(70000));
    if (begins) former = origin;
    std::map<uint32_t, reference::CascadeCaster> casters;
    for (const auto& [id, caster] : world.casters)
      casters[id] = {caster.box, shared::is_static_at(caster.moved_at, world.now, world.static_after)};
    const auto expected = listing.frame({origin, kSide}, casters, begins);

    const uint32_t flags = errata == CascadeErrata::paper ? shared::CascadeLiteral : 0;
    shared::CascadeRecord cascade = record(origin, former, flags);
    if (begins || (scheme == CascadeScheme::cached && origin != former)) cascade.flags &= ~shared::CascadeHolds;
    bool is_broken = false;
    for (const reference::GridCells& box : world.gone) is_broken = is_broken || move_breaks_map(cascade, grid(box));
    const uint32_t action = action_of(cascade, is_broken);
    ASSERT_EQ(action == shared::MapIsCleared, expected.redraws) << frame;
    ASSERT_EQ(action == shared::MapIsScrolled, expected.scrolls_by.has_value()) << frame;
    if (expected.scrolls_by) { EXPECT_EQ(*expected.scrolls_by, cascade.origin - cascade.former); }
    std::set<uint32_t> into_static, into_working;
    for (const auto& [id, caster] : world.casters) {
      const bool is_static = shared::is_static_at(caster.moved_at, world.now, world.static_after);
      const bool was_static = shared::is_static_at(caster.moved_at, world.before, world.static_after);
      if (is_static && static_regions(cascade, action, grid(caster.box), was_static)) into_static.insert(id);
      if (!is_static && box_meets_volume(grid(caster.box), origin, kSide)) into_working.insert(id);
    }
    EXPECT_EQ(into_static, expected.into_static) << frame;
    EXPECT_EQ(into_working, expected.into_working) << frame;
    redraws += expected.redraws, scrolls += expected.scrolls_by.has_value(), keeps += action == shared::MapIsKept;
    former = origin;
    begins = false;
  }
  EXPECT_GT(redraws, 5u);
  EXPECT_GT(keeps, 20u);
  EXPECT_EQ(scrolls > 20, scheme == CascadeScheme::scrolled);
}

TEST(CascadeSets, FollowTheCachingListing) {
  for (uint32_t seed = 0; seed < 10; ++seed) expect_listing(CascadeScheme::cached, CascadeErrata::corrected, seed);
}
TEST(CascadeSets, FollowTheScrollingListingAsPrinted) {
  for (uint32_t seed = 0; seed < 10; ++seed) expect_listing(CascadeScheme::scrolled, CascadeErrata::paper, seed);
}
TEST(CascadeSets, FollowTheCorrectedScrollingListing) {
  for (uint32_t seed = 0; seed < 10; ++seed) expect_listing(CascadeScheme::scrolled, CascadeErrata::corrected, seed);
}

TEST(CascadeSets, RegionsAreDisjointAndCoverWhatAMoveExposes) {
  for (const glm::ivec2 by : {glm::ivec2(0),
                              {3, 0},
                              {-3, 0},
                              {0, 5},
                              {0, -5},
                              {4, 7},
                              {-4, 7},
                              {4, -7},
                              {-31, -31},
                              {32, 0},
                              {100, -100},
                              {-40, 2}}) {
    const shared::CascadeRecord cascade = record({by, 0}, {0, 0, 0}, 0);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto in = [&](uint32_t region) {
          const shared::TexelRect rect = region_rect(cascade, region);
          return x >= rect.first.x && x <= rect.last.x && y >= rect.first.y && y <= rect.last.y;
        };
        const bool was_there = x + by.x >= 0 && x + by.x < kSide && y + by.y >= 0 && y + by.y < kSide;
        EXPECT_TRUE(in(shared::RegionWhole));
        EXPECT_EQ(in(shared::RegionKept), was_there);
        EXPECT_EQ(int(in(shared::RegionColumns)) + int(in(shared::RegionRows)), was_there ? 0 : 1)
            << by.x << " " << by.y << " " << x << " " << y;
      }
  }
}

TEST(CascadeSets, CorrectedRegionsHoldEveryTexelThatNeedsTheCaster) {
  std::mt19937 engine(9);
  const auto in = [&](int most) { return std::uniform_int_distribution(-most, most)(engine); };
  size_t needed = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::ivec3 by(in(12), in(12), i % 3 ? in(30000) : 0);
    const reference::GridCells box = random_box(engine);
    const shared::CascadeRecord cascade = record(by, {0, 0, 0}, 0);
    const uint32_t regions =
        static_regions(cascade, by == glm::ivec3(0) ? shared::MapIsKept : shared::MapIsScrolled, grid(box), true);
    const auto texels = texels_to_draw({by, kSide}, {{0, 0, 0}, kSide}, box);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (!texels[static_cast<size_t>(y) * kSide + x]) continue;
        ++needed;
        bool is_drawn = false;
        for (uint32_t region = 1; region < 1u << shared::RegionKinds; region <<= 1) {
          const shared::TexelRect rect = region_rect(cascade, region);
          is_drawn = is_drawn || ((regions & region) && x >= rect.first.x && x <= rect.last.x && y >= rect.first.y &&
                                  y <= rect.last.y);
        }
        ASSERT_TRUE(is_drawn);
      }
  }
  EXPECT_GT(needed, 10000u);
}

TEST(CascadeSets, TheListingAsPrintedForgetsStraddlers) {            // E17
  const reference::GridCells straddler{{20, 4, 100}, {44, 8, 200}};  // across the right border of V'
  const glm::ivec3 moved(6, 0, 0);
  const auto regions = [&](uint32_t flags) {
    return static_regions(record(moved, {0, 0, 0}, flags), shared::MapIsScrolled, grid(straddler), true);
  };
  EXPECT_EQ(regions(shared::CascadeLiteral), 0u);
  EXPECT_EQ(regions(0), shared::RegionColumns);
}

TEST(CascadeSets, StillnessIsCountedFromTheLastMove) {
  EXPECT_FALSE(shared::is_static_at(10, 10, 5));
  EXPECT_FALSE(shared::is_static_at(10, 14, 5));
  EXPECT_TRUE(shared::is_static_at(10, 15, 5));
  EXPECT_FALSE(shared::is_static_at(10, 9, 0));  // before it was there
  EXPECT_TRUE(shared::is_static_at(10, 10, 0));
  EXPECT_TRUE(shared::is_static_at(10 | shared::NeverMoves, 10, 1000));
  EXPECT_FALSE(shared::is_static_at(10 | shared::NeverMoves, 9, 1000));
}

TEST(CascadeScroll, IsThePapersShader) {
  EXPECT_EQ(shared::scrolled_depth(65535, 500), 65535u);  // a looked-up 1.0 stays 1.0
  EXPECT_EQ(shared::scrolled_depth(65535, -500), 65535u);
  EXPECT_EQ(shared::scrolled_depth(1000, 300), 700u);
  EXPECT_EQ(shared::scrolled_depth(1000, 1001), 0u);     // below the near plane: 0
  EXPECT_EQ(shared::scrolled_depth(65534, -1), 65535u);  // beyond the far plane: clear
  EXPECT_EQ(shared::scrolled_depth(0, -700), 700u);      // E18: what was clamped comes back wrong
}

TEST(CascadeScroll, QuadAsPrintedReadsOtherTexels) {  // E15
  EXPECT_NEAR(reference::quad_u(0.25, 0.5, 0.1, 1.1, false), 0.35, 1e-12);
  EXPECT_NEAR(reference::quad_u(0.75, 0.75, 0.1, 1.1, false), 0.85, 1e-12);
  EXPECT_NEAR(reference::quad_u(0.25, 0.5, 0.1, 1.1, true), 0.1, 1e-12);
  EXPECT_NEAR(reference::quad_u(0.75, 0.75, 0.1, 1.1, true), 0.6, 1e-12);
}

TEST(CascadeScroll, DepthUnitsOfTwoToTheSixteenDrift) {  // E16
  EXPECT_EQ(reference::depth_after_moves(1000, 500, 60, 65535), 1000u + 500 * 60);
  EXPECT_EQ(reference::depth_after_moves(1000, 1, 40000, 65536), 40999u);  // one move of 40000 steps is a step short
  EXPECT_EQ(reference::depth_after_moves(1000, 1, 40000, 65535), 41000u);
}

TEST(CascadeScroll, OfTheReferenceUndoesItselfWithinTheVolume) {
  reference::CascadeMap map({{5, -7, 100}, kSide});
  std::mt19937 engine(4);
  for (uint32_t& depth : map.depth) depth = engine() % 4 ? 2000 + static_cast<uint32_t>(engine() % 60000) : 65535;
  const auto there = reference::scrolled(map, {{5, -7, 1100}, kSide}), back = reference::scrolled(there, map.volume);
  EXPECT_EQ(back.depth, map.depth);
}

}  // namespace
}  // namespace umbrage
