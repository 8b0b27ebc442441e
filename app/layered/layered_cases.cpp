// Scenes and views of the chapter's cases, and how one of them is measured.
#include "layered/layered_cases.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "host/gpu_timers.hpp"
#include "host/layer_images.hpp"

namespace app {

using umbrage::LayeredWriter;
using umbrage::Result;

namespace {
constexpr uint32_t kRingBones = 64;
constexpr uint32_t kAround = 178, kAcross = 100;

struct Extent3 {
  glm::vec3 center{0};
  float diagonal = 1;
};

/// Of the first instance, in the world.
Extent3 extent_of(const LayeredArrays& arrays) {
  glm::vec3 lo(std::numeric_limits<float>::max()), hi(-lo);
  const float* m = arrays.instances[0].world_from_mesh.m;
  for (const umbrage::Vec3& p : arrays.meshes[arrays.instances[0].mesh].positions) {
    const glm::vec3 world(m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]);
    lo = glm::min(lo, world), hi = glm::max(hi, world);
  }
  return {0.5f * (lo + hi), glm::length(hi - lo)};
}

}  // namespace

std::span<const LayeredCase> layered_cases() {
  using enum umbrage::CasterSelection;
  using enum umbrage::CulledFaces;
  static constexpr std::array<LayeredCase, 9> kCases{{
      {.name = "simple", .figure = "19.3", .summary = "the simple vertex shader, rasterised", .rasterizes = true},
      {.name = "simple, discard", .figure = "19.4", .summary = "the same without rasterisation"},
      {.name = "skeletal", .figure = "19.6", .summary = "64 bones, four a vertex", .is_skinned = true},
      {.name = "four instances", .figure = "19.7", .summary = "one of four is visible, no culling", .instances = 4},
      {.name = "four instances, frustum",
       .figure = "19.7",
       .summary = "frustum culling per triangle",
       .instances = 4,
       .cull_frustum = true},
      {.name = "four instances, selected",
       .figure = "19.7",
       .summary = "batches selected on the device (R3)",
       .instances = 4,
       .selection = each_view},
      {.name = "back faces", .figure = "19.8", .summary = "back-face culling", .culled_faces = back},
      {.name = "combined",
       .figure = "19.9",
       .summary = "skeletal, four instances, frustum and back-face culling",
       .is_skinned = true,
       .instances = 4,
       .cull_frustum = true,
       .culled_faces = back},
      {.name = "combined, no culling",
       .figure = "19.9",
       .summary = "skeletal, four instances: the traditional baseline",
       .is_skinned = true,
       .instances = 4},
  }};
  return kCases;
}

bool runs_case(LayeredWriter writer, const LayeredCase& tried) {
  const bool sees_triangles = writer == LayeredWriter::geometry_invocations || writer == LayeredWriter::geometry_loop ||
                              writer == LayeredWriter::mesh;
  if (tried.cull_frustum) return sees_triangles;
  return writer != LayeredWriter::compute || tried.rasterizes;
}

LayeredArrays skinned_ring() {
  LayeredArrays arrays;
  LayeredArrays::Mesh& mesh = arrays.meshes.emplace_back();
  for (uint32_t i = 0; i < kAround; ++i) {
    const float u = glm::two_pi<float>() * static_cast<float>(i) / kAround;
    for (uint32_t j = 0; j < kAcross; ++j) {
      const float v = glm::two_pi<float>() * static_cast<float>(j) / kAcross;
      const glm::vec3 ring(std::cos(u), 0, std::sin(u));
      const glm::vec3 p = ring * (1 + 0.4f * std::cos(v)) + glm::vec3(0, 0.4f * std::sin(v), 0);
      mesh.positions.push_back({p.x, p.y, p.z});
      umbrage::LayeredSkin skin;
      for (uint32_t k = 0; k < 4; ++k) {
        skin.bones[k] = static_cast<uint8_t>((i * kRingBones / kAround + k) % kRingBones);
        skin.weights[k] = 0.25f;
      }
      mesh.skin.push_back(skin);
      const uint32_t i1 = (i + 1) % kAround, j1 = (j + 1) % kAcross;
      const uint32_t a = i * kAcross + j, b = i1 * kAcross + j, c = i1 * kAcross + j1, d = i * kAcross + j1;
      mesh.indices.insert(mesh.indices.end(), {a, d, b, b, d, c});
    }
  }
  mesh.submesh.index_count = static_cast<uint32_t>(mesh.indices.size());
  arrays.instances = {{.mesh = 0, .bones = kRingBones}};
  return arrays;
}

Result<void> bend_ring(umbrage::LayeredScene& scene, uint32_t instances) {
  std::vector<umbrage::Affine> bones;
  for (uint32_t i = 0; i < kRingBones; ++i) {
    const float t = glm::two_pi<float>() * static_cast<float>(i) / kRingBones;
    bones.push_back(affine_rows(glm::translate(glm::mat4(1), {0, 0.1f * std::sin(3 * t), 0})));
  }
  for (uint32_t i = 0; i < instances; ++i)
    if (auto set = scene.set_bones(i, bones); !set) return set;
  return {};
}

void add_hidden_instances(LayeredArrays& arrays, uint32_t instances) {
  const float step = 6 * extent_of(arrays).diagonal;
  for (uint32_t i = 1; i < instances; ++i) {
    umbrage::LayeredInstance copy = arrays.instances[0];
    copy.world_from_mesh.m[7] += step * static_cast<float>(i % 2 ? (i + 1) / 2 : -static_cast<int>(i / 2));
    arrays.instances.push_back(copy);
  }
}

std::vector<umbrage::LayeredView> views_of(const LayeredArrays& arrays, uint32_t count) {
  const Extent3 extent = extent_of(arrays);
  const float distance = 1.4f * extent.diagonal;
  std::vector<umbrage::LayeredView> views;
  for (uint32_t i = 0; i < count; ++i) {
    const float angle = 2.399963f * static_cast<float>(i);
    const glm::vec3 eye =
        extent.center + distance * glm::vec3(std::cos(angle), 0.2f * std::sin(3 * angle), std::sin(angle));
    const glm::mat4 matrix = glm::perspectiveRH_ZO(0.75f, 1.0f, 0.1f * distance, 2.5f * distance) *
                             glm::lookAtRH(eye, extent.center, glm::vec3(0, 1, 0));
    views.push_back({.clip_from_world = mat4(matrix), .layer = i});
  }
  return views;
}

bool can_run(LayeredWriter writer, const umbrage::Capabilities& has) {
  switch (writer) {
    case LayeredWriter::geometry_invocations:
    case LayeredWriter::geometry_loop:
      return has.geometry_shader;
    case LayeredWriter::vertex_layer:
      return has.vertex_layer;
    case LayeredWriter::multiview:
      return has.multiview;
    case LayeredWriter::mesh:
      return has.mesh_shader;
    default:
      return true;
  }
}

LayeredBench::LayeredBench(std::unique_ptr<GpuContext> gpu) : gpu_(std::move(gpu)) {}
LayeredBench::LayeredBench(LayeredBench&&) noexcept = default;
LayeredBench& LayeredBench::operator=(LayeredBench&&) noexcept = default;
LayeredBench::~LayeredBench() = default;

Result<LayeredBench> LayeredBench::create(const std::string& device) {
  auto gpu = GpuContext::create(device, false);
  if (!gpu) return gpu.error();
  return LayeredBench(std::move(*gpu));
}

umbrage::DeviceDesc LayeredBench::device() const { return gpu_->headless().desc(); }
std::string LayeredBench::device_name() const { return std::string(gpu_->headless().name()); }
std::string LayeredBench::driver() const { return std::string(gpu_->headless().driver()); }
std::string LayeredBench::api() const {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(gpu_->physical_device(), &properties);
  return std::to_string(VK_API_VERSION_MAJOR(properties.apiVersion)) + "." +
         std::to_string(VK_API_VERSION_MINOR(properties.apiVersion));
}

Result<LayeredTimes> LayeredBench::measure(umbrage::LayeredScene& scene, const std::vector<umbrage::LayeredView>& views,
                                           LayeredJob job) {
  job.settings.views = static_cast<uint32_t>(views.size());
  job.settings.depth_format = VK_FORMAT_D16_UNORM;
  // The atlas has one layer of as many squares: the same texels, differently laid out.
  std::vector<umbrage::LayeredView> placed = views;
  LayerImagesDesc images_desc{
      .width = job.side, .height = job.side, .layers = job.settings.views, .depth_format = job.settings.depth_format};
  if (job.settings.writer == LayeredWriter::atlas) {
    const auto columns = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(views.size()))));
    const uint32_t most = std::max(1u, gpu_->limits().maxImageDimension2D / job.side);
    const uint32_t rows = (job.settings.views + columns - 1) / columns;
    if (columns > most || rows > most) return LayeredTimes{};
    images_desc.width = columns * job.side, images_desc.height = rows * job.side, images_desc.layers = 1;
    for (uint32_t i = 0; i < placed.size(); ++i)
      placed[i] = {
          .clip_from_world = views[i].clip_from_world,
          .layer = 0,
          .area = {{static_cast<int32_t>(i % columns * job.side), static_cast<int32_t>(i / columns * job.side)},
                   {job.side, job.side}}};
  }
  auto images = LayerImages::create(*gpu_, images_desc);
  if (!images) return images.error();
  auto target = umbrage::LayeredTarget::create(scene, images->target());
  if (!target) return target.error();
  auto pass = umbrage::LayeredPass::create(scene, job.settings);
  if (!pass) return pass.error();
  auto timers = GpuTimers::create(*gpu_);
  if (!timers) return timers.error();

  LayeredTimes times{.cpu_us = std::numeric_limits<double>::max()};
  std::vector<double> gpu_ms;
  constexpr uint32_t kWarmUps = 1;  // the first run compiles and touches memory
  constexpr uint32_t kLeastRepeats = 3;
  double spent_ms = 0;
  for (uint32_t run = 0; run < job.repeats + kWarmUps; ++run) {
    if (auto begun = scene.begin_frame(++serial_); !begun) return begun.error();
    auto commands = gpu_->begin();
    if (!commands) return commands.error();
    scene.record(*commands);
    timers->begin(*gpu_, *commands);
    const auto start = std::chrono::steady_clock::now();
    if (auto prepared = pass->prepare({.target = *target, .views = placed}); !prepared) return prepared.error();
    pass->record(*commands);
    const double cpu_us = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    timers->mark(*gpu_, *commands, "layered");
    if (auto done = gpu_->submit_and_wait(); !done) return done.error();
    auto read = timers->read(*gpu_);
    if (!read) return read.error();
    if (run < kWarmUps) continue;
    gpu_ms.push_back(read->frame_ms);
    times.cpu_us = std::min(times.cpu_us, cpu_us);
    spent_ms += read->frame_ms;
    if (spent_ms >= job.enough_ms && gpu_ms.size() >= kLeastRepeats) break;
  }
  std::sort(gpu_ms.begin(), gpu_ms.end());
  times.gpu_ms = gpu_ms.front();
  times.gpu_ms_spread = gpu_ms[gpu_ms.size() / 2] - gpu_ms.front();
  times.splits = pass->splits();
  times.repeats = static_cast<uint32_t>(gpu_ms.size());
  return times;
}

}  // namespace app
