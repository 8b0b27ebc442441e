// A run's statistics and its last frame's trace as JSON. Scripts rely on the keys.
#pragma once
#include <nlohmann/json.hpp>

#include "commands/session.hpp"
#include "host/renderer.hpp"

namespace app {

nlohmann::ordered_json stats_document(Session& session);

/// Chrome's trace format, which Perfetto opens: the passes one after the other (starts are not measured, lengths are).
nlohmann::ordered_json trace_document(const FrameReport& report);

/// Indented, ends in a newline; text that is not UTF-8 is mended.
std::string to_text(const nlohmann::ordered_json& document);

}  // namespace app
