// Which Settings a run has: a preset's, changed by a settings file, then by --set, then by --budget.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "umbrage/settings.hpp"

namespace app {

struct SettingsOptions {
  std::string preset = "default";
  std::filesystem::path file;            ///< Empty: none.
  std::vector<std::string> assignments;  ///< "KEY=VALUE".
  std::optional<uint32_t> budget_mib;
};

umbrage::Result<umbrage::Settings> choose_settings(const SettingsOptions& options);

/// "KEY=VALUE". On error settings stay as they were.
umbrage::Result<void> apply_assignment(const std::string& assignment, umbrage::Settings& settings);
/// {"key": value, …}, as statistics hold it under "settings". Values are strings or whole numbers.
umbrage::Result<void> apply_settings_file(const std::filesystem::path& path, umbrage::Settings& settings);
/// The same object for settings.
nlohmann::ordered_json settings_document(const umbrage::Settings& settings);

}  // namespace app
