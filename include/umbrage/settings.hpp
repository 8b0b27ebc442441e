// Every variant of every technique is a combination of the fields below; a preset is a row of one table.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "umbrage/result.hpp"

namespace umbrage {

enum class ClusterBounds : uint8_t {
  implicit_cell,  ///< World box of the cluster's cell.
  explicit_bits,  ///< O9: three 10-bit number lines inside that box.
};
enum class LightAssignment : uint8_t {
  hierarchy,    ///< Through the 32-way light tree.
  brute_force,  ///< Every light against every cluster; same lists, for measurements.
};
enum class Store : uint8_t {
  fixed_cubes,  ///< One map per light, all of one resolution, in a depth atlas: the baseline of today's engines.
  page_pool,    ///< Virtual maps in a software page table over one pool, allocated on the device.
  physical_pool,///< O14: each map takes the next free one of a fixed set of D16 cube maps in resolution classes. Needs Capabilities::vertex_layer.
  hardware_sparse,  ///< O13: sparse images, whose pages the host binds as lookups need them (ShadowSystem::bind_pages). Needs Capabilities::sparse_residency.
};
/// How Store::hardware_sparse keeps depth.
enum class SparseTexels : uint8_t {
  automatic,    ///< depth16 where the device can, else words.
  words,        ///< 32-bit keys in storage images, written by atomics of fragments.
  depth16,      ///< O13: D16 attachments. Needs Capabilities::vertex_layer, and a driver whose sparse depth attachments work.
};
enum class MapLayout : uint8_t {
  exact,        ///< O8: up to maps_per_light maps per light, each as fine as its finest request, rounded up to whole pages.
  levels,       ///< Powers of two: the limit of many maps per light.
};
enum class ResolutionForm : uint8_t {
  paper,        ///< O2 as printed.
  corrected,    ///< E2, E3: texels match pixels (levels: at most 1.42 pixels wide).
};
enum class HistogramBuckets : uint8_t {
  logarithmic,  ///< E8: each bucket half as fine as the one before.
  linear,
};
enum class FacingAway : uint8_t {
  kept,
  dropped,      ///< Clusters (and blocks of ReceiverBoxes) whose normals all face away from a light ask it for nothing.
};
/// Of whose boxes pages and receivers are marked.
enum class ReceiverBoxes : uint8_t {
  clusters,     ///< O3, O7: clusters, as bounded by ClusterBounds. Points anywhere in a cluster's box find its pages.
  blocks,       ///< Of each cluster the samples in every 4×4 pixels: fewer pages, nearer receivers, fewer casters.
  samples,      ///< And of pages only the texels that the nine taps of samples read: fewer are drawn (Writer::compute).
};
/// Each drops what the one before does and more. The last three need virtual shadow maps; with fixed cubes they are view_mask.
enum class CasterCulling : uint8_t {
  light_volume,          ///< Batches whose box meets the light's volume go to all of its views.
  view_mask,             ///< Only to views whose frustum the box meets and that have receivers (CFM, O6).
  projection_map,        ///< And only where box and receivers share a tile of the view's 32×32 projection map (PMC, O7).
  projection_map_depth,  ///< And only if the view's farthest receiver lies behind the nearest point of the box (PMCD, O7).
  receiver_grid,         ///< The same tile by tile, on a grid of farthest receivers (O22).
};
enum class Writer : uint8_t {
  automatic,    ///< compute for the page pool, multi_draw for fixed cubes and the physical pool.
  traditional,  ///< Fixed cubes: one render pass per view; the batches are the GPU's, the passes are the CPU's.
  multi_draw,   ///< Fixed cubes: one render pass, one GPU-written multi-draw for everything. Physical pool: one for each class.
  compute,      ///< Page pool: triangles drawn by compute shaders.
  fragments,    ///< Page pool: one multi-draw without attachments, an atomic for every fragment.
};

/// How directional lights keep cascaded maps ("CSM Scrolling"); other lights keep the store's.
enum class CascadeMode : uint8_t {
  none,              ///< No cascades: maps in the store, as every light has.
  redraw,            ///< Everything is drawn into every cascade each frame.
  cached,            ///< Maps of static casters are kept while the camera stands still (C2).
  scrolled,          ///< And are scrolled when it moves (C3), with the paper's sets corrected (E17, E18).
  scrolled_literal,  ///< With the sets as printed: casters across the old border are missing.
  guard_band,        ///< Larger maps, in which the volume moves about until it leaves them (C8).
};

/// Fixed for the life of a system: what sizes its memory.
struct StaticSettings {
  uint32_t frames_in_flight = 2;             ///< 1…4.
  Store store = Store::page_pool;
  SparseTexels sparse_texels = SparseTexels::automatic;
  uint32_t budget_mib = 256;                 ///< Depth texels, 4…16384. Tables are reported apart.
  uint32_t batch_triangles = 128;            ///< O4: at most this many a batch, 32…1024.
  uint32_t max_cluster_light_pairs = 1 << 20;///< First size of the list; it grows to what the frames need.
  uint32_t max_caster_pairs = 1 << 17;       ///< (batch, map) pairs drawn per round, fixed_cubes: (batch, view); more are worked off in further rounds.
};

/// May change every frame.
struct FrameSettings {
  ClusterBounds cluster_bounds = ClusterBounds::explicit_bits;
  MapLayout layout = MapLayout::levels;
  ResolutionForm resolution = ResolutionForm::corrected;
  HistogramBuckets buckets = HistogramBuckets::logarithmic;  ///< Of the exact layout.
  FacingAway facing_away = FacingAway::dropped;
  ReceiverBoxes receiver_boxes = ReceiverBoxes::samples;
  uint32_t maps_per_light = 6;               ///< O8: at most, 1…16. Levels: coarser requests use the coarsest kept.
  uint32_t levels_per_sun = 16;              ///< Levels layout in the page pool: maps of a directional light at most, 1…16.
  uint32_t undersampling = 1;                ///< O17: divides every resolution; 1, 2 or 4.
  uint32_t receiver_grid = 32;               ///< Cells along a view's side that know their farthest receiver; at most, 1…32, a power of two.
  LightAssignment light_assignment = LightAssignment::hierarchy;
  CasterCulling caster_culling = CasterCulling::receiver_grid;
  Writer writer = Writer::automatic;
  uint32_t merge_below = 128;                ///< Levels: coarser requests share the map of this one; small maps cost triangles. 4…8192.
  uint32_t caster_error_percent = 75;        ///< Of a texel: how far simplified casters may lie off (MeshDesc::level_errors_m); 0: the finest ones. 0…400.
  uint32_t min_resolution = 16;              ///< Texels along a map's side, a power of two, 4…8192. Less only where the budget is short.
  uint32_t max_resolution = 8192;            ///< Likewise; at least min_resolution. Fixed cubes have 16…1024.
  CascadeMode cascades = CascadeMode::none;
  uint32_t cascade_count = 4;                ///< Of a light, 1…8.
  uint32_t cascade_resolution = 512;         ///< Texels along a side, a power of two, 64…4096. Three maps of 4 bytes a texel.
  uint32_t cascade_distance_m = 200;         ///< From the camera, where the last one ends; beyond it directional lights cast no shadow. 1…100000.
  uint32_t cascade_log_percent = 80;         ///< Splits: 0 evenly spaced, 100 logarithmic.
  uint32_t cascade_reach_m = 100;            ///< Of the depth range towards the light; more costs depth precision, less redraws what stands beyond. 0…100000.
  uint32_t cascade_guard_texels = 64;        ///< guard_band: on each side; more memory, fewer redraws. A power of two, 8…1024.
  uint32_t cascade_blend_percent = 10;       ///< Of a cascade's depth, in which it fades into the next; 0…50.
  uint32_t static_after_ms = 10000;          ///< Casters that have stood still so long (FrameDesc::time_s) are static. 0…86400000.
};

struct Settings {
  StaticSettings fixed;
  FrameSettings frame;
};

struct Preset {
  std::string_view name;
  std::string_view summary;  ///< One line.
  Settings settings;
};

/// All presets; the first is "default".
std::span<const Preset> presets();
/// Unknown name: an error that lists the names there are.
Result<Settings> preset(std::string_view name);

struct SettingInfo {
  std::string_view key;     ///< As in set_setting.
  std::string_view values;  ///< "implicit_cell|explicit_bits", "16..1024" and so on.
  std::string_view summary; ///< Unit, effect, trade-off; one line.
};
std::span<const SettingInfo> setting_infos();
/// Sets one field by its name. Unknown keys and values out of range are refused with what is allowed; settings stay as they were.
Result<void> set_setting(Settings& settings, std::string_view key, std::string_view value);
/// The value of one field as set_setting takes it. Precondition: key is one of setting_infos().
std::string get_setting(const Settings& settings, std::string_view key);
/// Checks the fields against each other.
Result<void> validate(const Settings& settings);

}  // namespace umbrage
