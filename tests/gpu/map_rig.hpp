// Shadow maps made on the host for the casters of a SystemRig: records, receivers, and the items that the device finds for them.
#pragma once
#include <map>
#include <set>

#include "culling/map_culling.hpp"
#include "reference/map_casters.hpp"
#include "system_rig.hpp"

namespace umbrage::test {

/// A view in the reference's terms. kind: ViewsCube, … ; face: number of the view among its light's.
reference::CasterView plain_view(const shared::ShadowView&, uint32_t kind, uint32_t face);

/// The maps of a frame, for the device and for the reference.
struct MapTables {
  uint32_t grid = 1;
  std::vector<shared::MapRecord> maps;
  std::vector<shared::ShadowView> views;
  std::vector<uint32_t> projection, receiver_depth;
  std::vector<reference::CasterMap> plain;        // one a map
  std::vector<std::vector<glm::vec3>> receivers;  // of each map: points that some view sees

  explicit MapTables(uint32_t cells) : grid(cells) {}
  /// Views of a light, with nothing known of receivers.
  void add(const shared::LightRecord&, uint32_t slot, bool whole, const shared::Box& scene, uint32_t resolution = 256);
  /// A receiver of the last map; of no effect outside of its views.
  void see(const glm::vec3& receiver);
};

/// (caster, map) → views.
using ItemViews = std::map<std::pair<uint32_t, uint32_t>, uint32_t>;

struct MapItems {
  ItemViews views;
  std::vector<shared::CasterItem> order;  // round by round, opaque ones first
  shared::FrameCounters counters{};
  std::vector<uint32_t> lights;  // words
  uint64_t pairs() const;        // (batch, view)
  uint64_t triangles = 0;
};

/// The casters of a rig, read back.
struct CasterTables {
  std::vector<shared::CasterRecord> casters;
  std::vector<shared::Box> boxes;  // by caster
  std::vector<shared::InstanceRecord> instances;
  std::vector<shared::BatchRecord> batches;
  shared::Box all;
  explicit CasterTables(SystemRig&);
};

struct MapRounds {
  CasterCulling mode;
  uint32_t capacity = 1 << 18;
  uint32_t rounds = 1;
  float caster_error = 0;  // texels
};

/// Culls and checks what every list must fulfil: kinds kept apart, each pair once, faces in range, counters true.
MapItems find_items(SystemRig&, culling::MapCulling&, const CasterTables&, const MapTables&, const MapRounds&);

}  // namespace umbrage::test
