// Which writer is fastest on a device, measured briefly and kept as a file.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "umbrage/layered_pass.hpp"

namespace app {

/// Measures every writer that the device runs, a few draws each, and says which is best for what. told (may be empty) hears of
/// each step.
umbrage::Result<nlohmann::ordered_json> recommend_writers(const std::string& device,
                                                          const std::function<void(const std::string&)>& told);

/// The writer for depth or for colour passes that a document of recommend_writers names. Errors: not such a document.
umbrage::Result<std::string> recommended_writer(const nlohmann::json& document, const std::string& file,
                                                bool has_color);

}  // namespace app
