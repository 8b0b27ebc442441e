// Ranges of a growing array: first fit, merged when given back.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace umbrage {

class RangePool {
 public:
  /// Where `count` elements now live; the array may have grown (size()).
  uint32_t take(uint32_t count) {
    if (count == 0) return 0;
    for (size_t i = 0; i < free_.size(); ++i) {
      if (free_[i].count < count) continue;
      const uint32_t first = free_[i].first;
      free_[i].first += count;
      free_[i].count -= count;
      if (free_[i].count == 0) free_.erase(free_.begin() + static_cast<std::ptrdiff_t>(i));
      return first;
    }
    const uint32_t first = size_;
    size_ += count;
    return first;
  }
  void give_back(uint32_t first, uint32_t count) {
    if (count == 0) return;
    auto at =
        std::lower_bound(free_.begin(), free_.end(), first, [](const Range& r, uint32_t f) { return r.first < f; });
    at = free_.insert(at, {first, count});
    if (at + 1 != free_.end() && at->first + at->count == (at + 1)->first) {
      at->count += (at + 1)->count;
      free_.erase(at + 1);
    }
    if (at != free_.begin() && (at - 1)->first + (at - 1)->count == at->first) {
      (at - 1)->count += at->count;
      free_.erase(at);
    }
  }
  uint32_t size() const { return size_; }

 private:
  struct Range {
    uint32_t first, count;
  };
  std::vector<Range> free_;
  uint32_t size_ = 0;
};

}  // namespace umbrage
