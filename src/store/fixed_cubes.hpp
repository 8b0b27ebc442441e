// The first store: one cube map a light (a spot or a directional light: one view), all of one resolution, side by side in one
// D32 atlas. The common baseline of today's engines.
#pragma once
#include "clusters/clusters.hpp"
#include "maps/map_types.shared.h"
#include "umbrage/stats.hpp"

namespace umbrage::store {

/// How the maps share the budget.
struct AtlasLayout {
  uint32_t resolution = 16;  ///< Texels along a tile's side: the largest power of two with which all views fit.
  uint32_t maps = 0, views = 0;
  uint32_t columns = 1, rows = 1;
};

/// Decides resolution and tiles, and writes them into the lights' records. When even the smallest maps do not fit, lights go
/// without by priority, then by slot; they are listed in `without`. Returns slots whose records changed.
AtlasLayout lay_out(IdPool<scene::HostLight>& lights, uint64_t budget_bytes, uint32_t max_side, const FrameSettings&,
                    std::vector<uint32_t>& changed, std::vector<LightStatus>& without);

class FixedCubes {
 public:
  /// An image for a layout; the former one is retired.
  Result<void> reserve(const gpu::Device&, gpu::Memory&, const AtlasLayout&, gpu::RetireQueue&, uint64_t serial);
  void fill(shared::FrameRecord&) const;
  const gpu::Image& atlas() const { return atlas_; }
  const AtlasLayout& layout() const { return layout_; }
  uint64_t texels() const { return uint64_t(atlas_.width()) * atlas_.height(); }

 private:
  AtlasLayout layout_;
  gpu::Image atlas_;
};

}  // namespace umbrage::store
