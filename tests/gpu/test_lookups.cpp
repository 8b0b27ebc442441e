// What lookups read: every tap lies in what was marked, and neither culling, rounds, order nor repetition changes a bit of what
// they answer.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "map_rig.hpp"
#include "pair_rig.hpp"

namespace umbrage::test {
namespace {

class Lookups : public GpuTest {};
class Answers : public GpuTest {};

// --- Requested pages are marked -------------------------------------------------------------------------------------------

struct Tap {
  uint32_t view, x, y;
  double deepest;  // no tap there compares farther away
};

uint32_t texel(double s, uint32_t resolution) {
  return static_cast<uint32_t>(std::clamp(std::floor((s + 1) / 2 * resolution), 0.0, resolution - 1.0));
}

/// The views of a light, and how its nine taps find their texels.
struct TapViews {
  uint32_t kind, resolution;
  double tangent, side_m;
  glm::dvec3 origin;
  std::vector<reference::CasterView> views;

  TapViews(const shared::MapRecord& map, const std::vector<shared::ShadowView>& all)
      : kind(map.kind),
        resolution(map.resolution),
        tangent(all[map.first_view].tangent),
        side_m(all[map.first_view].side_m),
        origin(all[map.first_view].origin) {
    for (uint32_t v = 0; v < map.view_count; ++v) views.push_back(plain_view(all[map.first_view + v], map.kind, v));
  }
  static double at(const glm::dvec4& row, const glm::dvec3& p) { return glm::dot(row, glm::dvec4(p, 1)); }
  double axis_depth(uint32_t view, const glm::dvec3& p) const { return at(views[view].depth, p); }
  uint32_t deepest_view(const glm::dvec3& p) const {
    uint32_t best = 0;
    for (uint32_t v = 1; v < views.size(); ++v)
      if (axis_depth(v, p) > axis_depth(best, p)) best = v;
    return best;
  }
  std::vector<Tap> taps(const glm::dvec3& p, const glm::dvec3& normal) const;
};

std::vector<Tap> TapViews::taps(const glm::dvec3& p, const glm::dvec3& normal) const {
  const uint32_t own = deepest_view(p);
  const reference::CasterView& view = views[own];
  const double depth = axis_depth(own, p), scale = view.perspective ? depth : 1;
  const double s = at(view.x, p) / scale, t = at(view.y, p) / scale;
  std::vector<Tap> taps;
  if (!view.perspective && std::max(std::abs(s), std::abs(t)) > 1) return taps;  // beyond every caster
  const double texel_m = view.perspective ? 2 * tangent * depth / resolution : side_m / resolution;
  const double towards = view.perspective ? std::max(0.1 * glm::dot(normal, origin - p), 0.0) : texel_m;
  const glm::dvec3 moved = p + normal * std::min(0.5 * texel_m, towards);  // half a texel, at most a tenth of the way
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const double x = (std::floor((s + 1) / 2 * resolution) + dx + 0.5) / resolution * 2 - 1;
      const double y = (std::floor((t + 1) / 2 * resolution) + dy + 0.5) / resolution * 2 - 1;
      Tap tap{own, texel(x, resolution), texel(y, resolution), 0};
      if (kind == shared::ViewsCube && std::max(std::abs(x), std::abs(y)) > 1) {
        // Beyond the edge: the same direction, on the face that it meets.
        const glm::dvec3 direction = glm::dvec3(view.x) * x + glm::dvec3(view.y) * y + glm::dvec3(view.depth);
        tap.view = deepest_view(origin + direction);
        const reference::CasterView& other = views[tap.view];
        const double along = glm::dot(glm::dvec3(other.depth), direction);
        tap.x = texel(glm::dot(glm::dvec3(other.x), direction) / along, resolution);
        tap.y = texel(glm::dot(glm::dvec3(other.y), direction) / along, resolution);
      }
      // Eight texels behind the receiver.
      if (view.perspective)
        tap.deepest = axis_depth(tap.view, moved) * (1 + 8 * 2 * tangent / resolution);
      else
        tap.deepest = axis_depth(own, p) + 8 * texel_m * glm::length(glm::dvec3(view.depth));
      taps.push_back(tap);
    }
  }
  return taps;
}

struct MarkFaults {
  size_t taps = 0, maps = 0, pages = 0, tiles = 0, depths = 0;
  std::string first;
};

void check_tap(const DeviceMaps& maps, const shared::MapRecord& map, const Tap& tap, MarkFaults& faults) {
  ++faults.taps;
  const uint32_t page = tap.y / shared::PageSide * map.pages + tap.x / shared::PageSide,
                 receiver = map.first_receiver + tap.view, grid = maps.record.receiver_grid;
  const auto part = [&](uint32_t i, uint32_t parts) {
    return static_cast<uint32_t>((uint64_t(2 * i + 1) * parts) / (2 * map.resolution));
  };
  const bool has_page = (maps.page_bits[map.first_word + tap.view * map.words + page / 32] >> page % 32 & 1) != 0;
  const bool has_tile = (maps.projection[receiver * 32 + part(tap.y, 32)] >> part(tap.x, 32) & 1) != 0;
  const double known = maps.receiver_depth[receiver * grid * grid + part(tap.y, grid) * grid + part(tap.x, grid)];
  const bool has_depth = known * (1 + 1e-5) + 1e-6 >= tap.deepest;  // as culling allows for
  faults.pages += !has_page, faults.tiles += !has_tile, faults.depths += !has_depth;
  if (has_page && has_tile && has_depth) return;
  if (faults.first.empty())
    faults.first = "kind " + std::to_string(map.kind) + ", " + std::to_string(map.resolution) + " texels, view " +
                   std::to_string(tap.view) + ", texel " + std::to_string(tap.x) + ", " + std::to_string(tap.y) +
                   ", depth " + std::to_string(tap.deepest) + " over " + std::to_string(known);
}

/// All taps of every (pixel, light) that the host asked for.
MarkFaults check_taps(const DeviceMaps& maps, const SeenScene& scene, const Pairs& pairs) {
  MarkFaults faults;
  std::vector<std::unique_ptr<TapViews>> views(maps.maps.size());
  for (uint32_t pixel = 0; pixel < scene.seen.depth.size(); ++pixel) {
    const uint32_t cluster = pairs.clusters[pixel];
    if (cluster == shared::NoIndex) continue;
    for (uint32_t i = 0; i < maps.lists[cluster].count; ++i) {
      const uint32_t pair = maps.lists[cluster].first + i;
      const shared::LightRecord& light = maps.light_records[maps.lights[pair]];
      if (light.view_count == 0 || pairs.visibility[size_t(pixel) * pairs.lights + light.host_index] < 0) continue;
      const glm::dvec3 p = scene.seen.positions[pixel],
                       normal = glm::normalize(glm::dvec3(glm::vec3(scene.seen.normals[pixel])));
      const glm::dvec3 to_light = light.type == shared::LightDirectional
                                      ? -glm::dvec3(light.direction_ws)
                                      : glm::normalize(glm::dvec3(light.position_ws) - p);
      const uint32_t m = maps.pair_maps[pair];
      if (m == shared::NoIndex) {  // all normals face away, but for a milliradian
        faults.maps += glm::dot(normal, to_light) > 2e-3;
        continue;
      }
      if (!views[m]) views[m] = std::make_unique<TapViews>(maps.maps[m], maps.views);
      for (const Tap& tap : views[m]->taps(p, normal)) check_tap(maps, maps.maps[m], tap, faults);
    }
  }
  return faults;
}

void expect_marked(PairRig& rig, const SeenScene& scene, const FrameSettings& settings) {
  SCOPED_TRACE(scene.name);
  const Pairs pairs = rig.settle(settings);
  const DeviceMaps maps(rig);
  const MarkFaults faults = check_taps(maps, scene, pairs);
  EXPECT_EQ(faults.maps, 0u);
  EXPECT_EQ(faults.pages, 0u) << "of " << faults.taps << " taps; " << faults.first;
  EXPECT_EQ(faults.tiles, 0u) << "of " << faults.taps << " taps; " << faults.first;
  EXPECT_EQ(faults.depths, 0u) << "of " << faults.taps << " taps; " << faults.first;
  if (scene.scene.lights.size() > 1) { EXPECT_GT(faults.taps, 1000u); }
}

const FrameSettings kMarkSettings[] = {{},
                                       {.receiver_grid = 1, .max_resolution = 64},
                                       {.cluster_bounds = ClusterBounds::implicit_cell,
                                        .layout = MapLayout::exact,
                                        .resolution = ResolutionForm::paper,
                                        .maps_per_light = 4,
                                        .receiver_grid = 8},
                                       {.layout = MapLayout::exact, .undersampling = 4, .min_resolution = 4}};

TEST_F(Lookups, LieInWhatIsMarked) {
  const SeenScene scene = balls_scene(20, 60, 21, 160, 112);
  PairRig rig(gpu(), {}, scene);
  for (const FrameSettings& settings : kMarkSettings) expect_marked(rig, scene, settings);
}

TEST_F(Lookups, LieInWhatIsMarkedInHardScenes) {
  const std::vector<SeenScene> scenes = hard_scenes();
  PairRig rig(gpu(), {}, scenes[0]);
  for (const SeenScene& scene : scenes) {
    if (&scene != &scenes[0]) rig.replace(scene);
    for (const FrameSettings& settings : {kMarkSettings[0], kMarkSettings[2]}) expect_marked(rig, scene, settings);
  }
}

TEST_F(Lookups, LieInWhatIsMarkedWithManyLights) {
  const SeenScene scene = balls_scene(20, 600, 22, 64, 48);
  PairRig rig(gpu(), {}, scene);
  expect_marked(rig, scene, {});
}

// --- Equality classes -----------------------------------------------------------------------------------------------------

/// Both answers there are, or equality would say little.
void expect_shadows(const Pairs& pairs) {
  const auto dark = std::count(pairs.visibility.begin(), pairs.visibility.end(), 0.0f),
             lit = std::count(pairs.visibility.begin(), pairs.visibility.end(), 1.0f);
  EXPECT_GT(dark, static_cast<ptrdiff_t>(pairs.asked() / 20));
  EXPECT_GT(lit, static_cast<ptrdiff_t>(pairs.asked() / 20));
}

constexpr CasterCulling kCulling[] = {CasterCulling::light_volume, CasterCulling::view_mask,
                                      CasterCulling::projection_map, CasterCulling::projection_map_depth,
                                      CasterCulling::receiver_grid};

/// The same bits whatever culling drops, and the more it may drop the less it draws.
void expect_same_culled(PairRig& rig, const SeenScene& scene, const FrameSettings& settings) {
  SCOPED_TRACE(scene.name);
  FrameSettings now = settings;
  now.caster_culling = CasterCulling::light_volume;
  const Pairs all = rig.settle(now);
  uint64_t triangles = all.statistics.triangles_drawn;
  for (const CasterCulling culling : kCulling) {
    for (const uint32_t grid : {1u, 8u, 32u}) {
      if (culling < CasterCulling::receiver_grid && grid > 1)
        continue;  // one depth a view, however many cells it is made of
      now.caster_culling = culling;
      now.receiver_grid = grid;
      const Pairs culled = rig.settle(now);
      EXPECT_EQ(differences(all, culled), 0u) << "culling " << int(culling) << ", grid " << grid;
      EXPECT_LE(culled.statistics.triangles_drawn, triangles) << "culling " << int(culling) << ", grid " << grid;
      if (grid == 1) triangles = culled.statistics.triangles_drawn;
    }
  }
}

TEST_F(Answers, AreTheSameWhateverIsCulled) {
  const SeenScene scene = balls_scene(60, 40, 31);
  PairRig rig(gpu(), {}, scene);
  expect_shadows(rig.settle());
  expect_same_culled(rig, scene, {});
  expect_same_culled(rig, scene,
                     {.layout = MapLayout::exact, .resolution = ResolutionForm::paper, .maps_per_light = 4});
}

TEST_F(Answers, AreTheSameWhateverIsCulledInHardScenes) {
  const std::vector<SeenScene> scenes = hard_scenes();
  PairRig rig(gpu(), {}, scenes[0]);
  for (const SeenScene& scene : scenes) {
    if (&scene != &scenes[0]) rig.replace(scene);
    expect_same_culled(rig, scene, {.max_resolution = 1024});
  }
}

TEST_F(Answers, AreTheSameEachTimeAndInAnyNumberOfRounds) {
  const SeenScene scene = balls_scene(60, 40, 32);
  PairRig rig(gpu(), {}, scene);
  const Pairs first = rig.settle();
  EXPECT_EQ(differences(first, rig.evaluate()), 0u);
  EXPECT_EQ(differences(first, PairRig(gpu(), {}, scene).settle()), 0u);

  PairRig rounds(gpu(), {.max_caster_pairs = 1024}, scene);
  const FrameSettings unculled{.caster_culling = CasterCulling::light_volume};
  EXPECT_EQ(differences(first, rounds.evaluate(unculled)), 0u);
  EXPECT_GT(rounds.state().plan.caster_rounds, 2u);
  EXPECT_EQ(differences(first, rounds.settle()), 0u);
}

/// Of pages only the texels that taps read, or all of them.
void expect_same_texels(PairRig& rig, const SeenScene& scene, FrameSettings settings) {
  SCOPED_TRACE(scene.name);
  settings.receiver_boxes = ReceiverBoxes::blocks;
  const Pairs blocks = rig.settle(settings);
  settings.receiver_boxes = ReceiverBoxes::samples;
  const Pairs samples = rig.settle(settings);
  EXPECT_EQ(differences(blocks, samples), 0u);
  EXPECT_EQ(blocks.statistics.texels_allocated, samples.statistics.texels_allocated);
}

TEST_F(Answers, AreTheSameWhateverTexelsAreDrawn) {
  const SeenScene scene = balls_scene(60, 40, 31);
  PairRig rig(gpu(), {}, scene);
  expect_shadows(rig.settle());
  expect_same_texels(rig, scene, {});
  expect_same_texels(rig, scene, {.layout = MapLayout::exact, .undersampling = 2});
  for (const SeenScene& hard : hard_scenes()) {
    rig.replace(hard);
    expect_same_texels(rig, hard, {.max_resolution = 1024});
  }
}

/// The same scene, added in another order; lights keep their host_index.
SeenScene shuffled(const SeenScene& scene, uint32_t seed) {
  SeenScene out = scene;
  std::mt19937 engine(seed);
  std::shuffle(out.scene.lights.begin(), out.scene.lights.end(), engine);
  std::shuffle(out.scene.instances.begin(), out.scene.instances.end(), engine);
  return out;
}

TEST_F(Answers, AreTheSameInAnyOrderOfLightsAndCasters) {
  const SeenScene scene = balls_scene(60, 40, 33);
  const Pairs first = PairRig(gpu(), {}, scene).settle();
  for (const uint32_t seed : {1u, 2u})
    EXPECT_EQ(differences(first, PairRig(gpu(), {}, shuffled(scene, seed)).settle()), 0u);
}

}  // namespace
}  // namespace umbrage::test
