// Virtual shadow maps (Olsson et al. 2014, sections 3 and 4): how fine each light's maps are, which of their pages anyone
// will look at, and how both give way when the pool is short.
#pragma once
#include "maps/views.hpp"

namespace umbrage::maps {

class Maps {
 public:
  static Result<Maps> create(const gpu::PipelineFactory&);

  struct Sizes {
    uint32_t light_slots = 0;
    uint32_t pairs = 0;           ///< Capacity of the cluster/light lists.
    uint32_t maps = 0, words = 0, receiver_views = 0;
    uint32_t receiver_grid = 1;   ///< Cells along a view's side.
  };
  Result<void> reserve(const gpu::Device&, gpu::Memory&, const Sizes&, std::vector<gpu::Buffer>& retired);
  void fill(shared::FrameRecord&) const;

  struct Inputs {
    const scene::GpuScene& scene;
    const clusters::Clusters& clusters;
    const gpu::Buffer& frame;
    const gpu::Buffer& counters;
    const gpu::Buffer& views;
    const FrameSettings& settings;
    uint32_t capacity_units;      ///< Of the pool.
    bool all_lights;
  };
  /// What is asked for → maps, marked pages and receivers, with pages_of_words() counted in pool units; all of it fits.
  void record(gpu::Recorder&, const Inputs&);

  const gpu::Buffer& maps() const { return maps_; }
  const gpu::Buffer& page_bits() const { return page_bits_; }
  /// Pool units that each word's pages need, until the store has turned them into places.
  const gpu::Buffer& page_first() const { return page_first_; }
  const gpu::Buffer& projection() const { return projection_; }
  const gpu::Buffer& receiver_depth() const { return receiver_depth_; }
  /// Bits of the resolution that each cluster/light pair asked for; 0: it faces away.
  const gpu::Buffer& pair_requests() const { return pair_requests_; }
  const Sizes& sizes() const { return sizes_; }
  /// What a lookup reads.
  std::array<const gpu::Buffer*, 5> published() const { return {&maps_, &light_maps_, &pair_maps_, &page_bits_, &page_first_}; }

 private:
  /// Rounds in which the budget is fitted: as asked, by estimate, one halving more, the coarsest (which always fits).
  static constexpr uint32_t kRounds = 4;
  shared::MapsPush push(const Inputs&) const;
  void request(gpu::Recorder&, const Inputs&);
  void fit(gpu::Recorder&, const Inputs&, uint32_t round);

  Sizes sizes_;
  gpu::Pipeline request_, bucket_, choose_, clear_, mark_, count_, estimate_, fit_;
  gpu::Buffer maps_, light_maps_, requests_, demand_, pair_requests_, pair_maps_, page_bits_, page_first_, projection_, receiver_depth_;
};

}  // namespace umbrage::maps
