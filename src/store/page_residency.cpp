// Two sorted lists, walked side by side.
#include "store/page_residency.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace umbrage::store {

namespace {
uint64_t order(const shared::SparsePage& page) { return uint64_t(page.image_layer) << 32 | page.place; }
}  // namespace

void PageResidency::reset(uint32_t slots) {
  slots_ = slots;
  resident_.clear(), to_bind_.clear(), to_unbind_.clear(), next_.clear();
  free_.resize(slots);
  std::iota(free_.begin(), free_.end(), 0u);
}

void PageResidency::plan(std::span<const shared::SparsePage> requested) {
  assert(requested.size() <= slots_);
  wanted_.assign(requested.begin(), requested.end());
  std::sort(wanted_.begin(), wanted_.end(), [](const auto& a, const auto& b) { return order(a) < order(b); });
  to_bind_.clear(), to_unbind_.clear(), next_.clear();
  next_free_ = free_;
  auto have = resident_.begin();
  for (const shared::SparsePage& page : wanted_) {
    for (; have != resident_.end() && order(have->page) < order(page); ++have) to_unbind_.push_back(*have);
    if (have != resident_.end() && order(have->page) == order(page))
      next_.push_back(*have++);
    else
      to_bind_.push_back({page, 0});
  }
  to_unbind_.insert(to_unbind_.end(), have, resident_.end());
  for (const BoundPage& gone : to_unbind_) next_free_.push_back(gone.slot);
  std::sort(next_free_.begin(), next_free_.end());
  for (size_t i = 0; i < to_bind_.size(); ++i) to_bind_[i].slot = next_free_[i];
  next_free_.erase(next_free_.begin(), next_free_.begin() + static_cast<std::ptrdiff_t>(to_bind_.size()));
  const auto kept = static_cast<std::ptrdiff_t>(next_.size());
  next_.insert(next_.end(), to_bind_.begin(), to_bind_.end());
  std::inplace_merge(next_.begin(), next_.begin() + kept, next_.end(),
                     [](const auto& a, const auto& b) { return order(a.page) < order(b.page); });
}

void PageResidency::commit() {
  resident_.swap(next_);
  free_.swap(next_free_);
}

}  // namespace umbrage::store
