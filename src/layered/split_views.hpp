// Views → groups that one render pass of a writer can draw on a device. No Vulkan calls, so that tests can try any limits.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "umbrage/layered_pass.hpp"

namespace umbrage::layered {

/// What a device offers a writer.
struct SplitLimits {
  uint32_t framebuffer_layers = 256;
  uint32_t loop_views = 1;         ///< Triangles that a geometry shader may emit.
  uint32_t invocation_views = 32;  ///< Invocations times what each may emit.
  uint32_t multiview_views = 6;
  uint32_t mesh_layers = 8;
  uint32_t compute_layers = 1;  ///< Layers whose keys fit the compute writer's buffer.
};

/// What of a view matters for the split.
struct SplitView {
  uint32_t layer = 0;
  bool is_mirrored = false;  ///< Its pictures wind the other way; matters to fixed-function culling.
};

struct ViewGroup {
  uint32_t first_view = 0, view_count = 0;  ///< In order of layers.
  uint32_t first_layer = 0, layer_count = 0;
  bool is_mirrored = false;
  bool continues = false;  ///< Its layer has been drawn to by the group before: loaded, not cleared.
};

/// views are sorted by layer. Groups span consecutive layers without gaps; a layer's views stay together where the limits
/// allow it. splits_mirrored: groups hold views of one winding only. Multiview: layers are distinct.
std::vector<ViewGroup> split_views(LayeredWriter, const SplitLimits&, std::span<const SplitView> views,
                                   bool splits_mirrored);

}  // namespace umbrage::layered
