// Directional lights as levels of the page pool: texels that never move, whatever the camera does; answers as by rays under suns in
// any direction, from any camera.
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "map_rig.hpp"
#include "pair_rig.hpp"
#include "ray_answers.hpp"
#include "sun_check.hpp"

namespace umbrage::test {
namespace {

class Sun : public GpuTest {};

LightDesc sun(const glm::vec3& direction) { return {.type = LightType::directional, .direction = to_vec3(direction)}; }

/// Balls, boxes and masked cards, a few large squares, the ground; seen from an eye.
SeenScene sunlit_scene(const std::vector<LightDesc>& suns, const CameraDesc& camera, uint32_t instances = 24) {
  SeenScene out{.name = "suns",
                .scene = mixed_scene(instances, 0, 61),
                .camera = camera,
                .seen = picture(camera, balls_on_ground)};
  out.scene.meshes.push_back(plane_mesh(2));
  const uint32_t plane = static_cast<uint32_t>(out.scene.meshes.size() - 1);
  for (uint32_t i = 0; i < 3; ++i)
    out.scene.instances.push_back({.mesh = plane,
                                   .world_from_mesh = affine(glm::mat3(2, 0, 0, 0, 1, 0, 0.3f, 0.4f, 1),
                                                             {6.0f * float(i) - 6, 4, -3 + 2 * float(i)})});
  out.scene.instances.push_back({.mesh = plane, .world_from_mesh = affine(glm::mat3(40), {0, -0.2f, 0})});
  out.scene.lights = suns;
  for (uint32_t i = 0; i < suns.size(); ++i) out.scene.lights[i].host_index = i;
  return out;
}

CameraDesc camera_from(const glm::vec3& eye, const glm::vec3& target = {0, 1, 0}) {
  return perspective_camera(eye, target, 96, 64);
}

// --- Texels that do not move ------------------------------------------------------------------------------------------------

/// Sun, level, page counted from the world's origin.
using PageName = std::tuple<uint32_t, uint32_t, int, int>;
using Pages = std::map<PageName, std::vector<uint32_t>>;

/// The depths of every whole page of the suns.
Pages pages_of(PairRig& rig) {
  const DeviceMaps maps(rig);
  const SunCheck suns(maps, CasterTables(rig).all);
  const auto pool = rig.gpu().download<uint32_t>(rig.stages().pool.pool(), maps.counters.pool_units * shared::PoolUnit);
  Pages pages;
  for (const shared::MapRecord& map : maps.maps) {
    if (map.kind != shared::ViewsOrtho || map.resolution < 256) continue;
    const reference::PlaneWindow window = suns.window(map);
    for (uint32_t page = 0; page < map.pages * map.pages; ++page) {
      const uint32_t word = map.first_word + page / 32, bits = maps.page_bits[word];
      if ((bits >> page % 32 & 1) == 0) continue;
      const uint32_t first = shared::page_texel(bits, maps.page_first[word], page % 32, map.resolution);
      const int x = int(window.first.x) / int(shared::PageSide) + int(page % map.pages),
                y = int(window.first.y) / int(shared::PageSide) + int(page / map.pages);
      pages[{map.light, suns.place(map), x, y}] = {pool.begin() + first,
                                                   pool.begin() + first + shared::PageSide * shared::PageSide};
    }
  }
  return pages;
}

struct Kept {
  size_t pages = 0, texels = 0;
  size_t changed = 0;  // covered in one and not in the other, or of another depth
};

/// Texels that both have, and how many of them differ by more than so many units of their last place.
Kept compare_pages(const Pages& a, const Pages& b, uint32_t units) {
  Kept kept;
  for (const auto& [name, texels] : a) {
    const auto other = b.find(name);
    if (other == b.end()) continue;
    ++kept.pages;
    for (size_t i = 0; i < texels.size(); ++i) {
      kept.texels += texels[i] != 0;
      const uint32_t x = texels[i], y = other->second[i];
      kept.changed += (x == 0) != (y == 0) || std::max(x, y) - std::min(x, y) > units;
    }
  }
  return kept;
}

/// With all casters of a view drawn, so that pages hold the same whatever else the camera sees. The device's own rasteriser
/// interpolates depth from where its viewport begins: to the last few bits, but for some texel on a triangle's edge.
TEST_F(Sun, TexelsStayWhereTheyAreWhenTheCameraMoves) {
  const glm::vec3 eye(0, 5, 16), target(0, 1, 0);
  const std::vector<LightDesc> suns{sun({0.4f, -1, 0.3f}), sun({-0.9f, -0.35f, 0.1f})};
  for (const Writer writer : {Writer::compute, Writer::fragments}) {
    SCOPED_TRACE(writer == Writer::compute ? "compute" : "fragments");
    const FrameSettings settings{.receiver_boxes = ReceiverBoxes::blocks,
                                 .caster_culling = CasterCulling::view_mask,
                                 .writer = writer,
                                 .max_resolution = 2048};
    PairRig rig(gpu(), {}, sunlit_scene(suns, camera_from(eye, target)));
    rig.settle(settings);
    const Pages before = pages_of(rig);
    // A finest texel is some 4 cm here: 0.3 of it, whole ones, pages, out of the first windows.
    for (const glm::vec3& step : {glm::vec3(0.012f, 0, 0), glm::vec3(0.003f, 0.01f, -0.007f),
                                  glm::vec3(0.3f, 0.1f, 0.2f), glm::vec3(3, 1, -2), glm::vec3(-9, 0, -9)}) {
      const CameraDesc camera = camera_from(eye + step, target + step);
      rig.show(camera, picture(camera, balls_on_ground));
      rig.frame(settings);
      const Kept kept = compare_pages(before, pages_of(rig), writer == Writer::compute ? 0 : 8);
      EXPECT_LE(kept.changed, writer == Writer::compute ? 0 : kept.texels / 50000)
          << "of " << kept.texels << " texels on " << kept.pages << " pages";
      EXPECT_GT(kept.texels, 20000u);
    }
  }
}

// --- Suns and cameras of every kind -----------------------------------------------------------------------------------------

/// World size of a texel of the map that answers for each pixel.
std::vector<double> texels_of(const DeviceMaps& maps, const Pairs& pairs, uint32_t slot) {
  std::vector<double> out(pairs.clusters.size(), 0);
  for (size_t pixel = 0; pixel < out.size(); ++pixel) {
    const uint32_t cluster = pairs.clusters[pixel];
    if (cluster == shared::NoIndex) continue;
    for (uint32_t i = 0; i < maps.lists[cluster].count; ++i) {
      const uint32_t pair = maps.lists[cluster].first + i;
      if (maps.lights[pair] != slot || maps.pair_maps[pair] == shared::NoIndex) continue;
      const shared::MapRecord& map = maps.maps[maps.pair_maps[pair]];
      out[pixel] = double(maps.views[map.first_view].side_m) / map.resolution;
    }
  }
  return out;
}

struct Tally {
  size_t lit = 0, dark = 0, wrong = 0;
};

/// Every sun's answers against rays, where those are certain.
Tally check_answers(PairRig& rig, const SeenScene& scene, const FrameSettings& settings) {
  const Pairs pairs = rig.settle(settings);
  const DeviceMaps maps(rig);
  TestScene opaque = scene.scene;
  std::erase_if(opaque.instances, [&](const TestInstance& instance) { return !instance.casts; });
  const std::vector<Triangle> triangles = triangles_of(opaque);
  Tally tally;
  for (uint32_t light = 0; light < scene.scene.lights.size(); ++light) {
    const std::vector<double> texels = texels_of(maps, pairs, slot_of(rig.light_ids[light]));
    for (size_t pixel = 0; pixel < pairs.clusters.size(); pixel += 2) {
      const float visibility = pairs.visibility[pixel * pairs.lights + light];
      const glm::vec3 normal = glm::normalize(glm::vec3(scene.seen.normals[pixel]));
      if (visibility < 0 || texels[pixel] == 0 ||
          glm::dot(normal, -glm::normalize(to_glm(scene.scene.lights[light].direction))) < 0.2f)
        continue;
      const Answer answer = answer_of(triangles, scene.scene.lights[light], scene.seen.positions[pixel], texels[pixel]);
      if (answer == Answer::open) continue;
      (answer == Answer::lit ? tally.lit : tally.dark)++;
      tally.wrong += (visibility >= 0.5f) != (answer == Answer::lit);
    }
  }
  return tally;
}

/// Casters without masks, light masks or holes in them.
SeenScene plain_scene(const std::vector<LightDesc>& suns, const CameraDesc& camera) {
  SeenScene scene = sunlit_scene(suns, camera, 0);
  scene.scene.meshes[0] = sphere_mesh(6, 8);
  for (uint32_t i = 0; i < 9; ++i) {
    const glm::vec3 at(5.0f * float(i % 3) - 5, 2 + float(i % 2), 4.0f * float(i / 3) - 6);
    scene.scene.instances.push_back({.mesh = i % 2, .world_from_mesh = affine(glm::mat3(1 + 0.2f * float(i % 4)), at)});
  }
  return scene;
}

TEST_F(Sun, TurnsThroughThePole) {
  const CameraDesc camera = camera_from({0, 5, 16});
  const std::vector<glm::vec3> directions{{0, -1, 0},     {1e-7f, -1, 0},     {-1e-7f, -1, 1e-7f}, {3e-6f, -1, -2e-6f},
                                          {1e-4f, -1, 0}, {0.02f, -1, 0.03f}, {0.7f, -0.7f, 0},    {-0.99f, -0.15f, 0},
                                          {0, -0.2f, -1}, {1, 0, 0}};
  PairRig rig(gpu(), {}, plain_scene({sun(directions[0])}, camera));
  Tally all;
  for (const glm::vec3& direction : directions) {
    SCOPED_TRACE(std::to_string(direction.x) + ", " + std::to_string(direction.y) + ", " + std::to_string(direction.z));
    const SeenScene scene = plain_scene({sun(direction)}, camera);
    rig.replace(scene);
    const Tally tally = check_answers(rig, scene, {});
    EXPECT_EQ(tally.wrong, 0u) << "of " << tally.lit << " lit and " << tally.dark << " dark";
    all.lit += tally.lit, all.dark += tally.dark;
  }
  EXPECT_GT(all.lit, 600u);
  EXPECT_GT(all.dark, 150u);
}

TEST_F(Sun, ShinesOnWhatAnyCameraSees) {
  const std::vector<LightDesc> suns{sun({0.4f, -1, 0.3f}), sun({-0.9f, -0.5f, 0.1f}), sun({0, -1, 0}),
                                    sun({0.2f, -0.6f, -0.7f})};
  const struct {
    const char* name;
    CameraDesc camera;
  } cameras[] = {{"near", camera_from({0, 5, 16})},
                 {"on the ground", camera_from({2, 0.3f, 9}, {0, 0.2f, 0})},
                 {"far outside", camera_from({300, 250, 400})},
                 {"away from all casters", camera_from({500, 5, 500}, {600, 0, 600})},
                 {"from above", camera_from({0.1f, 60, 0})},
                 {"finite", finite_camera({0, 5, 16}, {0, 1, 0}, 96, 64, 200)},
                 {"orthographic", orthographic_camera({0, 5, 16}, {0, 1, 0}, 96, 64, 8, 50)}};
  PairRig rig(gpu(), {}, plain_scene(suns, cameras[0].camera));
  Tally all;
  for (const auto& [name, camera] : cameras) {
    SCOPED_TRACE(name);
    const SeenScene scene = plain_scene(suns, camera);
    rig.replace(scene);
    for (const FrameSettings& settings :
         {FrameSettings{}, FrameSettings{.levels_per_sun = 1}, FrameSettings{.levels_per_sun = 3, .max_resolution = 64},
          FrameSettings{.layout = MapLayout::exact}}) {
      const Tally tally = check_answers(rig, scene, settings);
      EXPECT_EQ(tally.wrong, 0u) << "of " << tally.lit << " lit and " << tally.dark << " dark";
      all.lit += tally.lit, all.dark += tally.dark;
    }
  }
  EXPECT_GT(all.lit, 5000u);
  EXPECT_GT(all.dark, 1500u);
}

TEST_F(Sun, ShinesOnEverythingWhereNothingCasts) {
  SeenScene scene = sunlit_scene({sun({0.4f, -1, 0.3f})}, camera_from({0, 5, 16}));
  scene.scene.instances.clear();
  PairRig rig(gpu(), {}, scene);
  const Pairs pairs = rig.settle();
  EXPECT_GT(pairs.asked(), 1000u);
  EXPECT_TRUE(std::all_of(pairs.visibility.begin(), pairs.visibility.end(), [](float v) { return v < 0 || v == 1; }));
}

/// A pool that is too small moves all suns to coarser levels, down to the last, and everything stays backed.
TEST_F(Sun, GetsCoarserLevelsWhereThePoolIsShort) {
  std::vector<LightDesc> suns;
  for (int i = 0; i < 12; ++i) suns.push_back(sun({std::cos(float(i)), -0.6f, std::sin(float(i))}));
  const CameraDesc camera = perspective_camera({0, 5, 16}, {0, 1, 0}, 320, 200);
  const SeenScene scene = sunlit_scene(suns, camera);
  uint64_t asked = 0;
  for (const uint32_t budget_mib : {256u, 4u}) {
    PairRig rig(gpu(), {.budget_mib = budget_mib}, scene);
    const Pairs answers = rig.settle();
    EXPECT_EQ(differences(answers, rig.evaluate()), 0u);
    const Statistics& statistics = rig.system().statistics();
    EXPECT_LE(statistics.texels_allocated * sizeof(uint32_t), uint64_t(budget_mib) << 20);
    EXPECT_EQ(statistics.unbacked_taps, 0u);
    if (asked == 0) asked = statistics.texels_allocated;
    EXPECT_EQ(statistics.texels_requested, asked);
    EXPECT_EQ(rig.system().degraded_lights().empty(), budget_mib == 256);
  }
}

}  // namespace
}  // namespace umbrage::test
