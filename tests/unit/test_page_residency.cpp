// The host's list of pages that have memory, over frames that ask for this and that.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "store/page_residency.hpp"

namespace umbrage::store {
namespace {

using Key = std::pair<uint32_t, uint32_t>;
Key key(const shared::SparsePage& page) { return {page.image_layer, page.place}; }

std::vector<shared::SparsePage> random_pages(std::mt19937& engine, uint32_t count) {
  const auto part = [&](uint32_t parts) { return static_cast<uint32_t>(engine() % parts); };
  std::set<Key> pages;
  while (pages.size() < count) pages.insert({part(3) << 16 | part(12), part(8) << 16 | part(8)});
  std::vector<shared::SparsePage> out;
  for (const auto& [image_layer, place] : pages) out.push_back({image_layer, place});
  std::shuffle(out.begin(), out.end(), engine);
  return out;
}

TEST(PageResidency, BindsWhatIsNewAndUnbindsWhatNobodyWants) {
  std::mt19937 engine(1);
  PageResidency residency;
  residency.reset(100);
  std::map<Key, uint32_t> memory;  // what a device would have, from the binds alone
  for (uint32_t frame = 0; frame < 200; ++frame) {
    const auto requested = random_pages(engine, frame % 17 == 0 ? 0u : static_cast<uint32_t>(engine() % 101));
    residency.plan(requested);
    for (const BoundPage& gone : residency.to_unbind()) {
      ASSERT_EQ(memory.at(key(gone.page)), gone.slot);
      memory.erase(key(gone.page));
    }
    for (const BoundPage& made : residency.to_bind()) {
      ASSERT_LT(made.slot, 100u);
      ASSERT_TRUE(memory.insert({key(made.page), made.slot}).second) << "bound twice";
    }
    residency.commit();
    std::set<uint32_t> slots;
    for (const auto& [page, slot] : memory) ASSERT_TRUE(slots.insert(slot).second) << "two pages in one slot";
    ASSERT_EQ(memory.size(), requested.size());
    for (const shared::SparsePage& page : requested) ASSERT_TRUE(memory.contains(key(page)));
    ASSERT_EQ(residency.resident().size(), memory.size());
    for (const BoundPage& page : residency.resident()) ASSERT_EQ(memory.at(key(page.page)), page.slot);
  }
}

TEST(PageResidency, LeavesWhatStaysWhereItIs) {
  std::mt19937 engine(2);
  PageResidency residency;
  residency.reset(64);
  const auto pages = random_pages(engine, 40);
  residency.plan(pages);
  residency.commit();
  residency.plan(pages);
  EXPECT_TRUE(residency.to_bind().empty());
  EXPECT_TRUE(residency.to_unbind().empty());
  residency.commit();
  residency.plan({pages.data(), 30});
  EXPECT_TRUE(residency.to_bind().empty());
  EXPECT_EQ(residency.to_unbind().size(), 10u);
  residency.commit();
  EXPECT_EQ(residency.resident().size(), 30u);
}

TEST(PageResidency, ForgetsAPlanThatIsNotCarriedOut) {
  std::mt19937 engine(3);
  PageResidency residency;
  residency.reset(64);
  const auto first = random_pages(engine, 40), second = random_pages(engine, 60);
  residency.plan(first);
  residency.commit();
  residency.plan(second);  // and then binding fails
  residency.plan(first);
  EXPECT_TRUE(residency.to_bind().empty());
  EXPECT_TRUE(residency.to_unbind().empty());
}

}  // namespace
}  // namespace umbrage::store
