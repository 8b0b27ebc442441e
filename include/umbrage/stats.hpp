// Statistics of a finished frame. They come back late, through memory that no frame in flight writes, and steer nothing
// but the sizes of lists.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "umbrage/types.hpp"

namespace umbrage {

struct PassTime {
  std::string_view name;  ///< As in docs/architecture.md; stable.
  double gpu_ms = 0;
};

/// One cascade of a directional light in one frame.
struct CascadeStatistics {
  enum class Action : uint8_t { kept, scrolled, cleared };
  Action action = Action::cleared;      ///< Of the map of static casters.
  uint32_t light = 0;                   ///< LightDesc::host_index.
  float begin_m = 0, end_m = 0;         ///< View depths of its sub-frustum.
  float texel_m = 0;
  uint32_t side = 0;                    ///< Texels.
  uint32_t texels_exposed = 0;          ///< Of the static map: drawn anew.
  uint32_t static_casters = 0;          ///< Batches listed for the static map.
  uint32_t active_casters = 0;          ///< And for the finished one.
  uint32_t occluded_casters = 0;        ///< Of both, not drawn.
  uint64_t static_triangles = 0;        ///< Of the batches drawn.
  uint64_t active_triangles = 0;
};

struct Statistics {
  uint64_t serial = 0;                  ///< The frame these belong to; 0 = none finished yet.
  std::span<const PassTime> passes;     ///< In order of execution. Valid until the next begin_frame.
  uint32_t lights = 0;
  uint32_t lights_visible = 0;          ///< That at least one cluster holds; not those that only other receivers (CameraDesc) need.
  uint64_t clusters = 0;                ///< Occupied.
  uint64_t cluster_light_pairs = 0;     ///< Lights summed over clusters, without those that had no room (then overflows).
  uint32_t shadow_maps = 0;             ///< Maps in use (a light has one with fixed-cubes).
  uint32_t shadow_views = 0;            ///< Their faces.
  uint64_t pages_requested = 0;         ///< Page pool, hardware sparse: marked at the resolutions asked for.
  uint64_t pages_resident = 0;          ///< That have memory, at the resolutions there was room for.
  uint64_t pages_rendered = 0;          ///< Drawn this frame.
  uint64_t texels_requested = 0;        ///< Of pages_requested.
  uint64_t unbacked_taps = 0;           ///< Texels looked up that nothing backs; where the host counts them (UMBRAGE_COUNT_TAPS).
  uint64_t unmarked_taps = 0;           ///< Looked up outside of what was marked, answered by the light's whole map; likewise.
  uint32_t map_resolution = 0;          ///< Texels along a side, fixed-cubes.
  uint64_t texels_allocated = 0;
  uint64_t caster_pairs = 0;            ///< (batch, map) pairs that were listed; fixed-cubes: (batch, view).
  uint64_t batches_drawn = 0;           ///< (batch, view) pairs that were drawn.
  uint64_t triangles_drawn = 0;         ///< (triangle, view) pairs.
  uint64_t casters = 0;                 ///< Batches of all instances.
  uint64_t shadow_memory_bytes = 0;     ///< Depth texels.
  uint64_t table_memory_bytes = 0;      ///< Everything else on the device that the system holds.
  uint64_t overflows = 0;               ///< Lists that were too short this frame, each handled as its degradation says.
  uint32_t lights_degraded = 0;
  uint64_t bytes_read_back = 0;         ///< That steered the frame: the list of pages to bind (O18). 0 with every store but hardware_sparse.
  uint32_t pages_bound = 0;             ///< Hardware sparse: newly, by bind_pages;
  uint32_t pages_unbound = 0;           ///< and given up.
  double bind_ms = 0;                   ///< CPU time of bind_pages, its waiting included.
  std::span<const CascadeStatistics> cascades;  ///< Light by light, near to far. Valid until the next begin_frame.
  double cpu_record_ms = 0;             ///< begin_frame + record_scene + record_shadows.
};

enum class Degradation : uint8_t {
  none,
  coarser,          ///< Resolution below what was asked for: the budget is short.
  no_map,           ///< No memory for even the smallest map: casts no shadow.
  casters_missing,  ///< Its casters did not fit the rounds that were recorded; right from the next frame on.
};

struct LightStatus {
  LightId light;
  Degradation reason = Degradation::none;
  uint64_t missing_bytes = 0;           ///< Memory that would cure it.
};

}  // namespace umbrage
