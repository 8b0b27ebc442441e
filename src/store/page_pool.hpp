// The default store: one pool of a fixed budget, a software page table, everything decided on the device. A page is 32×32
// texels of 32 bits, or less for coarse maps. Pages lie in the pool in the order of their words: by light, map, view and row.
#pragma once
#include "gpu/prefix_sum.hpp"
#include "maps/maps.hpp"
#include "umbrage/stats.hpp"
#include "views/sun_levels.shared.h"

namespace umbrage::store {

/// What a store has room for at least: so many views at the coarsest.
struct LeastRoom {
  uint64_t views = 0;
  uint64_t bytes_per_view = 0;
};
LeastRoom least_room_of_pool(uint64_t budget_bytes);

/// Views of a directional light whose maps are levels.
inline constexpr uint32_t kSunViews = shared::SunViews;

struct ViewCount {
  uint32_t views = 0;
  uint32_t suns = 0;  ///< Directional lights that cast shadows. Their views come first.
};
/// Numbers the views of lights that cast shadows. When not even the coarsest maps of all fit, lights go without by priority,
/// then by slot (`without`). `changed`: slots whose records changed. sun_views: numbers that a directional light takes; each of its
/// maps has one of them.
ViewCount number_views(IdPool<scene::HostLight>& lights, const LeastRoom&, uint32_t sun_views,
                       std::vector<uint32_t>& changed, std::vector<LightStatus>& without);

class PagePool {
 public:
  static Result<PagePool> create(const gpu::PipelineFactory&);
  Result<void> reserve(const gpu::Device&, gpu::Memory&, uint64_t budget_bytes, uint32_t word_capacity,
                       std::vector<gpu::Buffer>& retired);
  void fill(shared::FrameRecord& frame) const {
    frame.pool = pool_.address();
    frame.texel_bits = texel_bits_.address();
  }
  /// Places for the marked pages (they fit), and those cleared.
  void record(gpu::Recorder&, const maps::Maps&, const gpu::Buffer& frame, const gpu::Buffer& counters);
  const gpu::Buffer& pool() const { return pool_; }
  /// A bit a texel, cleared with its page: is it looked up? Maps::mark_texels() says.
  const gpu::Buffer& texel_bits() const { return texel_bits_; }
  uint32_t capacity_units() const;

 private:
  gpu::Pipeline clear_;
  gpu::PrefixSum scan_;
  gpu::Buffer pool_, texel_bits_, total_;
};

}  // namespace umbrage::store
