// Scenes that need no file: `builtin:NAME` on the command line. Each is generated, the same bytes every time.
#pragma once
#include <span>
#include <string_view>

#include "import/scene.hpp"
#include "umbrage/result.hpp"

namespace app {

struct BuiltinInfo {
  std::string_view name;     ///< As after `builtin:`.
  std::string_view summary;  ///< One line, for listings.
};

/// Every built-in scene, in the order of listings.
std::span<const BuiltinInfo> builtin_scenes();

/// Errors: invalid_argument for a name that builtin_scenes() does not list; the message lists them.
umbrage::Result<Scene> builtin_scene(std::string_view name);

}  // namespace app
