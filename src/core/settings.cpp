// The preset table, and settings as text.
#include "umbrage/settings.hpp"

#include <array>
#include <bit>
#include <charconv>

namespace umbrage {

namespace {
struct Choice {
  std::string_view name;
  uint32_t value;
};

/// One settable field: how to read it, how to write it, what it may be.
struct Field {
  SettingInfo info;
  uint32_t (*get)(const Settings&);
  void (*set)(Settings&, uint32_t);
  std::span<const Choice> choices;  // empty: a number
  uint32_t min = 0, max = 0;
  bool power_of_two = false;
};

constexpr std::array<Choice, 2> kBounds{{{"implicit_cell", 0}, {"explicit_bits", 1}}};
constexpr std::array<Choice, 2> kAssignment{{{"hierarchy", 0}, {"brute_force", 1}}};
constexpr std::array<Choice, 5> kCulling{
    {{"light_volume", 0}, {"view_mask", 1}, {"projection_map", 2}, {"projection_map_depth", 3}, {"receiver_grid", 4}}};
constexpr std::array<Choice, 5> kWriter{
    {{"automatic", 0}, {"traditional", 1}, {"multi_draw", 2}, {"compute", 3}, {"fragments", 4}}};
constexpr std::array<Choice, 4> kStore{
    {{"fixed_cubes", 0}, {"page_pool", 1}, {"physical_pool", 2}, {"hardware_sparse", 3}}};
constexpr std::array<Choice, 3> kSparseTexels{{{"automatic", 0}, {"words", 1}, {"depth16", 2}}};
constexpr std::array<Choice, 2> kLayout{{{"exact", 0}, {"levels", 1}}};
constexpr std::array<Choice, 2> kResolution{{{"paper", 0}, {"corrected", 1}}};
constexpr std::array<Choice, 2> kBuckets{{{"logarithmic", 0}, {"linear", 1}}};
constexpr std::array<Choice, 6> kCascades{
    {{"none", 0}, {"redraw", 1}, {"cached", 2}, {"scrolled", 3}, {"scrolled_literal", 4}, {"guard_band", 5}}};
constexpr std::array<Choice, 3> kReceiverBoxes{{{"clusters", 0}, {"blocks", 1}, {"samples", 2}}};
constexpr std::array<Choice, 2> kFacingAway{{{"kept", 0}, {"dropped", 1}}};

#define UMB_FIELD(path)                                            \
  [](const Settings& s) { return static_cast<uint32_t>(s.path); }, \
      [](Settings& s, uint32_t v) { s.path = static_cast<decltype(s.path)>(v); }

const auto kFields = std::to_array<Field>({
    {{"cluster_bounds", "implicit_cell|explicit_bits",
      "bounds of a cluster: its cell, or tight ones from three 10-bit number lines (O9)"},
     UMB_FIELD(frame.cluster_bounds),
     kBounds},
    {{"light_assignment", "hierarchy|brute_force",
      "lights per cluster through the 32-way light tree, or every pair tested"},
     UMB_FIELD(frame.light_assignment),
     kAssignment},
    {{"caster_culling", "light_volume|view_mask|projection_map|projection_map_depth|receiver_grid",
      "batches in the light's volume to all its views, to those they meet, or only where and in front of what receives "
      "(virtual shadow maps)"},
     UMB_FIELD(frame.caster_culling),
     kCulling},
    {{"writer", "automatic|traditional|multi_draw|compute|fragments",
      "fixed cubes: a render pass per view or one multi-draw; page pool: compute shaders or an atomic a fragment"},
     UMB_FIELD(frame.writer),
     kWriter},
    {{"store", "fixed_cubes|page_pool|physical_pool|hardware_sparse",
      "one map per light in an atlas; or virtual maps in a pool of pages, of whole cube maps (O14), or in sparse "
      "images (O13)"},
     UMB_FIELD(fixed.store),
     kStore},
    {{"sparse_texels", "automatic|words|depth16",
      "hardware_sparse: D16 attachments where the device can, or 32-bit words in storage images"},
     UMB_FIELD(fixed.sparse_texels),
     kSparseTexels},
    {{"layout", "exact|levels", "maps as fine as asked and rounded up to pages (O8), or powers of two"},
     UMB_FIELD(frame.layout),
     kLayout},
    {{"resolution", "paper|corrected",
      "texels a cluster asks for: O2 as printed, or texels that match pixels (E2, E3)"},
     UMB_FIELD(frame.resolution),
     kResolution},
    {{"buckets", "logarithmic|linear", "steps of the histogram behind a light's maps (O8, E8); exact layout"},
     UMB_FIELD(frame.buckets),
     kBuckets},
    {{"facing_away", "kept|dropped", "cluster/light pairs whose normals all face away from the light"},
     UMB_FIELD(frame.facing_away),
     kFacingAway},
    {{"receiver_boxes", "clusters|blocks|samples",
      "what marks pages and receivers: boxes of clusters (O3, O7), of their samples in every 4x4 pixels, or these and "
      "each sample's texels"},
     UMB_FIELD(frame.receiver_boxes),
     kReceiverBoxes},
    {{"maps_per_light", "1..16", "maps of different resolution that a light may have (O8)"},
     UMB_FIELD(frame.maps_per_light),
     {},
     1,
     16},
    {{"levels_per_sun", "1..16",
      "levels of a directional light that may have a map; fewer are each used for more (levels layout, page pool)"},
     UMB_FIELD(frame.levels_per_sun),
     {},
     1,
     16},
    {{"undersampling", "1..4, a power of two", "divides every resolution (O17)"},
     UMB_FIELD(frame.undersampling),
     {},
     1,
     4,
     true},
    {{"receiver_grid", "1..32, a power of two",
      "cells along a view's side that know their farthest receiver, for depth culling; fewer where there are thousands "
      "of lights"},
     UMB_FIELD(frame.receiver_grid),
     {},
     1,
     32,
     true},
    {{"merge_below", "4..8192, a power of two", "levels layout: coarser requests share the map of this resolution"},
     UMB_FIELD(frame.merge_below),
     {},
     4,
     8192,
     true},
    {{"caster_error_percent", "0..400",
      "percent of a texel that simplified casters may lie off; 0: always the finest level of detail"},
     UMB_FIELD(frame.caster_error_percent),
     {},
     0,
     400},
    {{"min_resolution", "4..8192, a power of two", "texels along a map's side at least; fixed cubes: from 16 on"},
     UMB_FIELD(frame.min_resolution),
     {},
     4,
     8192,
     true},
    {{"max_resolution", "4..8192, a power of two",
      "texels along a map's side at most; fixed cubes: up to 1024, the largest that fits the budget"},
     UMB_FIELD(frame.max_resolution),
     {},
     4,
     8192,
     true},
    {{"cascades", "none|redraw|cached|scrolled|scrolled_literal|guard_band",
      "directional lights: maps in the store, or cascades drawn anew, kept while the camera stands, scrolled "
      "(corrected, as printed), in a guard band"},
     UMB_FIELD(frame.cascades),
     kCascades},
    {{"cascade_count", "1..8", "cascades of a directional light"}, UMB_FIELD(frame.cascade_count), {}, 1, 8},
    {{"cascade_resolution", "64..4096, a power of two", "texels along a cascade's side; three maps of 4 bytes a texel"},
     UMB_FIELD(frame.cascade_resolution),
     {},
     64,
     4096,
     true},
    {{"cascade_distance_m", "1..100000",
      "metres from the camera to the end of the last cascade; no shadows of directional lights beyond"},
     UMB_FIELD(frame.cascade_distance_m),
     {},
     1,
     100000},
    {{"cascade_log_percent", "0..100", "splits: 0 evenly spaced, 100 logarithmic"},
     UMB_FIELD(frame.cascade_log_percent),
     {},
     0,
     100},
    {{"cascade_reach_m", "0..100000",
      "metres of a cascade's depth range towards the light; more costs depth precision, less redraws what stands "
      "beyond"},
     UMB_FIELD(frame.cascade_reach_m),
     {},
     0,
     100000},
    {{"cascade_guard_texels", "8..1024, a power of two", "guard_band: texels on each side; more memory, fewer redraws"},
     UMB_FIELD(frame.cascade_guard_texels),
     {},
     8,
     1024,
     true},
    {{"cascade_blend_percent", "0..50", "percent of a cascade's depth in which it fades into the next"},
     UMB_FIELD(frame.cascade_blend_percent),
     {},
     0,
     50},
    {{"static_after_ms", "0..86400000", "milliseconds without motion after which a caster is static"},
     UMB_FIELD(frame.static_after_ms),
     {},
     0,
     86400000},
    {{"frames_in_flight", "1..4", "frames recorded before the first has retired"},
     UMB_FIELD(fixed.frames_in_flight),
     {},
     1,
     4},
    {{"budget_mib", "4..16384", "MiB of depth texels; tables are reported apart"},
     UMB_FIELD(fixed.budget_mib),
     {},
     4,
     16384},
    {{"batch_triangles", "32..1024",
      "triangles in a batch at most (O4); small ones cull better, large ones cost fewer tests"},
     UMB_FIELD(fixed.batch_triangles),
     {},
     32,
     1024},
    {{"max_cluster_light_pairs", "1024..67108864", "first size of the cluster/light lists; they grow with the frames"},
     UMB_FIELD(fixed.max_cluster_light_pairs),
     {},
     1024,
     1u << 26},
    {{"max_caster_pairs", "1024..1048576",
      "(batch, map) pairs drawn per round, 24 bytes each; fixed cubes: (batch, view), 152 bytes; memory against "
      "rounds"},
     UMB_FIELD(fixed.max_caster_pairs),
     {},
     1024,
     1u << 20},
});
#undef UMB_FIELD

const Field* find(std::string_view key) {
  for (const Field& field : kFields)
    if (field.info.key == key) return &field;
  return nullptr;
}

std::string list_of(auto&& range, auto&& name) {
  std::string text;
  for (const auto& entry : range) text.append(text.empty() ? "" : ", ").append(name(entry));
  return text;
}

bool draws_into(Writer writer, Store store) {
  switch (writer) {
    case Writer::automatic:
      return true;
    case Writer::traditional:
      return store == Store::fixed_cubes;
    case Writer::multi_draw:
      return store == Store::fixed_cubes || store == Store::physical_pool;
    case Writer::compute:
    case Writer::fragments:
      return store == Store::page_pool;
  }
  return false;
}

Settings fixed_cubes() {
  Settings settings;
  settings.fixed.store = Store::fixed_cubes;
  settings.frame.caster_culling = CasterCulling::light_volume;
  settings.frame.caster_error_percent = 0;
  return settings;
}

/// A variant of Olsson et al. 2014 as printed: exact layout, O2, histogram of log2 steps.
Settings paper(CasterCulling culling, ClusterBounds bounds, uint32_t maps_per_light = 4, uint32_t undersampling = 1) {
  Settings settings;
  settings.frame = {.cluster_bounds = bounds,
                    .layout = MapLayout::exact,
                    .resolution = ResolutionForm::paper,
                    .facing_away = FacingAway::kept,
                    .receiver_boxes = ReceiverBoxes::clusters,
                    .maps_per_light = maps_per_light,
                    .undersampling = undersampling,
                    .receiver_grid = 1,
                    .caster_culling = culling,
                    .caster_error_percent = 0,
                    .min_resolution = 4};
  return settings;
}

Settings stored(Store store) {
  Settings settings = paper(CasterCulling::projection_map_depth, ClusterBounds::explicit_bits);
  settings.fixed.store = store;
  return settings;
}

/// Cascades of directional lights beside the default for the others.
Settings cascaded(CascadeMode mode) {
  Settings settings;
  settings.frame.cascades = mode;
  return settings;
}

constexpr auto kCell = ClusterBounds::implicit_cell, kTight = ClusterBounds::explicit_bits;
constexpr auto kPmcd = CasterCulling::projection_map_depth;

const std::array<Preset, 23> kPresets{{
    {"default", "virtual maps in levels, texels that match pixels, culled on the receiver grid", Settings{}},
    {"fixed-cubes",
     "one cube map per light, one resolution for all that fits the budget, every face gets every batch in range",
     fixed_cubes()},
    {"naive", "the paper's baseline: matched resolution, every batch in the light's sphere to all six faces",
     paper(CasterCulling::light_volume, kCell)},
    {"CFM", "batches only to cube faces that they meet and that have receivers",
     paper(CasterCulling::view_mask, kCell)},
    {"PMC", "and only where batch and receivers share a tile of the projection map",
     paper(CasterCulling::projection_map, kCell)},
    {"PMC-EB", "PMC with explicit cluster bounds", paper(CasterCulling::projection_map, kTight)},
    {"PMCD", "PMC, and not behind the farthest receiver of the face", paper(kPmcd, kCell)},
    {"PMCD-EB", "the paper's best: PMCD with explicit cluster bounds, 4 maps per light", paper(kPmcd, kTight)},
    {"PMCD-EB-1SM", "PMCD-EB with one map per light", paper(kPmcd, kTight, 1)},
    {"PMCD-EB-2SM", "PMCD-EB with 2 maps per light", paper(kPmcd, kTight, 2)},
    {"PMCD-EB-4SM", "PMCD-EB under its full name: 4 maps per light", paper(kPmcd, kTight, 4)},
    {"PMCD-EB-8SM", "PMCD-EB with 8 maps per light", paper(kPmcd, kTight, 8)},
    {"PMCD-EB-16SM", "PMCD-EB with 16 maps per light", paper(kPmcd, kTight, 16)},
    {"u2", "PMCD-EB with every resolution halved", paper(kPmcd, kTight, 4, 2)},
    {"u4", "PMCD-EB with every resolution quartered", paper(kPmcd, kTight, 4, 4)},
    {"PMCD-EB-physical",
     "PMCD-EB in the paper's fallback: a fixed set of whole cube maps, the next free one of the closest size (O14)",
     stored(Store::physical_pool)},
    {"PMCD-EB-sparse",
     "PMCD-EB in hardware sparse images: only pages that lookups touch have memory, bound by the host (O13)",
     stored(Store::hardware_sparse)},
    {"cascades-redraw", "directional lights: 4 cascades of 512 x 512, everything drawn into them each frame",
     cascaded(CascadeMode::redraw)},
    {"cascades-cached", "cascades whose static casters are drawn again only when the camera has moved (C2)",
     cascaded(CascadeMode::cached)},
    {"cascades-scrolled",
     "cascades scrolled with the camera: static casters are drawn only where they come into view (C3)",
     cascaded(CascadeMode::scrolled)},
    {"cascades-scrolled-literal",
     "the same with the paper's sets as printed, which forget casters across the old border (E17, E18)",
     cascaded(CascadeMode::scrolled_literal)},
    {"cascades-guard-band", "larger cascades that are drawn anew when the camera leaves their guard band (C8)",
     cascaded(CascadeMode::guard_band)},
    {"default-u2", "default with every resolution halved",
     [] {
       Settings s;
       s.frame.undersampling = 2;
       return s;
     }()},
}};
}  // namespace

std::span<const Preset> presets() { return kPresets; }

Result<Settings> preset(std::string_view name) {
  for (const Preset& row : kPresets)
    if (row.name == name) return row.settings;
  return Error{ErrorCode::invalid_argument, "no preset \"" + std::string(name) + "\"; there are: " +
                                                list_of(kPresets, [](const Preset& p) { return p.name; })};
}

std::span<const SettingInfo> setting_infos() {
  static const auto infos = [] {
    std::array<SettingInfo, kFields.size()> out;
    for (size_t i = 0; i < out.size(); ++i) out[i] = kFields[i].info;
    return out;
  }();
  return infos;
}

Result<void> set_setting(Settings& settings, std::string_view key, std::string_view value) {
  const Field* field = find(key);
  if (!field)
    return Error{ErrorCode::invalid_argument, "no setting \"" + std::string(key) + "\"; there are: " +
                                                  list_of(kFields, [](const Field& f) { return f.info.key; })};
  const auto refused = [&] {
    return Error{ErrorCode::invalid_argument, std::string(key) + ": \"" + std::string(value) + "\" is not one of " +
                                                  std::string(field->info.values)};
  };
  uint32_t number = 0;
  bool known = false;
  if (field->choices.empty()) {
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    known = error == std::errc() && end == value.data() + value.size() && number >= field->min &&
            number <= field->max && (!field->power_of_two || std::has_single_bit(number));
  } else {
    for (const Choice& choice : field->choices)
      if (choice.name == value) number = choice.value, known = true;
  }
  if (!known) return refused();
  field->set(settings, number);
  return {};
}

std::string get_setting(const Settings& settings, std::string_view key) {
  const Field* field = find(key);
  assert(field && "get_setting: the key must be one of setting_infos()");
  if (!field) return {};
  const uint32_t value = field->get(settings);
  for (const Choice& choice : field->choices)
    if (choice.value == value) return std::string(choice.name);
  return std::to_string(value);
}

Result<void> validate(const Settings& settings) {
  for (const Field& field : kFields) {
    const uint32_t value = field.get(settings);
    const bool fits = field.choices.empty() ? value >= field.min && value <= field.max &&
                                                  (!field.power_of_two || std::has_single_bit(value))
                                            : value < field.choices.size();
    if (!fits)
      return Error{ErrorCode::invalid_argument, std::string(field.info.key) + ": " + std::to_string(value) +
                                                    " is not one of " + std::string(field.info.values)};
  }
  if (settings.frame.min_resolution > settings.frame.max_resolution)
    return Error{ErrorCode::invalid_argument, "min_resolution " + std::to_string(settings.frame.min_resolution) +
                                                  " is larger than max_resolution " +
                                                  std::to_string(settings.frame.max_resolution)};
  if (draws_into(settings.frame.writer, settings.fixed.store)) return {};
  std::string fitting;
  for (const Choice& choice : kWriter)
    if (draws_into(static_cast<Writer>(choice.value), settings.fixed.store))
      fitting.append(fitting.empty() ? "" : ", ").append(choice.name);
  return Error{ErrorCode::invalid_argument, "writer=" + get_setting(settings, "writer") + " does not draw into store=" +
                                                get_setting(settings, "store") + ", which needs " + fitting};
}

}  // namespace umbrage
