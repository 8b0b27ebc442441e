// How long the writers of the page pool take, side by side in one run. Not a test: run it with
// --gtest_also_run_disabled_tests --gtest_filter=*MeasuresPageWriters* on an idle machine.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "page_rig.hpp"

namespace umbrage::test {
namespace {

class MeasuresPageWriters : public GpuTest {};

/// Device time of what is recorded, in milliseconds.
class Stopwatch {
 public:
  explicit Stopwatch(Gpu& gpu) : gpu_(gpu) {
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2;
    check(vkCreateQueryPool(gpu.desc().device, &info, nullptr, &pool_), "vkCreateQueryPool");
  }
  Stopwatch(const Stopwatch&) = delete;
  ~Stopwatch() { vkDestroyQueryPool(gpu_.desc().device, pool_, nullptr); }
  void start(VkCommandBuffer commands) {
    vkCmdResetQueryPool(commands, pool_, 0, 2);
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, 0);
  }
  void stop(VkCommandBuffer commands) {
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, 1);
  }
  double ms() {
    uint64_t ticks[2];
    check(vkGetQueryPoolResults(gpu_.desc().device, pool_, 0, 2, sizeof ticks, ticks, sizeof(uint64_t),
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    return double(ticks[1] - ticks[0]) * double(gpu_.device().limits().timestamp_period_ns) * 1e-6;
  }

 private:
  Gpu& gpu_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
};

/// Of all threads of the process. On a software device it counts the drawing, however busy the machine is.
double processor_ms() { return double(std::clock()) * 1e3 / CLOCKS_PER_SEC; }

struct Case {
  const char* name;
  TestScene scene;
  std::vector<PageMap> maps;
};

std::vector<Case> cases() {
  std::vector<Case> out;
  TestScene sphere;
  sphere.meshes = {sphere_mesh(120, 150)};
  sphere.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(1), {0, 0, 0})}};
  static char names[2][40];
  for (const uint32_t resolution : {256u, 1024u}) {
    std::vector<PageMap> maps;
    for (uint32_t i = 0; i < 16; ++i) {
      const glm::vec3 direction(std::cos(2.4f * float(i)), std::sin(1.7f * float(i)), std::sin(2.4f * float(i)));
      maps.push_back(spot_map(glm::normalize(direction) * -2.5f, direction, 0.45f, 0.1f, resolution));
    }
    std::snprintf(names[resolution > 256], sizeof names[0], "sphere, 16 views of %u texels", resolution);
    out.push_back({names[resolution > 256], sphere, maps});
  }
  TestScene room;
  room.meshes = {box_mesh()};
  room.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(4), {0.4f, 0.2f, 0.3f})}};
  for (uint32_t i = 0; i < 30; ++i)
    room.instances.push_back(
        {.mesh = 0,
         .world_from_mesh = random_affine(
             i, {2 * std::sin(2.4f * float(i)), std::sin(1.3f * float(i)), 2 * std::cos(2.4f * float(i))})});
  out.push_back({"room of boxes, cube of 1024 texels", room, {cube_map({0.1f, 2.5f, 0}, 0.05f, 1024)}});
  if (!getenv("NOBIG"))
    out.push_back({"room of boxes, cube of 4096 texels", room, {cube_map({0.1f, 2.5f, 0}, 0.05f, 4096)}});
  return out;
}

TEST_F(MeasuresPageWriters, DISABLED_SideBySide) {
  raster::PageRaster compute = take(raster::PageRaster::create(gpu().factory()));
  raster::PageFragments fragments = take(raster::PageFragments::create(gpu().factory()));
  take(fragments.reserve(gpu().device(), gpu().memory()));
  Stopwatch watch(gpu());
  for (const Case& one : cases()) {
    PageRig rig(gpu(), one.scene, one.maps, 1);
    std::vector<gpu::Buffer> retired;
    take(compute.reserve(gpu().device(), gpu().memory(), 65536, rig.pool_bytes(), retired));
    uint64_t triangles = 0, views = 0;
    for (const TestInstance& instance : one.scene.instances)
      triangles += one.scene.meshes[instance.mesh].indices.size() / 3;
    for (const PageMap& map : one.maps) views += map.views.size();
    double best[2] = {1e30, 1e30}, processor[2] = {1e30, 1e30};
    for (int repeat = 0; repeat < 5; ++repeat) {
      for (int writer = 0; writer < 2; ++writer) {
        rig.clear();
        const double before = processor_ms();
        rig.run([&](gpu::Recorder& recorder, const raster::PageWriterInputs& in) {
          watch.start(recorder.pass("start").commands());
          if (writer == 0)
            compute.record(recorder, in);
          else
            fragments.record(recorder, in, rig.max_resolution());
          watch.stop(recorder.pass("stop").commands());
        });
        processor[writer] = std::min(processor[writer], processor_ms() - before);
        best[writer] = std::min(best[writer], watch.ms());
      }
    }
    for (int writer = 0; writer < 2; ++writer)
      std::printf("%-36s %-9s %9.3f ms device %9.3f ms processors %8.3f Mtri/s\n", one.name,
                  writer ? "fragments" : "compute", best[writer], processor[writer],
                  double(triangles * views) * 1e-3 / best[writer]);
  }
}

}  // namespace
}  // namespace umbrage::test
