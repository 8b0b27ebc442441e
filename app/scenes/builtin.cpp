// The table of built-in scenes.
#include "scenes/builtin.hpp"

#include <array>
#include <string>

#include "scenes/landscape.hpp"
#include "scenes/town.hpp"

namespace app {
namespace {

struct Entry {
  BuiltinInfo info;
  Scene (*make)(Detail);
  Detail detail;
};

constexpr std::array entries{
    Entry{{"houses", "A small town at dusk: 1.0 M triangles, 256 lamps (HOUSES of Olsson et al. 2014)"},
          make_town,
          Detail::full},
    Entry{{"houses-lod", "The same town, lamps and cameras with low-polygon models"}, make_town, Detail::low},
    Entry{{"landscape", "A valley at dusk with a town by a lake: 1.5 M triangles, a low sun and 200 lamps"},
          make_landscape,
          Detail::full},
    Entry{
        {"landscape-lod", "The same valley, lights and cameras with low-polygon models"}, make_landscape, Detail::low},
};

constexpr auto infos = [] {
  std::array<BuiltinInfo, entries.size()> result{};
  for (size_t i = 0; i < entries.size(); ++i) result[i] = entries[i].info;
  return result;
}();

}  // namespace

std::span<const BuiltinInfo> builtin_scenes() { return infos; }

umbrage::Result<Scene> builtin_scene(std::string_view name) {
  for (const Entry& entry : entries) {
    if (entry.info.name != name) continue;
    Scene scene = entry.make(entry.detail);
    scene.name = name;
    return scene;
  }
  std::string message = "there is no built-in scene \"";
  message.append(name).append("\"; choose from ");
  for (const BuiltinInfo& info : infos) message.append(&info == &infos.front() ? "" : ", ").append(info.name);
  return umbrage::Error{umbrage::ErrorCode::invalid_argument, message};
}

}  // namespace app
