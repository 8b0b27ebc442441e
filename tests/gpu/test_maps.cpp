// Virtual shadow maps against the reference: what every cluster/light pair asks for, which maps the lights get, which pages,
// tiles and depths are marked, and where the pages lie.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "map_rig.hpp"
#include "pair_rig.hpp"
#include "reference/clusters.hpp"
#include "reference/maps.hpp"
#include "sun_check.hpp"

namespace umbrage::test {
namespace {

class Maps : public GpuTest {};

static_assert(reference::page_side == shared::PageSide && reference::projection_side == shared::ProjectionSide);

reference::Box reference_box(const shared::Box& box) {
  reference::Box out;
  out.min = box.lo, out.max = box.hi;
  return out;
}

glm::mat4 matrix(const Mat4& m) {
  glm::mat4 out;
  std::memcpy(&out, m.m, sizeof out);
  return out;
}

reference::MapCamera plain_camera(const CameraDesc& desc) {
  return {.view_from_world = glm::dmat4(matrix(desc.view_from_world)),
          .clip_from_view = glm::dmat4(matrix(desc.clip_from_view)),
          .width = double(desc.width),
          .height = double(desc.height)};
}

reference::ClusterGrid plain_grid(const CameraDesc& desc, const shared::CameraRecord& camera) {
  return {.width = desc.width,
          .height = desc.height,
          .tile = shared::TileSide,
          .slices = camera.slice_count,
          .near = camera.slice_origin,
          .ratio = std::exp2(1 / camera.slice_scale),
          .view_from_world = matrix(desc.view_from_world),
          .clip_from_view = matrix(desc.clip_from_view)};
}

reference::MapLight plain_light(const shared::LightRecord& light, const shared::ShadowView& view) {
  static_assert(uint32_t(reference::MapKind::cube) == shared::ViewsCube &&
                uint32_t(reference::MapKind::spot) == shared::ViewsSpot &&
                uint32_t(reference::MapKind::sun) == shared::ViewsOrtho);
  reference::MapLight out{.kind = static_cast<reference::MapKind>(light.views),
                          .position = light.position_ws,
                          .direction = light.direction_ws,
                          .near_m = light.near_m,
                          .side_m = view.side_m,
                          .max_resolution = double(light.resolution)};
  // The cone and a guard of three texels of the coarsest whole page on either side.
  if (light.views == shared::ViewsSpot) out.tangent = std::tan(double(light.outer_cone_rad)) * 64 / (64 - 6);
  return out;
}

reference::MapRules plain_rules(const FrameSettings& settings) {
  reference::MapRules rules{.exact = settings.layout == MapLayout::exact,
                            .paper = settings.resolution == ResolutionForm::paper,
                            .logarithmic = settings.buckets == HistogramBuckets::logarithmic,
                            .maps_per_light = settings.maps_per_light,
                            .undersampling = double(settings.undersampling),
                            .least = double(settings.min_resolution),
                            .most = double(settings.max_resolution)};
  if (!rules.exact) rules.least = std::max(rules.least, std::min(double(settings.merge_below), rules.most));
  return rules;
}

/// A frame and what it was asked to do.
struct Check {
  const SeenScene& scene;
  const FrameSettings& settings;
  const DeviceMaps& maps;
  const Pairs& pairs;
  const SunCheck& suns;
  reference::MapRules rules = plain_rules(settings);

  const shared::LightRecord& light_of_pair(uint32_t pair) const { return maps.light_records[maps.lights[pair]]; }
  reference::MapLight plain_light_of(const shared::LightRecord& light) const {
    return plain_light(light, maps.views[light.first_view]);
  }
  /// Are the light's maps windows of levels?
  bool has_levels(const shared::LightRecord& light) const { return !rules.exact && light.views == shared::ViewsOrtho; }
};

struct Request {
  double resolution = 0;
  bool dropped = false, close_call = false;
};

Request expected_request(const Check& check, uint32_t pair) {
  const uint32_t cluster = check.maps.pair_clusters[pair], cell = check.maps.cells[cluster],
                 tile = cell / shared::MaxSlices;
  const shared::CameraRecord& record = check.maps.record.camera;
  const reference::MapLight light = check.plain_light_of(check.light_of_pair(pair));
  const reference::MapCamera camera = plain_camera(check.scene.camera);
  const reference::ClusterGrid grid = plain_grid(check.scene.camera, record);
  const reference::Box box = reference_box(check.maps.boxes[cluster]);
  const glm::vec4 cone = check.maps.cones[cluster];
  const double away = reference::facing_away_rad(light, reference::sphere_around(box), glm::dvec3(cone), cone.w) - 1e-3;
  const bool tight = check.settings.cluster_bounds == ClusterBounds::explicit_bits;
  const auto corners =
      reference::cell_corners(grid, {tile % record.tiles.x, tile / record.tiles.x, cell % shared::MaxSlices});
  const reference::Sphere sphere = tight ? reference::sphere_around(box) : reference::sphere_around(corners);
  const double pixel_m = reference::nearest_pixel_m(
      camera, box, double(grid.near) * std::pow(double(grid.ratio), cell % shared::MaxSlices));
  const double distance = glm::distance(sphere.center, light.position);
  Request request;
  request.resolution = reference::requested_resolution(
      light, check.rules, tight ? reference::covered_pixels(camera, box) : camera.tile_pixels, sphere, box, pixel_m);
  if (check.has_levels(check.light_of_pair(pair)))
    request.resolution = check.suns.plane(check.light_of_pair(pair)).request(pixel_m) / check.rules.undersampling;
  request.dropped = check.settings.facing_away == FacingAway::dropped && away > 0;
  request.close_call =
      std::abs(away) < 1e-3 || (light.kind != reference::MapKind::sun && std::abs(distance / sphere.radius - 1) < 1e-3);
  return request;
}

void expect_requests(const Check& check) {
  size_t close_calls = 0;
  for (uint32_t pair = 0; pair < check.maps.pair_requests.size(); ++pair) {
    const double asked = check.maps.pair_requests[pair];
    if (check.light_of_pair(pair).view_count == 0) {
      ASSERT_EQ(asked, 0) << "a light that casts no shadow";
      continue;
    }
    const Request expected = expected_request(check, pair);
    if (expected.close_call) {
      ++close_calls;
      continue;
    }
    ASSERT_EQ(asked == 0, expected.dropped) << "pair " << pair;
    if (asked > 0) { ASSERT_NEAR(asked, expected.resolution, 1e-3 * expected.resolution) << "pair " << pair; }
  }
  EXPECT_LE(close_calls, check.maps.pair_requests.size() / 50 + 2);
}

/// Requests so close to the border of two levels or buckets that rounding decides.
bool is_close_call(const std::vector<double>& requests, const reference::MapRules& rules) {
  if (requests.empty()) return false;
  const double finest = *std::max_element(requests.begin(), requests.end());
  return std::any_of(requests.begin(), requests.end(), [&](double request) {
    return reference::place_of_request(request * (1 - 1e-5), finest, rules) !=
           reference::place_of_request(std::min(request * (1 + 1e-5), finest), finest, rules);
  });
}

/// A light's maps, finest first, and which of them each of its pairs has, are those of the reference. False: rounding decides.
bool expect_maps_of_light(const Check& check, uint32_t slot, const std::vector<uint32_t>& pairs) {
  const DeviceMaps& maps = check.maps;
  const shared::LightMaps& own = maps.light_maps[slot];
  std::vector<double> requests;
  for (const uint32_t pair : pairs) requests.push_back(maps.pair_requests[pair]);
  if (is_close_call(requests, check.rules)) return false;
  std::vector<uint32_t> resolutions;
  for (uint32_t i = 0; i < own.count; ++i) resolutions.push_back(maps.maps[own.first + i].resolution);
  const std::vector<uint32_t> expected = reference::map_resolutions(requests, check.rules);
  const std::set<uint32_t, std::greater<>> distinct(expected.begin(), expected.end());
  EXPECT_EQ(resolutions, std::vector<uint32_t>(distinct.begin(), distinct.end())) << "slot " << slot;
  for (size_t i = 0; i < expected.size(); ++i) {
    const uint32_t map = maps.pair_maps[pairs[i]];
    EXPECT_TRUE(map >= own.first && map < own.first + own.count) << "slot " << slot;
    EXPECT_EQ(maps.maps.at(map).resolution, expected[i]) << "slot " << slot << " asks for " << requests[i];
  }
  return true;
}

/// Maps lie one behind the other, by light, and so do their words and receivers.
void expect_order(const Check& check) {
  const DeviceMaps& maps = check.maps;
  uint32_t next = 0, words = 0, views = 0;
  for (uint32_t slot = 0; slot < maps.light_maps.size(); ++slot) {
    const shared::LightMaps& own = maps.light_maps[slot];
    const shared::LightRecord& light = maps.light_records[slot];
    ASSERT_TRUE(own.count == 0 || own.first == next);
    ASSERT_EQ(own.shift, 0u);
    ASSERT_EQ(own.whole, shared::NoIndex);
    for (uint32_t i = 0; i < own.count; ++i, ++next) {
      const shared::MapRecord& map = maps.maps[next];
      ASSERT_EQ(map.light, slot);
      ASSERT_EQ(map.first_word, words);
      ASSERT_EQ(map.first_receiver, views);
      const uint32_t view = map.first_view - light.first_view;
      ASSERT_TRUE(view == 0 || (check.has_levels(light) && view <= reference::sun_places));
      ASSERT_EQ(map.view_count, light.view_count);
      ASSERT_EQ(map.pages, (map.resolution + reference::page_side - 1) / reference::page_side);
      ASSERT_EQ(map.words, (map.pages * map.pages + 31) / 32);
      words += map.words * map.view_count, views += map.view_count;
    }
  }
  EXPECT_EQ(maps.counters.maps, next);
  EXPECT_EQ(maps.counters.page_words, words);
  EXPECT_EQ(maps.counters.receiver_views, views);
}

void expect_maps(const Check& check) {
  const DeviceMaps& maps = check.maps;
  std::vector<std::vector<uint32_t>> pairs(maps.light_maps.size());
  for (uint32_t pair = 0; pair < maps.pair_requests.size(); ++pair) {
    ASSERT_EQ(maps.pair_maps[pair] == shared::NoIndex, maps.pair_requests[pair] == 0) << "pair " << pair;
    if (maps.pair_requests[pair] > 0) pairs[maps.lights[pair]].push_back(pair);
  }
  expect_order(check);
  size_t close_calls = 0;
  for (uint32_t slot = 0; slot < maps.light_maps.size(); ++slot)
    close_calls +=
        !(check.has_levels(maps.light_records[slot]) ? check.suns.expect_maps(slot, pairs[slot], check.settings)
                                                     : expect_maps_of_light(check, slot, pairs[slot]));
  EXPECT_LE(close_calls, maps.light_maps.size() / 10 + 1);
}

/// What the device marked in one view of a map, nothing of which the reference finds beyond reach, and all that is certainly
/// within; returns its pages.
size_t expect_view_marks(const DeviceMaps& maps, const shared::MapRecord& map, uint32_t face,
                         const reference::ViewMarks& least, const reference::ViewMarks& most) {
  SCOPED_TRACE("light " + std::to_string(map.light) + ", " + std::to_string(map.resolution) + " texels, view " +
               std::to_string(face));
  const uint32_t grid = maps.record.receiver_grid, receiver = map.first_receiver + face;
  const bool seen = (map.faces >> face & 1) != 0;
  EXPECT_TRUE(seen ? most.seen : !least.seen);
  size_t marked = 0, missing = 0, needless = 0;
  for (uint32_t i = 0; i < map.pages * map.pages; ++i) {
    const bool bit = (maps.page_bits[map.first_word + face * map.words + i / 32] >> i % 32 & 1) != 0;
    marked += bit, missing += least.page[i] && !bit, needless += bit && !most.page[i];
  }
  EXPECT_EQ(missing, 0u) << "pages";
  EXPECT_EQ(needless, 0u) << "pages";
  for (uint32_t y = 0; y < shared::ProjectionSide; ++y) {
    const uint32_t row = maps.projection[receiver * shared::ProjectionSide + y];
    EXPECT_EQ(row & ~most.tiles[y], 0u) << "row " << y;
    EXPECT_EQ(least.tiles[y] & ~row, 0u) << "row " << y;
  }
  for (uint32_t i = 0; i < grid * grid; ++i) {
    const double depth = maps.receiver_depth[receiver * grid * grid + i];
    EXPECT_LE(depth, most.farthest[i] * (1 + 1e-5) + 1e-6) << "cell " << i;
    EXPECT_GE(depth, least.farthest[i] * (1 - 1e-5) - 1e-6) << "cell " << i;
  }
  return marked;
}

shared::Box shared_box(const reference::Box& box, float grow) { return {box.min - grow, box.max + grow}; }

/// Of every cluster its samples in blocks of 4×4 pixels.
std::vector<std::vector<reference::ReceiverBlock>> blocks_of_clusters(const Check& check) {
  constexpr uint32_t kSide = 4;
  const Receivers& seen = check.scene.seen;
  std::map<std::pair<uint32_t, uint32_t>, reference::ReceiverBlock> blocks;  // by cluster and block
  for (uint32_t i = 0; i < seen.width * seen.height; ++i) {
    const uint32_t cluster = check.pairs.clusters[i], x = i % seen.width, y = i / seen.width;
    if (cluster == shared::NoIndex) continue;
    reference::ReceiverBlock& block = blocks[{cluster, y / kSide << 16 | x / kSide}];
    block.positions.grow(seen.positions[i]);
    const glm::vec3 normal(seen.normals[i]);
    const bool is_one = check.scene.camera.normal_encoding != NormalEncoding::none && glm::dot(normal, normal) > 0.25f;
    block.normals.grow(is_one ? normal - 0.01f : glm::vec3(-1.01f));
    block.normals.grow(is_one ? normal + 0.01f : glm::vec3(1.01f));
  }
  std::vector<std::vector<reference::ReceiverBlock>> all(check.maps.boxes.size());
  for (const auto& [place, block] : blocks) all[place.first].push_back(block);
  return all;
}

/// What receivers of some clusters certainly mark in a view, and what they may mark.
struct ExpectedMarks {
  reference::ViewMarks least, most;
};

struct MarkedView {
  const shared::MapRecord& map;
  const shared::LightRecord& record;
  const reference::MapLight light;
  const shared::ShadowView& view;
  const reference::CasterView plain;
  /// Of coordinates as large as a box's, in parts.
  float rounding_m(const reference::Box& box, float part) const {
    const glm::vec3 largest = glm::max(glm::max(glm::abs(box.min), glm::abs(box.max)), glm::abs(view.origin));
    return part * std::max({largest.x, largest.y, largest.z});
  }
  void mark(const reference::Box& box, double least_m, double most_m, ExpectedMarks& marks) const {
    if (least_m < 0) reference::mark_receivers(plain, light, map.resolution, box, -1e-5, least_m, marks.least);
    reference::mark_receivers(plain, light, map.resolution, box, 1e-5, most_m, marks.most);
  }
  void mark(const reference::ReceiverBlock& block, bool drops_facing_away, ExpectedMarks& marks) const {
    const float rounding = rounding_m(block.positions, 2e-5f);
    const double facing = drops_facing_away ? reference::largest_facing(light, block) : 1,
                 margin = drops_facing_away ? 4 * rounding + 1e-4 : 0;
    if (facing < -margin || !shared::light_meets_box(record, shared_box(block.positions, rounding))) return;
    const bool certain = facing > margin && shared::light_meets_box(record, shared_box(block.positions, -rounding));
    mark(block.positions, certain ? -double(rounding) : 0, double(rounding), marks);
  }
};

void expect_marks(const Check& check) {
  const DeviceMaps& maps = check.maps;
  const bool in_blocks = check.settings.receiver_boxes != ReceiverBoxes::clusters;
  const auto blocks = in_blocks ? blocks_of_clusters(check) : std::vector<std::vector<reference::ReceiverBlock>>();
  std::vector<std::vector<uint32_t>> clusters_of_map(maps.maps.size());
  for (uint32_t pair = 0; pair < maps.pair_maps.size(); ++pair)
    if (maps.pair_maps[pair] != shared::NoIndex)
      clusters_of_map[maps.pair_maps[pair]].push_back(maps.pair_clusters[pair]);
  size_t marked = 0;
  for (uint32_t m = 0; m < maps.maps.size(); ++m) {
    const shared::MapRecord& map = maps.maps[m];
    const reference::MapLight light = plain_light(maps.light_records[map.light], maps.views[map.first_view]);
    for (uint32_t face = 0; face < map.view_count; ++face) {
      const shared::ShadowView& view = maps.views[map.first_view + face];
      const MarkedView marked_view{map, maps.light_records[map.light], light, view, plain_view(view, map.kind, face)};
      ExpectedMarks marks{reference::no_marks(map.resolution, maps.record.receiver_grid), {}};
      marks.most = marks.least;
      for (const uint32_t cluster : clusters_of_map[m]) {
        const reference::Box box = reference_box(maps.boxes[cluster]);
        const double rounding_m = marked_view.rounding_m(box, 2e-6f);
        if (!in_blocks) marked_view.mark(box, -rounding_m, rounding_m, marks);
        for (const reference::ReceiverBlock& block :
             in_blocks ? blocks[cluster] : std::vector<reference::ReceiverBlock>())
          marked_view.mark(block, check.settings.facing_away == FacingAway::dropped, marks);
      }
      marked += expect_view_marks(maps, map, face, marks.least, marks.most);
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_EQ(maps.counters.pages, marked);
}

/// Every page has a place of its own in the pool, one behind the other.
void expect_pages_apart(const Check& check, SystemRig& rig) {
  const DeviceMaps& maps = check.maps;
  uint64_t next = 0;
  for (const shared::MapRecord& map : maps.maps) {
    const uint32_t side = std::min(map.resolution, reference::page_side), units = side * side / shared::PoolUnit;
    for (uint32_t word = map.first_word; word < map.first_word + map.words * map.view_count; ++word) {
      ASSERT_EQ(maps.page_first[word], next) << "word " << word;
      next += uint64_t(std::popcount(maps.page_bits[word])) * units;
    }
  }
  EXPECT_EQ(maps.counters.pool_units, next);
  EXPECT_EQ(maps.counters.pool_units_asked, next);
  EXPECT_LE(next * shared::PoolUnit * sizeof(uint32_t), rig.stages().pool.pool().size());
  EXPECT_LE(rig.stages().pool.pool().size(), uint64_t(rig.state().settings.budget_mib) << 20);
}

void check_frame(PairRig& rig, const SeenScene& scene, const FrameSettings& settings) {
  SCOPED_TRACE(scene.name);
  const Pairs pairs = rig.settle(settings);
  const DeviceMaps maps(rig);
  const SunCheck suns(maps, CasterTables(rig).all);
  const Check check{scene, settings, maps, pairs, suns};
  expect_requests(check);
  expect_maps(check);
  expect_marks(check);
  expect_pages_apart(check, rig);
}

TEST_F(Maps, AreTheReferencesWithEverySetting) {
  const SeenScene scene = balls_scene(20, 40, 11);
  PairRig rig(gpu(), {}, scene);
  using Layout = MapLayout;
  const FrameSettings all[] = {
      {.max_resolution = 2048},
      {.facing_away = FacingAway::kept, .receiver_boxes = ReceiverBoxes::clusters, .max_resolution = 2048},
      {.facing_away = FacingAway::kept,
       .maps_per_light = 2,
       .receiver_grid = 8,
       .merge_below = 4,
       .max_resolution = 1024},
      {.cluster_bounds = ClusterBounds::implicit_cell,
       .receiver_boxes = ReceiverBoxes::clusters,
       .maps_per_light = 1,
       .receiver_grid = 1,
       .min_resolution = 64,
       .max_resolution = 512},
      {.resolution = ResolutionForm::paper,
       .maps_per_light = 16,
       .undersampling = 4,
       .merge_below = 4,
       .min_resolution = 4},
      {.layout = Layout::exact, .resolution = ResolutionForm::paper, .maps_per_light = 1, .max_resolution = 1024},
      {.cluster_bounds = ClusterBounds::implicit_cell,
       .layout = Layout::exact,
       .resolution = ResolutionForm::paper,
       .maps_per_light = 16,
       .receiver_grid = 1},
      {.layout = Layout::exact,
       .maps_per_light = 4,
       .undersampling = 2,
       .receiver_grid = 16,
       .min_resolution = 4,
       .max_resolution = 2048},
      {.layout = Layout::exact, .buckets = HistogramBuckets::linear, .maps_per_light = 8, .max_resolution = 1024}};
  for (size_t i = 0; i < std::size(all); ++i) {
    SCOPED_TRACE("settings " + std::to_string(i));
    check_frame(rig, scene, all[i]);
    if (HasFailure()) return;
  }
}

TEST_F(Maps, AreTheReferencesInHardScenes) {
  const std::vector<SeenScene> scenes = hard_scenes();
  PairRig rig(gpu(), {}, scenes[0]);
  for (const SeenScene& scene : scenes) {
    if (&scene != &scenes[0]) rig.replace(scene);
    check_frame(rig, scene, {.max_resolution = 2048});
    check_frame(rig, scene,
                {.layout = MapLayout::exact,
                 .resolution = ResolutionForm::paper,
                 .receiver_boxes = ReceiverBoxes::clusters,
                 .maps_per_light = 4,
                 .receiver_grid = 8,
                 .max_resolution = 1024});
    if (HasFailure()) return;
  }
}

TEST_F(Maps, AreTheReferencesOfManyLights) {
  const SeenScene scene = balls_scene(20, 600, 12);
  PairRig rig(gpu(), {}, scene);
  check_frame(rig, scene, {.max_resolution = 512});
}

}  // namespace
}  // namespace umbrage::test
