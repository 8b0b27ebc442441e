// Pictures and per-pixel arrays of the last frame on the CPU.
#pragma once
#include <vector>

#include "host/gbuffer.hpp"
#include "umbrage/needed_triangles.hpp"

namespace app {

enum class SurfaceArray : uint8_t { position, normal };

class ReadBack {
 public:
  static umbrage::Result<ReadBack> create(const GpuContext&, VkPipelineLayout);

  /// Ends and submits the pass's command buffer, which holds nothing else but bound sets; waits.
  umbrage::Result<std::vector<uint8_t>> picture(GpuContext&, PassContext&);
  umbrage::Result<std::vector<float>> color(GpuContext&, PassContext&);
  umbrage::Result<std::vector<float>> surface(GpuContext&, PassContext&, SurfaceArray);
  /// As Renderer::read_visibility; band_px empty: not wanted. Lights of one call fit max_visibility_lights().
  umbrage::Result<void> visibility(GpuContext&, PassContext&, uint32_t first, uint32_t count,
                                   std::span<uint8_t> visibility, std::span<uint8_t> band_px);
  static uint32_t max_visibility_lights(uint32_t pixels);

  /// From now on visibility() marks the pool's texels that its lookups read.
  umbrage::Result<void> mark_lookups(const GpuContext&, VkDeviceSize pool_bytes);
  /// Those marked so far, and how many of the frame's triangles cover one. Precondition: mark_lookups.
  umbrage::Result<NeededWork> needed(GpuContext&, PassContext&, umbrage::NeededTriangles&);

 private:
  umbrage::Result<void> reserve(const GpuContext&, DeviceBuffer&, VkDeviceSize bytes);
  umbrage::Result<const std::byte*> copy_image(GpuContext&, PassContext&, Target, VkDeviceSize bytes);

  Handle<VkPipeline> surface_, visibility_;
  DeviceBuffer buffer_, band_buffer_;  ///< Mapped; they grow to what was asked for.
  DeviceBuffer looked_up_;  ///< Mapped: the count of triangles, padding, then a bit for each texel of the pool.
};

}  // namespace app
