// The writers of the page pool against the reference: every texel of every page, in random and in spiteful scenes; the same bits
// whatever the order, the items and the room for large triangles.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "gpu/hazards.hpp"
#include "page_rig.hpp"
#include "raster/needed_triangles.hpp"

namespace umbrage::test {
namespace {

class PageRasterTest : public GpuTest {
 protected:
  static void SetUpTestSuite() {
    GpuTest::SetUpTestSuite();
    raster_ = std::make_unique<raster::PageRaster>(take(raster::PageRaster::create(gpu().factory())));
    fragments_ = std::make_unique<raster::PageFragments>(take(raster::PageFragments::create(gpu().factory())));
    take(fragments_->reserve(gpu().device(), gpu().memory()));
  }
  static void TearDownTestSuite() {
    raster_.reset();
    fragments_.reset();
    GpuTest::TearDownTestSuite();
  }
  std::vector<uint32_t> draw(PageRig& rig, uint32_t large_triangles) {
    std::vector<gpu::Buffer> retired;
    take(raster_->reserve(gpu().device(), gpu().memory(), large_triangles, rig.pool_bytes(), retired));
    return rig.draw([](gpu::Recorder& recorder, const raster::PageWriterInputs& in) { raster_->record(recorder, in); });
  }
  std::vector<uint32_t> draw_by_fragments(PageRig& rig) {
    const uint32_t side = rig.max_resolution();
    return rig.draw(
        [&](gpu::Recorder& recorder, const raster::PageWriterInputs& in) { fragments_->record(recorder, in, side); });
  }

  inline static std::unique_ptr<raster::PageFragments> fragments_;
  inline static std::unique_ptr<raster::PageRaster> raster_;
};

struct Tally {
  uint64_t texels = 0, covered = 0, missing = 0, extra = 0, wrong_depth = 0;
};

Tally compare(const PageRig& rig, const std::vector<uint32_t>& pool) {
  Tally tally;
  std::vector<bool> in_page(pool.size());
  for (const PageRig::Page& page : rig.pages()) {
    const reference::DepthWindow expected = rig.reference(page);
    for (uint32_t i = 0; i < page.side * page.side; ++i) {
      const uint32_t key = pool[page.pool_texel + i];
      in_page[page.pool_texel + i] = true;
      ++tally.texels;
      tally.covered += expected.covered[i];
      tally.missing += expected.depth[i] > 0 && key == 0;
      tally.extra += !expected.covered[i] && key != 0;
      if (key == 0 || expected.depth[i] == 0) continue;
      const double depth = shared::uintBitsToFloat(key);
      tally.wrong_depth += std::abs(depth - expected.depth[i]) > 8 * std::ldexp(expected.depth[i], -24);
    }
  }
  for (size_t i = 0; i < pool.size(); ++i) tally.extra += !in_page[i] && pool[i] != 0;
  return tally;
}

void expect_reference(const PageRig& rig, const std::vector<uint32_t>& pool, double least_covered) {
  const Tally tally = compare(rig, pool);
  EXPECT_EQ(tally.missing, 0u) << "of " << tally.texels;
  EXPECT_EQ(tally.extra, 0u) << "of " << tally.texels;
  EXPECT_EQ(tally.wrong_depth, 0u) << "of " << tally.covered;
  EXPECT_GE(double(tally.covered), least_covered * double(tally.texels));
}

/// Triangles of every size and shape around the origin, in all directions, some through it and behind everything.
TestMesh spiteful_mesh(uint32_t count, uint32_t seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit(0, 1);
  TestMesh mesh;
  const auto random = [&](float size) { return glm::vec3(normal(engine), normal(engine), normal(engine)) * size; };
  for (uint32_t i = 0; i < count; ++i) {
    const float size = std::exp2(-8 + 9 * unit(engine)), distance = std::exp2(-6 + 9 * unit(engine));
    const glm::vec3 at = glm::normalize(random(1)) * distance;
    glm::vec3 corners[3] = {at, at + random(size), at + random(size)};
    switch (engine() % 12) {
      case 0:
        corners[2] = corners[1] + random(1e-4f);
        break;  // sliver
      case 1:
        corners[1] = at + random(200), corners[2] = at - random(200);
        break;  // huge
      case 2:
        corners[2] = glm::mix(corners[0], corners[1], 0.3f);
        break;  // degenerate
      case 3:
        corners[1] = -at;
        break;  // through the light, or nearly
      case 4:
        corners[1] = at + random(0.01f), corners[2] = -at * 30.0f;
        break;  // from before to behind
      case 5:
        corners[0] = random(0.02f), corners[1] = random(0.02f);
        break;  // about the near plane
      default:
        break;
    }
    for (const glm::vec3& corner : corners) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(to_vec3(corner));
    }
  }
  return mesh;
}

TestScene spiteful_scene(uint32_t triangles, uint32_t seed) {
  TestScene scene;
  scene.meshes = {spiteful_mesh(triangles, seed), sphere_mesh(12, 16), box_mesh()};
  scene.instances = {
      {.mesh = 0, .world_from_mesh = affine(glm::mat3(1), {0, 0, 0})},
      {.mesh = 1, .world_from_mesh = random_affine(seed, {2, 0.6f, 1})},
      {.mesh = 1, .world_from_mesh = affine(glm::mat3(-0.7f, 0, 0, 0, 0.7f, 0, 0, 0, 0.7f), {-1, 1, -2})},  // mirrored
      {.mesh = 2, .world_from_mesh = affine(glm::mat3(9), {0.1f, 0.2f, 0.3f})}};                            // a room
  return scene;
}

TEST_F(PageRasterTest, DrawsCubesAsTheReference) {
  std::vector<PageMap> maps;
  for (const uint32_t resolution : {4u, 8u, 16u, 32u, 64u, 128u, 256u, 384u, 512u})
    maps.push_back(cube_map({0.03f, -0.02f, 0.01f}, 0.05f, resolution, resolution > 128 ? 0.6 : 1));
  for (const uint32_t seed : {1u, 2u, 3u}) {
    PageRig rig(gpu(), spiteful_scene(300, seed), maps, seed);
    expect_reference(rig, draw(rig, 10000), 0.9);
  }
}

/// The views of all maps in which the casters cover a texel whose bit is set.
uint32_t views_that_need(const PageRig& rig, const std::vector<uint32_t>& bits) {
  std::set<std::pair<uint32_t, uint32_t>> views;
  for (const PageRig::Page& page : rig.pages()) {
    const reference::DepthWindow window = rig.reference(page);
    for (uint32_t i = 0; i < page.side * page.side; ++i) {
      const uint32_t texel = page.pool_texel + i;
      if (window.covered[i] && (bits[texel / 32] >> texel % 32 & 1)) views.emplace(page.map, page.view);
    }
  }
  return static_cast<uint32_t>(views.size());
}

TEST_F(PageRasterTest, TheOracleCountsTrianglesThatCoverALookedUpTexel) {
  const raster::NeededTriangles oracle = take(raster::NeededTriangles::create(gpu().factory()));
  const std::vector<PageMap> maps{cube_map({0.03f, -0.02f, 0.01f}, 0.05f, 32),
                                  cube_map({0.03f, -0.02f, 0.01f}, 0.05f, 256, 0.6),
                                  spot_map({1, 2, 1}, {-0.3f, -1, 0.2f}, 0.7f, 0.1f, 128)};
  uint32_t all = 0, needed_of_all = 0;
  for (uint32_t seed = 0; seed < 40; ++seed) {
    TestScene scene;
    scene.meshes = {spiteful_mesh(1, seed)};
    scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(1), {0, 0, 0})}};
    PageRig rig(gpu(), scene, maps, seed);
    rig.list_items(seed, false);
    std::mt19937 engine(seed);
    std::vector<uint32_t> bits(rig.pool_bytes() / sizeof(uint32_t) / 32 + 1);
    for (uint32_t& word : bits) word = engine() % 8 == 0 ? uint32_t(engine() & engine() & engine()) : 0;
    for (const bool everything : {true, false}) {
      const std::vector<uint32_t> looked_up = everything ? std::vector<uint32_t>(bits.size(), ~0u) : bits;
      const gpu::Buffer texels = gpu().upload(looked_up), count = gpu().upload(std::vector<uint32_t>{5});
      rig.run([&](gpu::Recorder& recorder, const raster::PageWriterInputs& in) {
        oracle.record(recorder, in, texels.address(), count.address());
      });
      const uint32_t found = gpu().download<uint32_t>(count, 1)[0] - 5;
      EXPECT_EQ(found, views_that_need(rig, looked_up)) << "triangle " << seed;
      (everything ? all : needed_of_all) += found;
    }
  }
  EXPECT_GT(needed_of_all, 30u);
  EXPECT_LT(needed_of_all, all);
}

TEST_F(PageRasterTest, DrawsLargeMapsAsTheReference) {
  const std::vector<PageMap> maps{cube_map({0.5f, 0.2f, -0.1f}, 0.02f, 8192, 0.002),
                                  cube_map({-1, 0.2f, 1}, 0.1f, 2048, 0.03),
                                  spot_map({1, 2, 1}, {-0.3f, -1, 0.2f}, 0.7f, 0.1f, 4096, 0.02)};
  PageRig rig(gpu(), spiteful_scene(200, 7), maps, 7);
  expect_reference(rig, draw(rig, 10000), 0.9);
}

TEST_F(PageRasterTest, DrawsSpotsAndSunsAsTheReference) {
  std::vector<PageMap> maps;
  for (const uint32_t resolution : {4u, 32u, 128u, 512u}) {
    maps.push_back(spot_map({0.5f, 3, 0.2f}, {0.2f, -1, -0.4f}, 0.6f, 0.1f, resolution, 0.7));
    maps.push_back(ortho_map({0.3f, -1, 0.45f}, glm::vec3(-10), glm::vec3(10), resolution, 0.7));
    maps.push_back(ortho_map({0, 0, 1}, glm::vec3(-2), glm::vec3(3), resolution, 0.7));  // casters beyond all its sides
  }
  PageRig rig(gpu(), spiteful_scene(300, 4), maps, 4);
  expect_reference(rig, draw(rig, 10000), 0.5);
}

TEST_F(PageRasterTest, GivesTheSameBitsHoweverItIsFed) {
  const std::vector<PageMap> maps{cube_map({0, 0, 0}, 0.05f, 512, 0.8), cube_map({0.4f, 1, 0}, 0.1f, 64),
                                  spot_map({0, 3, 0}, {0, -1, 0.1f}, 0.8f, 0.1f, 1024, 0.7),
                                  ortho_map({0.3f, -1, 0.45f}, glm::vec3(-10), glm::vec3(10), 512, 0.7)};
  TestScene scene = spiteful_scene(300, 9);
  scene.meshes.push_back(masked_mesh());
  scene.instances.push_back({.mesh = 3, .world_from_mesh = affine(glm::mat3(3), {0.5f, 1.2f, -2.5f})});
  PageRig rig(gpu(), scene, maps, 9);
  const auto plain = draw(rig, 100000);
  EXPECT_GT(std::count_if(plain.begin(), plain.end(), [](uint32_t key) { return key != 0; }),
            ptrdiff_t(plain.size() / 2));
  EXPECT_EQ(draw(rig, 100000), plain) << "the second time";
  EXPECT_EQ(draw(rig, 0), plain) << "without a queue";
  EXPECT_EQ(draw(rig, 3), plain) << "with a queue that overflows";
  EXPECT_EQ(draw(rig, 70), plain) << "with lists that overflow";
  rig.list_items(10, true);
  EXPECT_EQ(draw(rig, 100000), plain) << "in another order, face by face";
}

TEST_F(PageRasterTest, DrawsOnlyTexelsThatAreLookedUp) {
  std::vector<PageMap> maps{cube_map({0, 0, 0}, 0.05f, 512, 0.8), cube_map({0.4f, 1, 0}, 0.1f, 32),
                            cube_map({0.4f, 1, 0}, 0.1f, 16), spot_map({0, 3, 0}, {0, -1, 0.1f}, 0.8f, 0.1f, 1024, 0.7),
                            cube_map({0, 0, 0}, 0.05f, 256)};
  maps.back().whole = true;
  TestScene scene = spiteful_scene(300, 9);
  scene.meshes.push_back(masked_mesh());
  scene.instances.push_back({.mesh = 3, .world_from_mesh = affine(glm::mat3(3), {0.5f, 1.2f, -2.5f})});
  PageRig rig(gpu(), scene, maps, 9);
  auto expected = draw(rig, 100000);
  for (const double share : {0.02, 0.5}) {
    rig.look_up(share, 5);
    uint64_t left_out = 0;
    for (const PageRig::Page& page : rig.pages()) {
      for (uint32_t i = page.pool_texel; !rig.draws_all(page.map) && i < page.pool_texel + page.side * page.side; ++i) {
        const uint32_t texel = i - page.pool_texel, row = shared::texel_word(page.pool_texel, texel / page.side);
        if (rig.texel_bits()[row] >> texel % page.side & 1) continue;
        left_out += expected[i] != 0;
        expected[i] = 0;
      }
    }
    EXPECT_GT(left_out, expected.size() / 10);
    EXPECT_EQ(draw(rig, 100000), expected) << share;
    EXPECT_EQ(draw(rig, 0), expected) << "without a queue";
    EXPECT_EQ(draw(rig, 70), expected) << "with lists that overflow";
    expected = (rig.look_up(1, 5), draw(rig, 100000));
  }
}

/// Texels that only one of two pools has, and those whose depths differ by more than a thousandth: on surfaces seen edge-on, where
/// vertices snap apart.
struct Difference {
  uint64_t covered = 0, alone = 0, depth = 0;
};
Difference difference(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  Difference out;
  for (size_t i = 0; i < a.size(); ++i) {
    const float first = shared::uintBitsToFloat(a[i]), second = shared::uintBitsToFloat(b[i]);
    out.covered += a[i] != 0;
    if ((a[i] == 0) != (b[i] == 0))
      ++out.alone;
    else
      out.depth += std::abs(first - second) > 1e-3f * first;
  }
  return out;
}

const std::vector<PageMap> kFewMaps{cube_map({0, 0, 0}, 0.05f, 1024), cube_map({0.1f, 3, 0.2f}, 0.05f, 512, 0.7),
                                    cube_map({0.1f, 3, 0.2f}, 0.05f, 32),
                                    spot_map({-3, 3, 0.5f}, {1, -1, 0.1f}, 0.5f, 0.1f, 1024),
                                    ortho_map({0.3f, -1, 0.45f}, glm::vec3(-3), glm::vec3(3), 1024)};

TEST_F(PageRasterTest, AgreesWithTheHardware) {
  TestScene scene;
  scene.meshes = {sphere_mesh(120, 150), box_mesh()};
  scene.instances = {{.mesh = 0, .world_from_mesh = random_affine(3, {1.5f, 0.4f, 0.3f})},
                     {.mesh = 0, .world_from_mesh = random_affine(8, {-0.8f, -1.4f, 0.9f})},
                     {.mesh = 1, .world_from_mesh = random_affine(4, {0.2f, 1.9f, -2})},
                     {.mesh = 1, .world_from_mesh = affine(glm::mat3(4), {3, 0.3f, 0.2f})}};
  PageRig rig(gpu(), scene, kFewMaps, 2);
  const auto pool = draw(rig, 1000);
  const Difference found = difference(pool, draw_by_fragments(rig));
  EXPECT_GT(found.covered, 3000000u);
  EXPECT_LE(found.alone, pool.size() / 1000000) << "of " << pool.size();
  EXPECT_LE(found.depth, found.covered / 10000) << "of " << found.covered;
}

TEST_F(PageRasterTest, CutsMasksAsTheHardware) {
  TestScene scene;
  scene.meshes = {masked_mesh(), box_mesh()};
  for (uint32_t i = 0; i < 12; ++i)
    scene.instances.push_back(
        {.mesh = i == 0,
         .world_from_mesh = random_affine(
             i + 20, {3 * std::sin(2.4f * float(i)), 2 * std::sin(1.3f * float(i)), 3 * std::cos(2.4f * float(i))})});
  PageRig rig(gpu(), scene, kFewMaps, 2);
  for (const uint32_t large : {0u, 1000u}) {
    const Difference found = difference(draw(rig, large), draw_by_fragments(rig));
    EXPECT_GT(found.covered, 300000u);
    EXPECT_LE(found.alone, found.covered / 10000) << "of " << found.covered;
    EXPECT_LE(found.depth, found.covered / 1000) << "of " << found.covered;
  }
}

TEST_F(PageRasterTest, OrdersItsPasses) {
  TestScene scene = spiteful_scene(20, 3);
  scene.meshes.push_back(masked_mesh());
  scene.instances.push_back({.mesh = 3, .world_from_mesh = affine(glm::mat3(3), {0.5f, 1.2f, -2.5f})});
  PageRig rig(gpu(), scene, {cube_map({0, 0, 0}, 0.05f, 128)}, 3);
  draw(rig, 10);  // makes room
  gpu::HazardLog log;
  rig.run(
      [](gpu::Recorder& recorder, const raster::PageWriterInputs& in) {
        for (int twice = 0; twice < 2; ++twice) {
          raster_->record(recorder, in);
          fragments_->record(recorder, in, 128);
        }
      },
      &log);
  EXPECT_GT(log.size(), 100u);
  for (const gpu::Hazard& hazard : gpu::find_hazards(log)) ADD_FAILURE() << hazard.text;
}

/// A light at the origin looks along +z at a plane a metre away: x and y of the plane are s and -t.
glm::vec3 at_texel(double column, double row, uint32_t resolution) {
  return {float(column / resolution * 2 - 1), float(1 - row / resolution * 2), 1};
}

TEST_F(PageRasterTest, CoversTexelCentresOnEdgesOnce) {
  constexpr uint32_t kSide = 256;
  struct Quad {
    double left, top, right, bottom;
  };
  const Quad quads[] = {{10.5, 10.5, 20.5, 14.5},
                        {100.5, 3.5, 164.5, 67.5},
                        {0, 200, 256, 256},
                        {30.5, 100.5, 31.5, 101.5},
                        {120.25, 120.75, 136.5, 135.5}};
  for (const bool falling : {true, false}) {
    TestScene scene;
    TestMesh mesh;
    for (const Quad& quad : quads) {
      const uint32_t first = static_cast<uint32_t>(mesh.positions.size());
      for (const glm::dvec2& corner : {glm::dvec2(quad.left, quad.top),
                                       {quad.right, quad.top},
                                       {quad.right, quad.bottom},
                                       {quad.left, quad.bottom}})
        mesh.positions.push_back(to_vec3(at_texel(corner.x, corner.y, kSide)));
      for (const uint32_t i : falling ? std::array{0u, 1u, 2u, 0u, 2u, 3u} : std::array{0u, 3u, 1u, 1u, 2u, 3u})
        mesh.indices.push_back(first + i);
    }
    scene.meshes = {mesh};
    scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(1), {0, 0, 0})}};
    PageRig rig(gpu(), scene, {cube_map({0, 0, 0}, 0.5f, kSide)}, 1);
    const auto pool = draw(rig, 100);
    uint32_t wrong = 0, covered = 0;
    for (const PageRig::Page& page : rig.pages()) {
      for (uint32_t i = 0; i < page.side * page.side; ++i) {
        const double x = page.first.x + i % page.side + 0.5, y = page.first.y + i / page.side + 0.5;
        const bool inside = page.view == 4 && std::any_of(std::begin(quads), std::end(quads), [&](const Quad& quad) {
                              return x >= quad.left && x < quad.right && y >= quad.top && y < quad.bottom;
                            });
        covered += inside;
        wrong += pool[page.pool_texel + i] != (inside ? shared::floatBitsToUint(0.5f) : 0u);
      }
    }
    EXPECT_EQ(wrong, 0u) << "of " << covered << " covered";
    EXPECT_EQ(covered, 40u + 64u * 64u + 256u * 56u + 1u + 16u * 14u);
  }
}

}  // namespace
}  // namespace umbrage::test
