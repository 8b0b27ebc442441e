#include "pair_rig.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace umbrage::test {

namespace {
constexpr uint32_t kEvaluatePairs[] =
#include "shaders/evaluate_pairs.comp.inc"
    ;

struct PairSample {
  glm::vec3 position, normal;
  float depth;
};
struct PairPush {
  VkDeviceAddress shadows, samples, visibility, clusters;
  uint32_t width, height, lights;
};

gpu::Buffer upload_samples(Gpu& gpu, const Receivers& seen) {
  std::vector<PairSample> samples;
  for (size_t i = 0; i < seen.depth.size(); ++i)
    samples.push_back({seen.positions[i], glm::vec3(seen.normals[i]), seen.depth[i]});
  return gpu.upload(samples);
}

Program make_program(SystemRig& rig) {
  const VkDescriptorSetLayout layout = rig.system().descriptor_set_layout();
  return {rig.gpu(), kEvaluatePairs, {&layout, 1}};
}
}  // namespace

DeviceMaps::DeviceMaps(SystemRig& rig) : DeviceClusters(rig), light_records(rig.lights()), views(rig.views()) {
  Gpu& gpu = rig.gpu();
  const maps::Maps& tables = rig.stages().maps;
  const auto published = tables.published();
  const uint32_t pairs = std::min(counters.pairs_found, record.pair_capacity), grid = record.receiver_grid;
  maps = gpu.download<shared::MapRecord>(tables.maps(), counters.maps);
  light_maps = gpu.download<shared::LightMaps>(*published[1], light_records.size());
  pair_requests = gpu.download<float>(tables.pair_requests(), pairs);
  pair_clusters = gpu.download<uint32_t>(rig.stages().clusters.pair_clusters(), pairs);
  pair_maps = gpu.download<uint32_t>(*published[2], pairs);
  page_bits = gpu.download<uint32_t>(tables.page_bits(), counters.page_words);
  page_first = gpu.download<uint32_t>(tables.page_first(), counters.page_words);
  projection = gpu.download<uint32_t>(tables.projection(), counters.receiver_views * shared::ProjectionSide);
  receiver_depth = gpu.download<float>(tables.receiver_depth(), counters.receiver_views * grid * grid);
}

size_t Pairs::asked() const {
  return static_cast<size_t>(std::count_if(visibility.begin(), visibility.end(), [](float v) { return v >= 0; }));
}

size_t differences(const Pairs& a, const Pairs& b) {
  EXPECT_EQ(a.visibility.size(), b.visibility.size());
  size_t count = 0;
  for (size_t i = 0; i < std::min(a.visibility.size(), b.visibility.size()); ++i)
    count += std::bit_cast<uint32_t>(a.visibility[i]) != std::bit_cast<uint32_t>(b.visibility[i]);
  return count;
}

PairRig::PairRig(Gpu& gpu, StaticSettings settings, const SeenScene& seen)
    : SystemRig(gpu, settings, settings.store),
      samples_(upload_samples(gpu, seen.seen)),
      program_(make_program(*this)) {
  add(seen.scene);
  show(seen.camera, seen.seen);
}

void PairRig::replace(const SeenScene& seen) {
  for (const InstanceId id : instance_ids) take(system().remove(id));
  for (const MeshId id : mesh_ids) take(system().remove(id));
  for (const LightId id : light_ids) take(system().remove(id));
  instance_ids.clear(), mesh_ids.clear(), light_ids.clear();
  samples_ = upload_samples(gpu(), seen.seen);
  add(seen.scene);
  show(seen.camera, seen.seen);
}

Pairs PairRig::evaluate(const FrameSettings& settings) {
  return evaluate(settings, camera().id, receivers(), samples_);
}

Pairs PairRig::evaluate(const FrameSettings& settings, CameraId id, const Receivers& seen) {
  return evaluate(settings, id, seen, upload_samples(gpu(), seen));
}

Pairs PairRig::evaluate(const FrameSettings& settings, CameraId id, const Receivers& seen, const gpu::Buffer& samples) {
  const uint32_t width = seen.width, height = seen.height, lights = static_cast<uint32_t>(light_ids.size());
  const size_t pixels = size_t(width) * height;
  const gpu::Buffer visibility =
      gpu().buffer(std::max<size_t>(pixels * lights, 1) * sizeof(float), gpu::MemoryKind::device, "visibility");
  const gpu::Buffer clusters = gpu().buffer(pixels * sizeof(uint32_t), gpu::MemoryKind::device, "clusters of pixels");
  frame(settings, [&](VkCommandBuffer commands) {
    const ShaderInterface shadows = system().shader_interface(id);
    program_.dispatch(
        commands, shadows.set,
        PairPush{shadows.frame, samples.address(), visibility.address(), clusters.address(), width, height, lights},
        (width + 7) / 8, (height + 7) / 8);
  });
  Pairs pairs{lights, gpu().download<float>(visibility, pixels * lights), gpu().download<uint32_t>(clusters, pixels),
              system().statistics()};
  pairs.statistics.passes = {};
  EXPECT_EQ(pairs.statistics.unbacked_taps, 0u);
  return pairs;
}

Pairs PairRig::settle(const FrameSettings& settings) {
  Pairs pairs = evaluate(settings);
  for (uint32_t i = 0; i < 6 && pairs.statistics.overflows > 0; ++i) pairs = evaluate(settings);
  EXPECT_EQ(pairs.statistics.overflows, 0u);
  return pairs;
}

// --- Scenes ---------------------------------------------------------------------------------------------------------------

namespace {
void number_lights(TestScene& scene) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i) scene.lights[i].host_index = i;
}

SeenScene seen_scene(std::string name, TestScene scene, const CameraDesc& camera, const Receiver& receiver) {
  number_lights(scene);
  return {std::move(name), std::move(scene), camera, picture(camera, receiver)};
}

const glm::vec3 kEye(0, 5, 16), kTarget(0, 1, 0);

/// The inside of a box around the origin.
Receiver room(const glm::vec3& centre, const glm::vec3& half_size) {
  return [=](const glm::vec3& origin, const glm::vec3& direction) -> std::optional<Surface> {
    std::optional<Surface> nearest;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      glm::vec3 normal(0);
      normal[axis] = direction[axis] > 0 ? -1.0f : 1.0f;
      const float t = (centre[axis] - normal[axis] * half_size[axis] - origin[axis]) / direction[axis];
      if (t > 0 && (!nearest || t < nearest->t)) nearest = Surface{t, normal};
    }
    return nearest;
  };
}

TestMesh degenerate_mesh() {
  TestMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0}, {0, 1e-20f, 0}, {0, 2, 1}, {0, 2, 1}, {1, 1, 0}};
  mesh.indices = {0, 0, 0, 0, 1, 2, 0, 1, 3, 4, 5, 1, 4, 5, 4, 1, 2, 6, 0, 1, 6};
  return mesh;
}

/// In a wall, on its face, on the ground, in the middle of a ball, at the camera and just beside it.
TestScene lights_in_bad_places(uint32_t seed) {
  TestScene scene = mixed_scene(30, 0, seed);
  const uint32_t wall = static_cast<uint32_t>(scene.meshes.size());
  scene.meshes.push_back(box_mesh());
  scene.instances.push_back(
      {.mesh = wall, .world_from_mesh = affine(glm::mat3(3, 0, 0, 0, 2, 0, 0, 0, 0.2f), {0, 1, -4})});
  const glm::vec3 places[] = {
      {0, 1, -4}, {0.5f, 1, -3.8f}, {1, 0, 1}, {4, 2, -3}, kEye, kEye + glm::vec3(0.01f, 0, -0.02f)};
  for (const glm::vec3& place : places) {
    scene.lights.push_back({.position = to_vec3(place), .range_m = 12});
    scene.lights.push_back({.type = LightType::spot,
                            .position = to_vec3(place),
                            .direction = {0.1f, -0.3f, -1},
                            .range_m = 20,
                            .outer_cone_rad = 0.9f});
  }
  return scene;
}
}  // namespace

SeenScene balls_scene(uint32_t instances, uint32_t lights, uint32_t seed, uint32_t width, uint32_t height) {
  return seen_scene(std::to_string(lights) + " lights on " + std::to_string(instances) + " casters",
                    mixed_scene(instances, lights, seed), perspective_camera(kEye, kTarget, width, height),
                    balls_on_ground);
}

std::vector<SeenScene> hard_scenes() {
  const CameraDesc camera = perspective_camera(kEye, kTarget, 96, 64);
  std::vector<SeenScene> all{balls_scene(20, 0, 1), balls_scene(0, 20, 2), balls_scene(20, 1, 3)};
  all.push_back(seen_scene("lights in bad places", lights_in_bad_places(4), camera, balls_on_ground));

  TestScene far = mixed_scene(20, 0, 5);
  for (const float range : {300.0f, 1e5f}) {
    far.lights.push_back({.position = {3, 4, 2}, .range_m = range});
    far.lights.push_back({.type = LightType::spot,
                          .position = {-30, 40, 2},
                          .direction = {3, -4, 0},
                          .range_m = range,
                          .outer_cone_rad = 0.4f});
    far.lights.push_back({.type = LightType::spot,
                          .position = {0, 8, 0},
                          .direction = {0, -1, 0},
                          .range_m = range,
                          .outer_cone_rad = 1.5f});
  }
  all.push_back(seen_scene("ranges beyond the scene", far, camera, balls_on_ground));

  TestScene inside = mixed_scene(20, 10, 6);
  const glm::vec3 half_size(0.9f, 0.7f, 1.1f);
  inside.instances.push_back(
      {.mesh = 1, .world_from_mesh = affine(glm::mat3(half_size.x, 0, 0, 0, half_size.y, 0, 0, 0, half_size.z), kEye)});
  inside.lights.push_back({.position = to_vec3(kEye + glm::vec3(0.3f, 0.2f, -0.4f)), .range_m = 5});
  all.push_back(seen_scene("a camera within a caster", inside, camera, room(kEye, half_size)));

  TestScene degenerate = mixed_scene(0, 12, 7);
  degenerate.meshes.push_back(degenerate_mesh());
  for (uint32_t i = 0; i < 10; ++i)
    degenerate.instances.push_back({.mesh = 3, .world_from_mesh = random_affine(i, {float(i) - 5, 1, float(i % 3)})});
  degenerate.instances.push_back(
      {.mesh = 1, .world_from_mesh = affine(glm::mat3(1, 0, 0, 0, 1e-6f, 0, 0, 0, 1), {0, 2, 0})});
  all.push_back(seen_scene("degenerate triangles", degenerate, camera, balls_on_ground));

  all.push_back(seen_scene("an orthographic camera", mixed_scene(20, 20, 8),
                           orthographic_camera(kEye, kTarget, 96, 64, 8, 50), balls_on_ground));
  return all;
}

}  // namespace umbrage::test
