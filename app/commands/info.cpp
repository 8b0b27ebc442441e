// umbrage info.
#include "commands/info.hpp"

#include <string>

#include "commands/output.hpp"
#include "commands/progress.hpp"
#include "commands/stats_json.hpp"
#include "commands/vulkan_devices.hpp"
#include "layered/layered_recommendation.hpp"
#include "umbrage/settings.hpp"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRecommended = "umbrage-layered.json";

std::string needs_text(const PresetEntry& entry) {
  return entry.needs.empty() ? "the required features" : "the required features and " + entry.needs;
}

/// Of a device that umbrage does not look at further there are none.
PresetEntry preset_entry(const DeviceEntry& device, size_t index) {
  return index < device.presets.size() ? device.presets[index] : PresetEntry{.needs = {}, .reason = device.reason};
}

Json device_object(const DeviceEntry& device, size_t index) {
  Json checks = Json::array();
  for (const umbrage::RequirementCheck& check : device.checks)
    checks.push_back({{"name", check.name},
                      {"required", check.required},
                      {"supported", check.supported},
                      {"purpose", check.purpose}});
  Json modes = Json::array();
  for (size_t i = 0; i < umbrage::presets().size(); ++i) {
    const umbrage::Preset& preset = umbrage::presets()[i];
    const PresetEntry entry = preset_entry(device, i);
    Json mode{{"preset", preset.name},
              {"summary", preset.summary},
              {"needs", needs_text(entry)},
              {"runs", entry.reason.empty()}};
    if (!entry.reason.empty()) mode["reason"] = entry.reason;
    modes.push_back(std::move(mode));
  }
  Json object{{"index", index},          {"name", device.name}, {"type", device.type},
              {"driver", device.driver}, {"api", device.api},   {"supported", device.is_supported}};
  if (!device.is_supported) object["reason"] = device.reason;
  object["checks"] = std::move(checks);
  object["modes"] = std::move(modes);
  return object;
}

Json list_document(const DeviceList& list) {
  Json devices = Json::array();
  for (size_t i = 0; i < list.devices.size(); ++i) devices.push_back(device_object(list.devices[i], i));
  Json document;
  document["version"] = UMBRAGE_VERSION;
  document["validation_layer"] = list.has_validation_layer;
  document["devices"] = std::move(devices);
  return document;
}

std::string check_lines(const DeviceEntry& device, bool required) {
  std::string text;
  for (const umbrage::RequirementCheck& check : device.checks) {
    if (check.required != required) continue;
    text += std::string("    ") + (check.supported ? "yes  " : "no   ") + std::string(check.name) + ": " +
            std::string(check.purpose) + "\n";
  }
  return text;
}

std::string device_text(const DeviceEntry& device, size_t index) {
  std::string text = std::to_string(index) + ": " + device.name + " (" + device.type + "), Vulkan " + device.api;
  if (!device.driver.empty()) text += ", driver " + device.driver;
  text += "\n  runs umbrage: " + (device.is_supported ? std::string("yes") : "no, " + device.reason) + "\n";
  if (!device.checks.empty()) {
    text += "  required\n" + check_lines(device, true);
    text += "  optional, for modes that name it\n" + check_lines(device, false);
  }
  text += "  presets\n";
  for (size_t i = 0; i < umbrage::presets().size(); ++i) {
    const umbrage::Preset& preset = umbrage::presets()[i];
    const PresetEntry entry = preset_entry(device, i);
    text += std::string("    ") + (entry.reason.empty() ? "yes  " : "no   ") + std::string(preset.name) + ": " +
            std::string(preset.summary) + "; needs " + needs_text(entry) +
            (entry.reason.empty() ? "" : "; " + entry.reason) + "\n";
  }
  return text;
}

}  // namespace

void add_info_options(CLI::App& command, InfoOptions& options) {
  command.add_flag_callback(
      "--json", [&options] { options.format = InfoFormat::json; }, "As JSON");
  // As a flag it names the file itself.
  auto* recommend =
      command
          .add_option_function<std::string>(
              "--recommend",
              [&options](const std::string& name) { options.recommended = name.empty() ? kRecommended : name; },
              std::string("Measure briefly which layered writer is fastest for what, and write it; ") + kRecommended)
          ->type_name("[FILE.json]")
          ->expected(0, 1);
  command.add_option("--device", options.device, "Which GPU to measure: an index of the list, or part of a name")
      ->type_name("NAME-OR-INDEX")
      ->needs(recommend);
}

umbrage::Result<void> run_info(const InfoOptions& options, Outputs& outputs) {
  if (!options.recommended.empty()) {
    if (const auto checked = check_target(options.recommended); !checked) return checked;
    Progress progress;
    const auto found =
        recommend_writers(options.device, [&](const std::string& step) { progress.show("measuring " + step); });
    if (!found) return found.error();
    progress.clear();
    return write_text(outputs, options.recommended, to_text(*found));
  }
  const auto list = list_devices();
  if (!list) return list.error();
  std::string text;
  if (options.format == InfoFormat::json) {
    text = to_text(list_document(*list));
  } else {
    text = std::string("umbrage ") + UMBRAGE_VERSION + "; validation layers " +
           (list->has_validation_layer ? "installed" : "not installed (--validate needs them)") + "\n";
    for (size_t i = 0; i < list->devices.size(); ++i) text += device_text(list->devices[i], i);
  }
  return write_standard_output(text);
}

}  // namespace app
