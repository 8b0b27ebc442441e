// Which Settings a run has.
#include "commands/settings_choice.hpp"

#include "commands/json_file.hpp"
#include "commands/parse.hpp"

namespace app {
umbrage::Result<void> apply_assignment(const std::string& assignment, umbrage::Settings& settings) {
  const size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    return invalid("\"" + assignment + "\" is not KEY=VALUE, such as max_resolution=512");
  const std::string_view text = assignment;
  return umbrage::set_setting(settings, text.substr(0, equals), text.substr(equals + 1));
}

umbrage::Result<umbrage::Settings> choose_settings(const SettingsOptions& options) {
  auto settings = umbrage::preset(options.preset);
  if (!settings) return invalid("--preset: " + settings.error().message);
  if (!options.file.empty()) {
    const auto applied = apply_settings_file(options.file, *settings);
    if (!applied) return applied.error();
  }
  for (const std::string& assignment : options.assignments) {
    const auto applied = apply_assignment(assignment, *settings);
    if (!applied) return invalid("--set: " + applied.error().message);
  }
  if (options.budget_mib) {
    const auto set = umbrage::set_setting(*settings, "budget_mib", std::to_string(*options.budget_mib));
    if (!set) return invalid("--budget: " + set.error().message);
  }
  if (const auto valid = umbrage::validate(*settings); !valid) return valid.error();
  return settings;
}

umbrage::Result<void> apply_settings_file(const std::filesystem::path& path, umbrage::Settings& settings) {
  const auto document = read_json(path);
  if (!document) return document.error();
  const JsonPlace root(*document, path.string());
  if (!document->is_object()) return root.error("must be an object of settings");
  for (const auto& item : document->items()) {
    const JsonPlace place = *root.member(item.key());
    const bool is_usable = item.value().is_string() || item.value().is_number_unsigned() || item.value().is_boolean();
    if (!is_usable) return place.error("must be a string or a whole number ≥ 0");
    const std::string value = item.value().is_string() ? item.value().get<std::string>() : item.value().dump();
    const auto set = umbrage::set_setting(settings, item.key(), value);
    if (!set) return place.error("cannot be set: " + set.error().message);
  }
  return {};
}

nlohmann::ordered_json settings_document(const umbrage::Settings& settings) {
  nlohmann::ordered_json document = nlohmann::ordered_json::object();
  for (const umbrage::SettingInfo& info : umbrage::setting_infos()) {
    const std::string value = umbrage::get_setting(settings, info.key);
    const auto number = parse_count(value, 0, UINT64_MAX);
    if (number)
      document[std::string(info.key)] = *number;
    else
      document[std::string(info.key)] = value;
  }
  return document;
}

}  // namespace app
