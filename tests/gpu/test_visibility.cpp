// Visibility through umbrage.glsl where it is known: behind a square, on flat receivers at any slope, on a convex body.
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "system_rig.hpp"

namespace umbrage::test {
namespace {

class Visibility : public GpuTest {};

constexpr uint32_t kEvaluate[] =
#include "shaders/evaluate_visibility.comp.inc"
    ;

struct Sample {
  glm::vec3 position, normal;
  uint32_t light;  // host_index
};

constexpr const char* kKinds[] = {"point", "spot", "wide spot", "sun"};
constexpr float kRounding = 1e-6f;  // of the sum of nine weights

struct Tally {
  uint32_t lit = 0, dark = 0, wrong = 0;
  float darkest = 1;
};

/// One frame of the scene with maps of this side, and the visibility of each sample.
std::vector<float> visibility_of(Gpu& gpu, const TestScene& scene, uint32_t resolution,
                                 const std::vector<Sample>& samples) {
  struct Push {
    VkDeviceAddress shadows, samples, answers;
    uint32_t count;
  };
  SystemRig rig(gpu, {.budget_mib = 256});
  rig.add(scene);
  rig.show_nothing();
  const gpu::Buffer input = gpu.upload(samples),
                    output = gpu.buffer(samples.size() * sizeof(float), gpu::MemoryKind::device, "visibility");
  const VkDescriptorSetLayout layout = rig.system().descriptor_set_layout();
  const Program program(gpu, kEvaluate, {&layout, 1});
  rig.frame({.min_resolution = 16, .max_resolution = resolution}, [&](VkCommandBuffer commands) {
    const ShaderInterface shadows = rig.system().shader_interface(rig.camera().id);
    const auto count = static_cast<uint32_t>(samples.size());
    program.dispatch(commands, shadows.set, Push{shadows.frame, input.address(), output.address(), count},
                     (count + 63) / 64);
  });
  EXPECT_EQ(rig.map_resolution(), resolution);
  return gpu.download<float>(output, samples.size());
}

glm::mat3 random_turn(std::mt19937& engine) {
  std::normal_distribution<float> normal;
  return glm::mat3_cast(glm::normalize(glm::quat(normal(engine), normal(engine), normal(engine), normal(engine))));
}

/// A light of a kind at `position` that shines down the turned -y axis.
LightDesc light_of(uint32_t kind, const glm::mat3& turn, const glm::vec3& position, uint32_t index) {
  LightDesc light{.position = to_vec3(position),
                  .direction = to_vec3(turn * glm::vec3(0, -1, 0)),
                  .range_m = 20,
                  .host_index = index};
  if (kind == 1) light.type = LightType::spot, light.outer_cone_rad = 1.0f;
  if (kind == 2) light.type = LightType::spot, light.outer_cone_rad = 1.3f;  // as a cube
  if (kind == 3) light.type = LightType::directional;
  return light;
}

/// By how many bands of two texels a point of the floor lies outside of the square's shadow; negative: inside. A texel is
/// widest at the largest axis depth, stretches with the slope, and may lie diagonally.
float bands_outside(uint32_t kind, const glm::vec2& p, uint32_t resolution) {
  const bool sun = kind == 3;
  const float outside = std::max(std::abs(p.x), std::abs(p.y)) - (sun ? 0.5f : 1.0f);
  const float distance = std::sqrt(16 + glm::dot(p, p));
  const float tangent = kind == 1 ? shared::spot_tangent(1.0f, resolution, shared::ViewGuardTexels) : 1.0f;
  const float texel = sun ? 2 * 12 * 1.75f * 17 / 16 / float(resolution)
                          : shared::texel_size_m(distance, tangent, resolution) * distance / 4;
  return outside / (2 * std::sqrt(2.0f) * texel);
}

/// A light 4 m above a floor, a square of half side 0.5 half-way: its shadow is a square of half side 1 (0.5 under a sun).
/// Turned in any way, so that the shadow's edges cross those of cube faces.
TEST_F(Visibility, OfASquaresShadowIsExactOutsideItsEdge) {
  constexpr uint32_t kResolution = 512, kSamples = 20000, kTrials = 3;
  TestScene scene;
  scene.meshes = {plane_mesh(1)};
  std::vector<Sample> samples;
  std::vector<float> outside;
  for (uint32_t index = 0; index < 4 * kTrials; ++index) {  // each light sees its own casters only
    const uint32_t kind = index / kTrials, mask = 1u << index;
    std::mt19937 engine(index);
    const glm::mat3 turn = index % kTrials == 0 ? glm::mat3(1) : random_turn(engine);
    scene.instances.push_back(
        {.mesh = 0, .world_from_mesh = affine(turn * glm::mat3(12), turn * glm::vec3(0, -4, 0)), .light_mask = mask});
    scene.instances.push_back(
        {.mesh = 0, .world_from_mesh = affine(turn * glm::mat3(0.5f), turn * glm::vec3(0, -2, 0)), .light_mask = mask});
    scene.lights.push_back(light_of(kind, turn, {0, 0, 0}, index));
    scene.lights.back().light_mask = mask;
    std::uniform_real_distribution<float> place(-3, 3);
    while (samples.size() < (index + 1) * kSamples) {
      const glm::vec2 p(place(engine), place(engine));
      if (kind == 1 && glm::length(p) > 4 * std::tan(1.0f)) continue;
      outside.push_back(bands_outside(kind, p, kResolution));
      samples.push_back({turn * glm::vec3(p.x, -4, p.y), turn * glm::vec3(0, 1, 0), index});
    }
  }
  const std::vector<float> visibility = visibility_of(gpu(), scene, kResolution, samples);
  std::array<Tally, 4> tallies;
  for (uint32_t i = 0; i < samples.size(); ++i) {
    if (std::abs(outside[i]) < 1) continue;
    Tally& tally = tallies[samples[i].light / kTrials];
    (outside[i] < 0 ? tally.dark : tally.lit)++;
    tally.wrong += std::abs(visibility[i] - (outside[i] < 0 ? 0.0f : 1.0f)) > kRounding;
  }
  for (uint32_t kind = 0; kind < 4; ++kind) {
    const Tally& tally = tallies[kind];
    EXPECT_EQ(tally.wrong, 0u) << kKinds[kind] << ", of " << tally.lit << " lit and " << tally.dark << " dark points";
    EXPECT_GT(tally.lit, kSamples);
    EXPECT_GT(tally.dark, kSamples / 100);
  }
}

constexpr std::array<float, 7> kSlopes{0, 20, 45, 60, 75, 80, 85};

/// A plane 3 m down a light's direction, whose normal makes an angle with that direction; and points on it.
void add_slope(const glm::vec3& origin, uint32_t index, TestScene& scene, std::vector<Sample>& samples) {
  const auto kind = static_cast<uint32_t>(index / kSlopes.size());
  const uint32_t mask = 1u << index;
  std::mt19937 engine(index);
  const glm::mat3 turn = random_turn(engine);
  const float angle = glm::radians(kSlopes[index % kSlopes.size()]);
  const glm::vec3 down = turn * glm::vec3(0, -1, 0), along = turn * glm::vec3(1, 0, 0),
                  side = turn * glm::vec3(0, 0, 1);
  const glm::vec3 normal = glm::normalize(-down * std::cos(angle) + along * std::sin(angle)),
                  up = glm::cross(normal, side);
  const glm::vec3 foot = origin + down * 3.0f;
  scene.instances.push_back(
      {.mesh = 0, .world_from_mesh = affine(glm::mat3(up, normal, side) * 6.0f, foot), .light_mask = mask});
  scene.lights.push_back(light_of(kind, turn, origin, index));
  scene.lights.back().light_mask = mask;
  std::uniform_real_distribution<float> place(-5.9f, 5.9f);
  for (const size_t end = samples.size() + 3000; samples.size() < end;) {
    const glm::vec3 at = foot + up * place(engine) + side * place(engine);
    const glm::vec3 to_light = kind == 3 ? -down : glm::normalize(origin - at);
    if (glm::dot(normal, to_light) < std::cos(glm::radians(86.0f))) continue;
    if (kind == 1 && glm::dot(-to_light, down) < std::cos(1.0f)) continue;
    samples.push_back({at, normal, index});
  }
}

/// The same with world positions in meshes of their own, as whole levels come.
TestScene baked(const TestScene& scene) {
  TestScene out{.lights = scene.lights};
  for (const TestInstance& instance : scene.instances) {
    TestMesh mesh = scene.meshes[instance.mesh];
    for (Vec3& position : mesh.positions) position = to_vec3(transform(instance.world_from_mesh, position));
    out.instances.push_back({.mesh = static_cast<uint32_t>(out.meshes.size()), .light_mask = instance.light_mask});
    out.meshes.push_back(std::move(mesh));
  }
  return out;
}

/// Nothing is there but the receiver itself.
TEST_F(Visibility, OfFlatReceiversIsFullAtAnySlope) {
  for (const glm::vec3& origin : {glm::vec3(0), glm::vec3(2000, -20, -3000)}) {
    TestScene scene;
    scene.meshes = {plane_mesh(8)};
    std::vector<Sample> samples;
    for (uint32_t index = 0; index < 4 * kSlopes.size(); ++index) add_slope(origin, index, scene, samples);
    if (origin.x > 0) scene = baked(scene);
    for (const uint32_t resolution : {16u, 64u, 256u}) {
      const std::vector<float> visibility = visibility_of(gpu(), scene, resolution, samples);
      std::array<Tally, 4 * kSlopes.size()> tallies;
      for (uint32_t i = 0; i < samples.size(); ++i) {
        Tally& tally = tallies[samples[i].light];
        ++tally.lit;
        tally.wrong += visibility[i] < 1 - kRounding;
        tally.darkest = std::min(tally.darkest, visibility[i]);
      }
      for (uint32_t index = 0; index < tallies.size(); ++index)
        EXPECT_EQ(tallies[index].wrong, 0u)
            << kKinds[index / kSlopes.size()] << " at " << kSlopes[index % kSlopes.size()] << " degrees, " << resolution
            << " texels, " << origin.x << " m off: of " << tallies[index].lit << ", darkest " << tallies[index].darkest;
    }
  }
}

/// A light in the plane of a wall's face, but for so little, and a block that stands on the wall between it and most of the
/// face: taps behind the face hardly leave the light and see nothing, so that only those before it may answer.
TEST_F(Visibility, OfAPlaneThatHoldsTheLightIsThatInFrontOfIt) {
  TestScene scene;
  scene.meshes = {plane_mesh(4)};
  std::vector<Sample> samples;
  const std::array<float, 4> heights_m{1e-6f, 1e-4f, 1e-3f, 1e-2f};  // of the light above the face
  for (uint32_t index = 0; index < 2 * heights_m.size(); ++index) {
    const uint32_t kind = index % 2, mask = 1u << index;
    std::mt19937 engine(index);
    const glm::mat3 turn = index < 2 ? glm::mat3(1) : random_turn(engine);
    // The wall's face is y = 0; the block is the square x = 2, -1 <= y, z <= 1.
    const glm::mat3 stand(glm::vec3(0, 1, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 0, 1));
    scene.instances.push_back(
        {.mesh = 0, .world_from_mesh = affine(turn * glm::mat3(8), glm::vec3(0)), .light_mask = mask});
    scene.instances.push_back(
        {.mesh = 0, .world_from_mesh = affine(turn * stand, turn * glm::vec3(2, 0, 0)), .light_mask = mask});
    LightDesc light = light_of(kind, turn, turn * glm::vec3(0, heights_m[index / 2], 0), index);
    light.direction = to_vec3(turn * glm::vec3(1, 0, 0));
    light.light_mask = mask;
    scene.lights.push_back(light);
    std::uniform_real_distribution<float> far(4, 7), side(-0.25f, 0.25f);
    for (uint32_t i = 0; i < 1000; ++i) {
      const float x = far(engine);
      samples.push_back({turn * glm::vec3(x, 0, x * side(engine)), turn * glm::vec3(0, 1, 0), index});
    }
  }
  for (const uint32_t resolution : {64u, 256u}) {
    const std::vector<float> visibility = visibility_of(gpu(), scene, resolution, samples);
    uint32_t wrong = 0;
    for (const float v : visibility) wrong += v >= 0.5f;
    EXPECT_LE(wrong, samples.size() / 100) << resolution << " texels, of " << samples.size();
  }
}

/// Every triangle of a convex body that faces the light is lit.
TEST_F(Visibility, OfAFineSphereIsFullWhereItFacesTheLight) {
  const TestMesh sphere = sphere_mesh(96, 160);
  TestScene scene;
  scene.meshes = {sphere};
  std::vector<Sample> samples;
  std::array<Tally, 4> tallies;
  for (uint32_t kind = 0; kind < 4; ++kind) {
    std::mt19937 engine(kind);
    const glm::mat3 turn = random_turn(engine);
    const glm::vec3 centre = turn * glm::vec3(0, -4, 0);
    scene.instances.push_back({.mesh = 0, .world_from_mesh = affine(turn, centre), .light_mask = 1u << kind});
    scene.lights.push_back(light_of(kind, turn, {0, 0, 0}, kind));
    scene.lights.back().light_mask = 1u << kind;
    std::uniform_real_distribution<float> unit(0, 1);
    for (size_t i = 0; i < sphere.indices.size(); i += 3) {
      glm::vec3 p[3];
      for (size_t k = 0; k < 3; ++k)
        p[k] = transform(scene.instances[kind].world_from_mesh, sphere.positions[sphere.indices[i + k]]);
      float u = unit(engine), v = unit(engine);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const glm::vec3 at = p[0] + (p[1] - p[0]) * u + (p[2] - p[0]) * v;
      glm::vec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
      if (glm::dot(normal, at - centre) < 0) normal = -normal;
      const glm::vec3 to_light = kind == 3 ? turn * glm::vec3(0, 1, 0) : glm::normalize(-at);
      if (glm::dot(normal, to_light) > 0) samples.push_back({at, normal, kind});
    }
  }
  for (const uint32_t resolution : {64u, 512u}) {
    const std::vector<float> visibility = visibility_of(gpu(), scene, resolution, samples);
    tallies.fill({});
    for (uint32_t i = 0; i < samples.size(); ++i) {
      ++tallies[samples[i].light].lit;
      tallies[samples[i].light].wrong += visibility[i] < 0.5f;
    }
    for (uint32_t kind = 0; kind < 4; ++kind)
      EXPECT_LE(tallies[kind].wrong, tallies[kind].lit / 1000)
          << kKinds[kind] << ", " << resolution << " texels, of " << tallies[kind].lit;
  }
}

}  // namespace
}  // namespace umbrage::test
