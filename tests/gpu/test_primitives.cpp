// Rounding, prefix sums and the 32-way tree against plain CPU versions: every integer and every box exactly.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "gpu.hpp"
#include "gpu/prefix_sum.hpp"
#include "raster/triangle.shared.h"
#include "reference/hierarchy.hpp"
#include "scene/box_tree.hpp"

namespace umbrage::test {
namespace {

using shared::Box;

constexpr uint32_t kPlaceVertices[] =
#include "shaders/place_vertices.comp.inc"
    ;

class Rounding : public GpuTest {};
class PrefixSums : public GpuTest {};
class BoxTrees : public GpuTest {};

std::vector<uint32_t> random_counts(uint32_t count, uint32_t largest, uint32_t seed) {
  std::mt19937 engine(seed);
  std::vector<uint32_t> values(count);
  for (uint32_t& value : values) value = static_cast<uint32_t>(engine() % (largest + 1));
  return values;
}

TEST_F(Rounding, OfVerticesIsThatOfTheCpu) {
  struct Push {
    VkDeviceAddress positions, places;
    uint32_t count, resolution;
  };
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> side(-1.5f, 1.5f), depth(0.1f, 100);
  std::vector<glm::vec4> positions;
  for (uint32_t i = 0; i < 100000; ++i) {
    const float w = depth(engine);
    positions.emplace_back(side(engine) * w, side(engine) * w, 0.1f, w);
  }
  for (int i = -4096; i <= 4096; ++i) positions.emplace_back(float(i) / 8192, float(i) / 4096, 0.5f, 1);  // ties
  const gpu::Buffer input = gpu().upload(positions),
                    output = gpu().buffer(positions.size() * sizeof(glm::ivec4), gpu::MemoryKind::device, "places");
  const Program program(gpu(), kPlaceVertices, {});
  const auto count = static_cast<uint32_t>(positions.size());
  for (const uint32_t resolution : {16u, 192u, 512u, 8192u}) {
    gpu().run([&](VkCommandBuffer commands) {
      program.dispatch(commands, {}, Push{input.address(), output.address(), count, resolution}, (count + 63) / 64);
    });
    const std::vector<glm::ivec4> places = gpu().download<glm::ivec4>(output, positions.size());
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < count; ++i) {
      shared::PlacedVertex placed;
      const bool valid = shared::place_vertex(positions[i], resolution, placed);
      const glm::ivec4 expected(placed.x, placed.y, std::lrint(positions[i].x * 4096), valid);
      if (places[i] != expected && wrong++ < 5)
        ADD_FAILURE() << positions[i].x << ' ' << positions[i].y << ' ' << positions[i].w << " at " << resolution
                      << ": " << places[i].x << ' ' << places[i].y << ' ' << places[i].z << ", expected " << expected.x
                      << ' ' << expected.y << ' ' << expected.z;
    }
    EXPECT_EQ(wrong, 0u) << "of " << count << " at " << resolution;
  }
}

TEST_F(PrefixSums, EqualTheCpuAtEverySize) {
  gpu::PrefixSum sum = take(gpu::PrefixSum::create(gpu().factory()));
  std::vector<gpu::Buffer> retired;
  std::vector<uint32_t> sizes{0, 1, 15, 16, 17, 2047, 2048, 2049, 100000, 300000};
  std::mt19937 engine(7);
  for (int i = 0; i < 6; ++i) sizes.push_back(static_cast<uint32_t>(engine() % 20000));
  for (const uint32_t size : sizes) {
    const std::vector<uint32_t> counts = random_counts(size, 1000, size);
    const gpu::Buffer values = gpu().upload(counts);
    const gpu::Buffer total = gpu().upload(std::vector<uint32_t>{77, 77, 77});
    take(sum.reserve(gpu().device(), gpu().memory(), size, retired));
    gpu().run([&](VkCommandBuffer commands) {
      gpu::Recorder recorder = gpu().recorder(commands);
      sum.record(recorder, values, size, total, sizeof(uint32_t));
    });
    std::vector<uint32_t> expected(size);
    std::exclusive_scan(counts.begin(), counts.end(), expected.begin(), 0u);
    EXPECT_EQ(gpu().download<uint32_t>(values, size), expected) << size << " values";
    const std::vector<uint32_t> totals{77, std::accumulate(counts.begin(), counts.end(), 0u), 77};
    EXPECT_EQ(gpu().download<uint32_t>(total, 3), totals) << size << " values";
  }
}

TEST_F(PrefixSums, OfACountThatOnlyTheDeviceKnows) {
  gpu::PrefixSum sum = take(gpu::PrefixSum::create(gpu().factory()));
  std::vector<gpu::Buffer> retired;
  constexpr uint32_t kCapacity = 300000;
  take(sum.reserve(gpu().device(), gpu().memory(), kCapacity, retired));
  for (const uint32_t scale : {1u, 2u, 3u}) {
    for (const uint32_t counted :
         {0u, 1u, 15u, 16u, 1024u, 2047u, 2048u, 2049u, 70000u, 100000u, 299999u, 300000u, 1u << 29}) {
      const std::vector<uint32_t> counts = random_counts(kCapacity, 1000, counted + scale);
      const gpu::Buffer values = gpu().upload(counts);
      const gpu::Buffer words =
          gpu().upload(std::vector<uint32_t>{5, counted, 77, 99});  // the count and the total in one buffer
      gpu().run([&](VkCommandBuffer commands) {
        gpu::Recorder recorder = gpu().recorder(commands);
        sum.record(recorder, values, {words, sizeof(uint32_t), scale}, kCapacity, words, 2 * sizeof(uint32_t));
      });
      const auto end = counts.begin() + std::min(counted * scale, kCapacity);
      std::vector<uint32_t> expected = counts;
      std::exclusive_scan(counts.begin(), end, expected.begin(), 0u);
      EXPECT_TRUE(gpu().download<uint32_t>(values, kCapacity) == expected) << counted << " times " << scale;
      const std::vector<uint32_t> totals{5, counted, std::accumulate(counts.begin(), end, 0u), 99};
      EXPECT_EQ(gpu().download<uint32_t>(words, 4), totals) << counted << " times " << scale;
    }
  }
}

TEST_F(PrefixSums, WrapAsUnsignedNumbersDo) {
  gpu::PrefixSum sum = take(gpu::PrefixSum::create(gpu().factory()));
  std::vector<gpu::Buffer> retired;
  const gpu::Buffer values = gpu().upload(std::vector<uint32_t>{0xffffffffu, 3, 0x80000000u});
  const gpu::Buffer total = gpu().upload(std::vector<uint32_t>{0});
  take(sum.reserve(gpu().device(), gpu().memory(), 3, retired));
  gpu().run([&](VkCommandBuffer commands) {
    gpu::Recorder recorder = gpu().recorder(commands);
    sum.record(recorder, values, 3, total, 0);
  });
  EXPECT_EQ(gpu().download<uint32_t>(values, 3), (std::vector<uint32_t>{0, 0xffffffffu, 2}));
  EXPECT_EQ(gpu().download<uint32_t>(total, 1)[0], 0x80000002u);
}

const Box empty_box{shared::vec3(1e30f), shared::vec3(-1e30f)};

Box box_around(const glm::vec3& centre, const glm::vec3& half) { return {centre - half, centre + half}; }

std::vector<Box> random_boxes(uint32_t count, uint32_t seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> place(-50, 50), size(0, 3);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    const glm::vec3 centre(place(engine), place(engine), place(engine));
    box = box_around(centre, {size(engine), size(engine), size(engine)});
  }
  return boxes;
}

/// The tree as the stage's header promises it: Morton order with ties in box order, empty boxes last, nodes as unions.
struct CpuTree {
  std::vector<uint32_t> order;
  std::vector<Box> leaves, nodes;
};

CpuTree cpu_tree(const std::vector<Box>& boxes) {
  Box all = empty_box;
  for (const Box& box : boxes) all = {glm::min(all.lo, box.lo), glm::max(all.hi, box.hi)};
  std::vector<uint32_t> keys(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i)
    keys[i] =
        shared::box_is_empty(boxes[i]) ? shared::NoIndex : shared::morton_code((boxes[i].lo + boxes[i].hi) * 0.5f, all);
  CpuTree tree;
  tree.order.resize(boxes.size());
  std::iota(tree.order.begin(), tree.order.end(), 0u);
  std::stable_sort(tree.order.begin(), tree.order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  for (const uint32_t item : tree.order) tree.leaves.push_back(boxes[item]);
  std::vector<Box> below = tree.leaves;
  while (!below.empty()) {
    std::vector<Box> level((below.size() + 31) / 32, empty_box);
    for (size_t i = 0; i < below.size(); ++i)
      level[i / 32] = {glm::min(level[i / 32].lo, below[i].lo), glm::max(level[i / 32].hi, below[i].hi)};
    tree.nodes.insert(tree.nodes.end(), level.begin(), level.end());
    below = level.size() > 1 ? level : std::vector<Box>{};
  }
  return tree;
}

bool same(const std::vector<Box>& a, const std::vector<Box>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Box)) == 0);
}

void expect_tree(Gpu& gpu, scene::BoxTree& tree, const scene::TreePipelines& pipelines, const std::vector<Box>& boxes,
                 const std::string& what) {
  std::vector<gpu::Buffer> retired;
  const auto count = static_cast<uint32_t>(boxes.size());
  const gpu::Buffer input = gpu.upload(boxes);
  take(tree.reserve(gpu.device(), gpu.memory(), count, retired));
  gpu.run([&](VkCommandBuffer commands) {
    gpu::Recorder recorder = gpu.recorder(commands);
    tree.record(recorder, pipelines, input, count);
  });
  const CpuTree expected = cpu_tree(boxes);
  EXPECT_EQ(gpu.download<uint32_t>(tree.order(), count), expected.order) << what;
  EXPECT_TRUE(same(gpu.download<Box>(tree.leaves(), count), expected.leaves)) << what;
  EXPECT_TRUE(same(gpu.download<Box>(tree.nodes(), expected.nodes.size()), expected.nodes)) << what;
  const shared::TreeShape& shape = tree.shape();
  EXPECT_EQ(shape.levels ? shape.first[shape.levels - 1] + shape.nodes[shape.levels - 1] : 0, expected.nodes.size())
      << what;
  if (shape.levels) { EXPECT_EQ(shape.nodes[shape.levels - 1], 1u) << what; }
}

TEST_F(BoxTrees, EqualTheCpuAtEverySize) {
  const scene::TreePipelines pipelines = take(scene::TreePipelines::create(gpu().factory()));
  scene::BoxTree tree;  // one for all: it grows, and later trees are smaller than what it holds
  for (const uint32_t count : {1u, 0u, 31u, 32u, 33u, 1024u, 1025u, 40000u, 2048u, 2049u, 5u})
    expect_tree(gpu(), tree, pipelines, random_boxes(count, count), std::to_string(count) + " boxes");
}

TEST_F(BoxTrees, EqualTheCpuOnAwkwardBoxes) {
  const scene::TreePipelines pipelines = take(scene::TreePipelines::create(gpu().factory()));
  scene::BoxTree tree;
  std::vector<Box> boxes = random_boxes(3000, 1);
  for (size_t i = 0; i < boxes.size(); i += 3) boxes[i] = empty_box;
  expect_tree(gpu(), tree, pipelines, boxes, "every third box empty");
  expect_tree(gpu(), tree, pipelines, std::vector<Box>(1500, empty_box), "only empty boxes");
  expect_tree(gpu(), tree, pipelines, std::vector<Box>(1500, box_around({3, -2, 1}, {0.5f, 1, 2})), "equal boxes");
  expect_tree(gpu(), tree, pipelines, std::vector<Box>(70, box_around({3, -2, 1}, {0, 0, 0})), "one point");
  boxes = random_boxes(2500, 2);
  for (Box& box : boxes) box.lo.y = box.hi.y = 4;
  expect_tree(gpu(), tree, pipelines, boxes, "all in one plane");
  for (Box& box : boxes) box.lo.x = box.hi.x = -7;
  expect_tree(gpu(), tree, pipelines, boxes, "all on one line");
  boxes = random_boxes(2500, 3);
  boxes[17] = box_around({0, 0, 0}, {1e6f, 1e6f, 1e6f});
  boxes[18] = box_around({1e-30f, 0, 0}, {1e-38f, 0, 0});
  expect_tree(gpu(), tree, pipelines, boxes, "a huge one and a tiny one");
}

TEST_F(BoxTrees, OrderAgreesWithTheReference) {
  const scene::TreePipelines pipelines = take(scene::TreePipelines::create(gpu().factory()));
  scene::BoxTree tree;
  std::vector<gpu::Buffer> retired;
  const std::vector<Box> boxes = random_boxes(5000, 11);
  std::vector<reference::Box> plain(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) plain[i].min = boxes[i].lo, plain[i].max = boxes[i].hi;
  const gpu::Buffer input = gpu().upload(boxes);
  take(tree.reserve(gpu().device(), gpu().memory(), 5000, retired));
  gpu().run([&](VkCommandBuffer commands) {
    gpu::Recorder recorder = gpu().recorder(commands);
    tree.record(recorder, pipelines, input, 5000);
  });
  // 1024 t and (1024 / extent) d round differently at cell borders: a few items may differ, not the order at large.
  const std::vector<uint32_t> order = gpu().download<uint32_t>(tree.order(), 5000),
                              expected = reference::morton_order(plain);
  size_t moved = 0;
  for (size_t i = 0; i < order.size(); ++i) moved += order[i] != expected[i];
  EXPECT_LE(moved, 20u);
}

}  // namespace
}  // namespace umbrage::test
