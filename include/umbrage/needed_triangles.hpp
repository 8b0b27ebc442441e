// An oracle for benchmarks: how many of a frame's triangles anyone looked at. What a frame draws beyond that is overhead.
#pragma once
#include <memory>

#include "umbrage/umbrage.hpp"

namespace umbrage {

/// Counts the (triangle, view) pairs among the casters of a system's last frame that cover a texel that was looked up, whether
/// or not something nearer covers it too. A shader knows which those are: the include calls UMBRAGE_VISIT_TEXEL(texel), a macro
/// of the host, for every texel of the pool that a tap reads. Slow, and no part of a frame.
class NeededTriangles {
 public:
  /// Compiles its pipelines. Errors: a store other than page_pool, what the device reports. The system outlives it.
  static Result<NeededTriangles> create(ShadowSystem&);
  NeededTriangles(NeededTriangles&&) noexcept;
  NeededTriangles& operator=(NeededTriangles&&) noexcept;
  ~NeededTriangles();

  /// Records the count after everything that reads the frame and before the system's next begin_frame. texels: bit i % 32 of word i / 32 is
  /// set where texel i of the pool was looked up, a word for every 32 texels of the budget; count: a word that the pairs are
  /// added to. The host makes both visible to compute before, and the count to whoever reads it after.
  /// Errors: no frame has been recorded.
  Result<void> record(VkCommandBuffer, VkDeviceAddress texels, VkDeviceAddress count);

 private:
  struct State;
  explicit NeededTriangles(std::unique_ptr<State>);
  std::unique_ptr<State> state_;
};

}  // namespace umbrage
