#include "map_rig.hpp"

#include <cmath>

#include "culling/receivers.shared.h"

namespace umbrage::test {

namespace {

glm::dvec4 row(const glm::dvec3& direction, const glm::dvec3& origin, double offset = 0) {
  return {direction, offset - glm::dot(direction, origin)};
}

/// Rows of the cube map table of the Vulkan specification ("Cube Map Face Selection").
reference::CasterView cube_view(const glm::dvec3& origin, uint32_t face) {
  static constexpr double kRows[6][3][3] = {{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
                                            {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                            {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
  const auto at = [&](int i) { return row({kRows[face][i][0], kRows[face][i][1], kRows[face][i][2]}, origin); };
  return {.x = at(0), .y = at(1), .depth = at(2)};
}

uint32_t tile_of(double s) {
  return static_cast<uint32_t>(
      std::clamp(std::floor((s + 1) * 0.5 * shared::ProjectionSide), 0.0, shared::ProjectionSide - 1.0));
}

}  // namespace

reference::CasterView plain_view(const shared::ShadowView& view, uint32_t kind, uint32_t face) {
  if (kind == shared::ViewsCube) return cube_view(view.origin, face);
  const glm::dvec3 origin(view.origin);
  if (kind == shared::ViewsSpot)
    return {.x = row(view.x_row, origin), .y = row(view.y_row, origin), .depth = row(view.w_row, origin)};
  return {.x = row(view.x_row, origin, view.x_offset),
          .y = row(view.y_row, origin, view.y_offset),
          .depth = row(-glm::dvec3(view.z_row), origin, 1 - double(view.z_offset)),
          .perspective = false};
}

void MapTables::add(const shared::LightRecord& light, uint32_t slot, bool whole, const shared::Box& scene,
                    uint32_t resolution) {
  shared::MapRecord map{.light = slot,
                        .first_view = static_cast<uint32_t>(views.size()),
                        .view_count = light.view_count,
                        .kind = light.views,
                        .resolution = resolution,
                        .pages = 2,
                        .words = 1,
                        .first_word = 0,
                        .first_receiver = static_cast<uint32_t>(projection.size() / shared::ProjectionSide),
                        .faces = 0,
                        .receivers = whole ? shared::ReceiversAnywhere : shared::ReceiversInSight,
                        .light_mask = light.light_mask};
  reference::CasterMap plain_map{
      .views = {}, .receivers = {}, .whole = whole, .resolution = resolution, .near_m = light.near_m};
  for (uint32_t v = 0; v < light.view_count; ++v) {
    shared::ShadowView view;
    if (light.views == shared::ViewsOrtho)
      view = shared::ortho_view(light.direction_ws, scene.lo, scene.hi, resolution, shared::ViewGuardTexels);
    else if (light.views == shared::ViewsCube)
      view = shared::perspective_view(light.position_ws, light.near_m, shared::face_rotation(v), 1);
    else
      view = shared::perspective_view(light.position_ws, light.near_m, shared::view_rotation(light.direction_ws),
                                      shared::spot_tangent(light.outer_cone_rad, resolution, shared::ViewGuardTexels));
    view.light = slot;
    views.push_back(view);
    plain_map.views.push_back(plain_view(view, light.views, v));
    plain_map.receivers.push_back({.tiles = {}, .grid = grid, .farthest = std::vector<float>(grid * grid)});
  }
  // Of whole maps nothing may be read: they have no place among the receivers.
  if (!whole) {
    projection.resize(projection.size() + light.view_count * shared::ProjectionSide);
    receiver_depth.resize(receiver_depth.size() + light.view_count * grid * grid);
  } else {
    map.first_receiver = 0x3fffffff;
  }
  maps.push_back(map);
  plain.push_back(plain_map);
  receivers.emplace_back();
}

void MapTables::see(const glm::vec3& receiver) {
  shared::MapRecord& map = maps.back();
  reference::CasterMap& known = plain.back();
  for (uint32_t v = 0; v < map.view_count; ++v) {
    const reference::CasterView& view = known.views[v];
    const glm::dvec4 p(receiver, 1);
    const double depth = glm::dot(view.depth, p), scale = view.perspective ? depth : 1;
    const double s = glm::dot(view.x, p) / scale, t = glm::dot(view.y, p) / scale;
    if (!(depth > 0) || std::max(std::abs(s), std::abs(t)) > 1) continue;
    receivers.back().push_back(receiver);
    if (map.receivers == shared::ReceiversAnywhere) return;
    const uint32_t x = tile_of(s), y = tile_of(t),
                   cell = y * grid / shared::ProjectionSide * grid + x * grid / shared::ProjectionSide;
    reference::CasterReceivers& seen = known.receivers[v];
    seen.tiles[y] |= 1u << x;
    seen.farthest[cell] = std::max(seen.farthest[cell], std::nextafter(static_cast<float>(depth), INFINITY));
    map.faces |= 1u << v;
    const uint32_t place = map.first_receiver + v;
    projection[place * shared::ProjectionSide + y] = seen.tiles[y];
    receiver_depth[place * grid * grid + cell] = shared::floatBitsToUint(seen.farthest[cell]);
    return;  // one face; a receiver on an edge is the first one's
  }
}

uint64_t MapItems::pairs() const {
  uint64_t sum = 0;
  for (const auto& [item, faces] : views) sum += static_cast<uint64_t>(std::popcount(faces));
  return sum;
}

CasterTables::CasterTables(SystemRig& rig) {
  Gpu& gpu = rig.gpu();
  const scene::GpuScene& scene = rig.stages().scene;
  const uint32_t slots = scene.caster_slots();
  casters = gpu.download<shared::CasterRecord>(scene.caster_buffer(), slots);
  instances = gpu.download<shared::InstanceRecord>(scene.instance_buffer(),
                                                   scene.instance_buffer().size() / sizeof(shared::InstanceRecord));
  batches = gpu.download<shared::BatchRecord>(scene.batch_buffer(),
                                              scene.batch_buffer().size() / sizeof(shared::BatchRecord));
  const auto order = gpu.download<uint32_t>(scene.caster_tree().order(), slots);
  const auto leaves = gpu.download<shared::Box>(scene.caster_tree().leaves(), slots);
  boxes.resize(slots);
  all = {glm::vec3(1e30f), glm::vec3(-1e30f)};
  for (uint32_t i = 0; i < slots; ++i) {
    boxes[order[i]] = leaves[i];
    if (!shared::box_is_empty(leaves[i])) all = {glm::min(all.lo, leaves[i].lo), glm::max(all.hi, leaves[i].hi)};
  }
  if (shared::box_is_empty(all)) all = {glm::vec3(0), glm::vec3(1)};
}

namespace {

void check_round(const culling::MapCulling& culling, const CasterTables& tables, const MapTables& maps, Gpu& gpu,
                 MapItems& found) {
  const auto counts = gpu.download<shared::DrawCounts>(culling.draw_counts(), 1)[0];
  ASSERT_LE(counts.opaque + counts.masked, culling.capacity());
  for (const bool masked : {false, true}) {
    const VkDeviceSize offset = masked ? culling.capacity() * sizeof(shared::CasterItem) : 0;
    for (const shared::CasterItem& item :
         gpu.download<shared::CasterItem>(culling.items(), masked ? counts.masked : counts.opaque, offset)) {
      ASSERT_LT(item.caster, tables.casters.size());
      ASSERT_LT(item.map, maps.maps.size());
      ASSERT_NE(item.faces, 0u);
      ASSERT_EQ(item.faces >> maps.maps[item.map].view_count, 0u);
      const shared::BatchRecord& batch = tables.batches[tables.casters[item.caster].batch];
      ASSERT_EQ(batch.mask != shared::NoIndex, masked);
      ASSERT_TRUE(found.views.insert({{item.caster, item.map}, item.faces}).second)
          << "caster " << item.caster << ", map " << item.map << " twice";
      found.order.push_back(item);
      found.triangles += uint64_t(std::popcount(item.faces)) * batch.triangle_count;
    }
  }
}

}  // namespace

MapItems find_items(SystemRig& rig, culling::MapCulling& culling, const CasterTables& tables, const MapTables& maps,
                    const MapRounds& rounds) {
  Gpu& gpu = rig.gpu();
  const scene::GpuScene& scene = rig.stages().scene;
  // In the hazard log, buffers of the test must not have the names of the system's.
  while (gpu.memory().name_resource() < 1u << 20) continue;
  take(culling.prepare(gpu.factory(), rounds.mode));
  std::vector<gpu::Buffer> retired;
  const auto map_count = static_cast<uint32_t>(maps.maps.size());
  take(culling.reserve(gpu.device(), gpu.memory(), map_count + 1000, rounds.capacity, retired));
  const auto upload = [&](const auto& values) {
    return values.empty() ? gpu.upload(std::vector<uint32_t>(4)) : gpu.upload(values);
  };
  const gpu::Buffer views = upload(maps.views), records = upload(maps.maps), projection = upload(maps.projection),
                    depth = upload(maps.receiver_depth);
  const gpu::Buffer used = gpu.upload(std::vector<uint32_t>(scene.light_slots() + 1, shared::LightIsUsed));
  shared::FrameRecord record{};
  record.lights = scene.light_buffer().address(), record.views = views.address(), record.maps = records.address();
  record.projection = projection.address(), record.receiver_depth = depth.address(), record.receiver_grid = maps.grid;
  record.caster_error = rounds.caster_error;
  const gpu::Buffer frame = gpu.upload(std::vector<shared::FrameRecord>{record});
  shared::FrameCounters zero{};
  zero.map_groups[0] = zero.maps = map_count, zero.map_groups[1] = zero.map_groups[2] = 1;
  zero.pair_limit = rounds.rounds * rounds.capacity;
  const gpu::Buffer counters = gpu.upload(std::vector<shared::FrameCounters>{zero});
  const culling::MapCulling::Inputs in{.scene = scene,
                                       .frame = frame,
                                       .counters = counters,
                                       .views = views,
                                       .maps = records,
                                       .projection = projection,
                                       .receiver_depth = depth,
                                       .used_lights = used,
                                       .tree_shape = rig.stages().caster_shape(),
                                       .mode = rounds.mode};
  MapItems found;
  gpu::HazardLog log;
  for (uint32_t round = 0; round < rounds.rounds; ++round) {
    gpu.run([&](VkCommandBuffer commands) {
      gpu::Recorder recorder = gpu.recorder(commands, &log);
      if (round == 0) culling.record_count(recorder, in);
      culling.record_round(recorder, in, round);
    });
    check_round(culling, tables, maps, gpu, found);
  }
  for (const gpu::Hazard& hazard : gpu::find_hazards(log)) ADD_FAILURE() << hazard.text;
  found.counters = gpu.download<shared::FrameCounters>(counters, 1)[0];
  found.lights = gpu.download<uint32_t>(used, scene.light_slots());
  EXPECT_EQ(found.order.size(), std::min(found.counters.caster_pairs, zero.pair_limit));
  EXPECT_EQ(found.counters.batches_drawn_low, found.pairs());
  EXPECT_EQ(found.counters.triangles_drawn_low, found.triangles);
  return found;
}

}  // namespace umbrage::test
