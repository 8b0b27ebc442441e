// Virtual shadow maps (Olsson et al. 2014, sections 3 and 4): how fine each light's maps are, which of their pages anyone
// will look at, and how both give way when the pool is short.
#pragma once
#include <array>

#include "maps/other_receivers.hpp"
#include "maps/views.hpp"

namespace umbrage::maps {

class Maps {
 public:
  static Result<Maps> create(const gpu::PipelineFactory&);

  struct Sizes {
    uint32_t light_slots = 0;
    uint32_t suns = 0;   ///< Directional lights whose maps are levels.
    uint32_t pairs = 0;  ///< Capacity of the cluster/light lists.
    uint32_t maps = 0, words = 0, receiver_views = 0;
    uint32_t receiver_grid = 1;  ///< Cells along a view's side.
  };
  Result<void> reserve(const gpu::Device&, gpu::Memory&, const Sizes&, std::vector<gpu::Buffer>& retired);
  void fill(shared::FrameRecord&) const;

  /// How the store backs maps.
  struct Backing {
    glm::uvec2 block{shared::PageSide,
                     shared::PageSide};  ///< Texels that it backs at once; resolutions are multiples of the width.
    uint32_t capacity_units = 0;         ///< Of what it can back; units of PoolUnit texels.
    VkDeviceAddress images = 0;          ///< shared::MapImage in `frame`, where maps lie in images.
    uint32_t image_count = 0;
    uint32_t most_views = UINT32_MAX;  ///< That find a layer, however they are spread.
    bool whole_images = false;         ///< Not in blocks: a map has all of its layers.
  };

  struct Inputs {
    const scene::GpuScene& scene;
    const clusters::Clusters& clusters;
    const gpu::Buffer& frame;
    const gpu::Buffer& counters;
    const gpu::Buffer& views;
    const FrameSettings& settings;
    std::span<const clusters::FrameCamera> cameras;
    Backing backing;
    OtherReceivers& others;
  };
  /// What is asked for → maps with their images, marked pages and receivers, with page_first() counted in pool units (page pool);
  /// all of it fits.
  void record(gpu::Recorder&, const Inputs&);

  /// Which texels of the pool lookups of the cameras' samples read, once pages have their places: bits, cleared before.
  void mark_texels(gpu::Recorder&, const Inputs&, const gpu::Buffer& texel_bits);

  const gpu::Buffer& maps() const { return maps_; }
  const gpu::Buffer& page_bits() const { return page_bits_; }
  /// Pool units that each word's pages need, until the store has turned them into places.
  const gpu::Buffer& page_first() const { return page_first_; }
  const gpu::Buffer& projection() const { return projection_; }
  const gpu::Buffer& receiver_depth() const { return receiver_depth_; }
  /// Bits of the resolution that each cluster/light pair asked for; 0: it faces away.
  const gpu::Buffer& pair_requests() const { return pair_requests_; }
  const Sizes& sizes() const { return sizes_; }
  const gpu::Buffer& light_maps() const { return light_maps_; }
  /// What a lookup reads.
  std::array<const gpu::Buffer*, 5> published() const {
    return {&maps_, &light_maps_, &pair_maps_, &page_bits_, &page_first_};
  }

 private:
  /// Rounds in which the budget is fitted: as asked, by estimate, one halving more, the coarsest (which always fits).
  static constexpr uint32_t kRounds = 4;
  shared::MapsPush push(const Inputs&) const;
  /// Are maps of directional lights windows of levels?
  static bool has_sun_levels(const Inputs&);
  void request(gpu::Recorder&, const Inputs&);
  void place_levels(gpu::Recorder&, const Inputs&);
  void fit(gpu::Recorder&, const Inputs&, uint32_t round);
  void mark_blocks(gpu::Recorder&, const Inputs&);
  void place(gpu::Recorder&, const Inputs&);
  void count(gpu::Recorder&, const Inputs&, const shared::MapsPush&);

  Sizes sizes_;
  gpu::Pipeline request_, bucket_, place_levels_, choose_, place_, clear_, mark_, mark_blocks_, mark_texels_, count_pages_,
      count_blocks_, estimate_, fit_;
  gpu::Buffer maps_, light_maps_, requests_, level_bounds_, demand_, pair_requests_, pair_maps_, page_bits_,
      page_first_, projection_, receiver_depth_;
};

}  // namespace umbrage::maps
