// Which pages of sparse images have memory: on the host, because only a queue can bind (O13, O18). Knows nothing of Vulkan.
#pragma once
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "store/sparse_page.shared.h"

namespace umbrage::store {

/// A page in whose place memory lies, or is to.
struct BoundPage {
  shared::SparsePage page;
  uint32_t slot = 0;  ///< Of the memory.
};

class PageResidency {
 public:
  /// So many pages have memory at once; none has yet.
  void reset(uint32_t slots);
  /// Keeps what is requested and resident, gives up what is not requested, and finds slots for the rest, the lowest first. No
  /// page occurs twice, and there are at most as many as slots. Nothing changes before commit().
  void plan(std::span<const shared::SparsePage> requested);
  const std::vector<BoundPage>& to_bind() const { return to_bind_; }
  const std::vector<BoundPage>& to_unbind() const { return to_unbind_; }
  void commit();

  /// In the order of image, layer, y, x.
  const std::vector<BoundPage>& resident() const { return resident_; }
  uint32_t slots() const { return slots_; }

 private:
  uint32_t slots_ = 0;
  std::vector<BoundPage> resident_, to_bind_, to_unbind_, next_;
  std::vector<shared::SparsePage> wanted_;
  std::vector<uint32_t> free_, next_free_;  // sorted
};

}  // namespace umbrage::store
