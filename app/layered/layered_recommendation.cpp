// Each use is a number of maps of a size; the ring is the scene, the writer with the least GPU time the answer.
#include "layered/layered_recommendation.hpp"

#include <array>

#include "layered/layered_cases.hpp"

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::LayeredWriter;
using umbrage::Result;

namespace {

struct MeasuredUse {
  const char* name;
  uint32_t maps, side;
  bool is_skinned;
  bool is_for_color;  ///< Chosen among the writers that draw colour; measured by depth, which is the writers' share.
};
constexpr std::array<MeasuredUse, 5> kUses{{{"cube_map", 6, 256, false, false},
                                            {"cascades", 4, 512, false, false},
                                            {"many_small_maps", 32, 64, false, false},
                                            {"skinned", 6, 256, true, false},
                                            {"color", 6, 256, false, true}}};

}  // namespace

Result<nlohmann::ordered_json> recommend_writers(const std::string& device,
                                                 const std::function<void(const std::string&)>& told) {
  auto bench = LayeredBench::create(device);
  if (!bench) return bench.error();
  nlohmann::ordered_json best_of = nlohmann::ordered_json::object(), measured = nlohmann::ordered_json::array();
  for (const MeasuredUse& use : kUses) {
    LayeredArrays arrays = skinned_ring();
    if (!use.is_skinned) {
      arrays.meshes[0].skin.clear();
      arrays.instances[0].bones = 0;
    }
    auto scene = arrays.create(bench->device());
    if (!scene) return scene.error();
    if (use.is_skinned)
      if (auto bent = bend_ring(*scene, 1); !bent) return bent.error();
    const auto views = views_of(arrays, use.maps);
    double best_ms = 0;
    for (const LayeredWriter writer : kLayeredWriters) {
      if (!can_run(writer, bench->device().enabled) || writer == LayeredWriter::atlas) continue;
      if (use.is_for_color && writer == LayeredWriter::compute) continue;
      if (told) told(std::string(use.name) + ", " + std::string(umbrage::name_of(writer)));
      const bool culls = writer == LayeredWriter::geometry_invocations || writer == LayeredWriter::geometry_loop ||
                         writer == LayeredWriter::mesh;
      const umbrage::LayeredPassSettings settings{
          .writer = writer,
          .vertices = use.is_skinned ? umbrage::LayeredVertices::skinned : umbrage::LayeredVertices::instanced,
          .selection = umbrage::CasterSelection::each_view,
          .cull_frustum = culls};
      const auto times = bench->measure(*scene, views, {settings, use.side, 2});
      if (!times) return times.error();
      measured.push_back({{"use", use.name},
                          {"writer", umbrage::name_of(writer)},
                          {"maps", use.maps},
                          {"side", use.side},
                          {"gpu_ms", times->gpu_ms}});
      if (best_ms > 0 && times->gpu_ms >= best_ms) continue;
      best_ms = times->gpu_ms;
      best_of[use.name] = umbrage::name_of(writer);
    }
  }
  return nlohmann::ordered_json{{"device", bench->device_name()},
                                {"driver", bench->driver()},
                                {"layered_writers", best_of},
                                {"measured", measured}};
}

Result<std::string> recommended_writer(const nlohmann::json& document, const std::string& file, bool has_color) {
  const char* use = has_color ? "color" : "cube_map";
  if (document.is_object() && document.contains("layered_writers") && document["layered_writers"].is_object()) {
    const auto& writers = document["layered_writers"];
    if (writers.contains(use) && writers[use].is_string()) {
      const std::string name = writers[use];
      for (const LayeredWriter writer : kLayeredWriters)
        if (umbrage::name_of(writer) == name) return name;
    }
  }
  return Error{ErrorCode::invalid_argument, file + " names no writer under layered_writers." + use +
                                                ": make it with umbrage info --recommend FILE.json"};
}

}  // namespace app
