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
  std::span<const Choice> choices;      // empty: a number
  uint32_t min = 0, max = 0;
  bool power_of_two = false;
};

constexpr std::array<Choice, 2> kBounds{{{"implicit_cell", 0}, {"explicit_bits", 1}}};
constexpr std::array<Choice, 2> kAssignment{{{"hierarchy", 0}, {"brute_force", 1}}};
constexpr std::array<Choice, 5> kCulling{{{"light_volume", 0}, {"view_mask", 1}, {"projection_map", 2}, {"projection_map_depth", 3}, {"receiver_grid", 4}}};
constexpr std::array<Choice, 2> kWriter{{{"traditional", 0}, {"multi_draw", 1}}};

#define UMB_FIELD(path)                                                                    \
  [](const Settings& s) { return static_cast<uint32_t>(s.path); },                         \
      [](Settings& s, uint32_t v) { s.path = static_cast<decltype(s.path)>(v); }

const std::array<Field, 11> kFields{{
    {{"cluster_bounds", "implicit_cell|explicit_bits", "bounds of a cluster: its cell, or tight ones from three 10-bit number lines (O9)"},
     UMB_FIELD(frame.cluster_bounds), kBounds},
    {{"light_assignment", "hierarchy|brute_force", "lights per cluster through the 32-way light tree, or every pair tested"},
     UMB_FIELD(frame.light_assignment), kAssignment},
    {{"caster_culling", "light_volume|view_mask|projection_map|projection_map_depth|receiver_grid",
      "batches in the light's volume to all its views, to those they meet, or only where and in front of what receives (virtual shadow maps)"},
     UMB_FIELD(frame.caster_culling), kCulling},
    {{"writer", "traditional|multi_draw", "a render pass per view, or one GPU-written multi-draw"}, UMB_FIELD(frame.writer), kWriter},
    {{"min_resolution", "16..1024, a power of two", "texels along a map's side at least; lights that do not fit have no map"},
     UMB_FIELD(frame.min_resolution), {}, 16, 1024, true},
    {{"max_resolution", "16..1024, a power of two", "texels along a map's side at most; fixed-cubes takes the largest that fits the budget"},
     UMB_FIELD(frame.max_resolution), {}, 16, 1024, true},
    {{"frames_in_flight", "1..4", "frames recorded before the first has retired"}, UMB_FIELD(fixed.frames_in_flight), {}, 1, 4},
    {{"budget_mib", "4..16384", "MiB of depth texels; tables are reported apart"}, UMB_FIELD(fixed.budget_mib), {}, 4, 16384},
    {{"batch_triangles", "32..1024", "triangles in a batch at most (O4); small ones cull better, large ones cost fewer tests"},
     UMB_FIELD(fixed.batch_triangles), {}, 32, 1024},
    {{"max_cluster_light_pairs", "1024..67108864", "first size of the cluster/light lists; they grow with the frames"},
     UMB_FIELD(fixed.max_cluster_light_pairs), {}, 1024, 1u << 26},
    {{"max_caster_pairs", "1024..1048576", "(batch, view) pairs drawn per round, 152 bytes each; memory against rounds"},
     UMB_FIELD(fixed.max_caster_pairs), {}, 1024, 1u << 20},
}};
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

Settings fixed_cubes() {
  Settings settings;
  settings.frame.caster_culling = CasterCulling::light_volume;
  return settings;
}

const std::array<Preset, 2> kPresets{{
    {"default", "the best form there is so far: fixed-cubes, batches only to the faces they meet", Settings{}},
    {"fixed-cubes", "one cube map per light, one resolution for all that fits the budget, every face gets every batch in range", fixed_cubes()},
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
    return Error{ErrorCode::invalid_argument, std::string(key) + ": \"" + std::string(value) + "\" is not one of " + std::string(field->info.values)};
  };
  uint32_t number = 0;
  bool known = false;
  if (field->choices.empty()) {
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    known = error == std::errc() && end == value.data() + value.size() && number >= field->min && number <= field->max &&
            (!field->power_of_two || std::has_single_bit(number));
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
    const bool fits = field.choices.empty() ? value >= field.min && value <= field.max && (!field.power_of_two || std::has_single_bit(value))
                                            : value < field.choices.size();
    if (!fits)
      return Error{ErrorCode::invalid_argument, std::string(field.info.key) + ": " + std::to_string(value) + " is not one of " + std::string(field.info.values)};
  }
  if (settings.frame.min_resolution > settings.frame.max_resolution)
    return Error{ErrorCode::invalid_argument, "min_resolution " + std::to_string(settings.frame.min_resolution) +
                                                  " is larger than max_resolution " + std::to_string(settings.frame.max_resolution)};
  return {};
}

}  // namespace umbrage
