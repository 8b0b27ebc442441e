// Cascades in the whole system: what umbrage_visibility answers from them where the answer is known, beside local lights, in every
// mode and while the camera moves.
#include <array>
#include <cmath>
#include <random>

#include "system_rig.hpp"

namespace umbrage::test {
namespace {

class CascadeLookups : public GpuTest {};

constexpr uint32_t kEvaluate[] =
#include "shaders/evaluate_visibility.comp.inc"
    ;
constexpr CascadeMode kModes[] = {CascadeMode::redraw, CascadeMode::cached, CascadeMode::scrolled,
                                  CascadeMode::guard_band};

struct Sample {
  glm::vec3 position, normal;
  uint32_t light;  // host_index
};

/// A system with a camera that the test moves, and samples of visibility.
class LookupRig {
 public:
  LookupRig(Gpu& gpu, const TestScene& scene, std::vector<Sample> samples)
      : gpu_(gpu),
        rig_(gpu, {.budget_mib = 16}, Store::page_pool),
        samples_(std::move(samples)),
        input_(gpu.upload(samples_)),
        output_(gpu.buffer(samples_.size() * sizeof(float), gpu::MemoryKind::device, "visibility")),
        layout_(rig_.system().descriptor_set_layout()),
        program_(gpu, kEvaluate, {&layout_, 1}) {
    rig_.add(scene);
    rig_.show_nothing();
  }
  SystemRig& rig() { return rig_; }
  std::vector<float> frame(const glm::vec3& eye, const glm::vec3& target, const FrameSettings& settings) {
    const CameraDesc camera = perspective_camera(eye, target, rig_.camera().width, rig_.camera().height);
    rig_.camera().view_from_world = camera.view_from_world;
    rig_.camera().clip_from_view = camera.clip_from_view;
    rig_.frame(settings, [&](VkCommandBuffer commands) {
      struct Push {
        VkDeviceAddress shadows, samples, answers;
        uint32_t count;
      };
      const ShaderInterface shadows = rig_.system().shader_interface(rig_.camera().id);
      const auto count = static_cast<uint32_t>(samples_.size());
      program_.dispatch(commands, shadows.set, Push{shadows.frame, input_.address(), output_.address(), count},
                        (count + 63) / 64);
    });
    return gpu_.download<float>(output_, samples_.size());
  }

 private:
  Gpu& gpu_;
  SystemRig rig_;
  std::vector<Sample> samples_;
  gpu::Buffer input_, output_;
  VkDescriptorSetLayout layout_;
  Program program_;
};

FrameSettings settings_of(CascadeMode mode) {
  FrameSettings settings;
  settings.cascades = mode;
  settings.cascade_count = 3;
  settings.cascade_distance_m = 30;
  settings.cascade_reach_m = 30;
  settings.static_after_ms = 3;
  return settings;
}

constexpr float kHeight = 2;  // of the square above the floor

/// A floor, a square of half side 0.5 above it, a sun that shines down.
TestScene square_scene() {
  TestScene scene;
  scene.meshes = {plane_mesh(1)};
  scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(40), {0, 0, 0}), .mobility = Mobility::fixed},
                     {.mesh = 0, .world_from_mesh = affine(glm::mat3(0.5f), {0, kHeight, 0})}};
  scene.lights = {{.type = LightType::directional, .direction = {0, -1, 0}, .host_index = 5}};
  return scene;
}

std::vector<Sample> floor_samples(float reach, uint32_t count) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> place(-reach, reach);
  std::vector<Sample> samples(count);
  for (Sample& sample : samples) sample = {{place(engine), 0, place(engine)}, {0, 1, 0}, 5};
  return samples;
}

TEST_F(CascadeLookups, OfASquaresShadowAreExactOutsideItsEdge) {
  const std::vector<Sample> samples = floor_samples(2, 4000);
  for (const CascadeMode mode : kModes) {
    LookupRig lookups(gpu(), square_scene(), samples);
    for (int i = 0; i < 8; ++i) {
      const auto at = static_cast<float>(i);
      const std::vector<float> visibility =
          lookups.frame({0.31f * at - 1, 3 - 0.1f * at, 5 + 0.2f * at}, {0, 0, 0}, settings_of(mode));
      const auto cascades = lookups.rig().system().statistics().cascades;
      ASSERT_EQ(cascades.size(), 3u);
      const float band = 3 * cascades[2].texel_m;
      ASSERT_LT(band, 0.4f);
      size_t lit = 0, dark = 0, wrong = 0;
      for (size_t k = 0; k < samples.size(); ++k) {
        const float outside = std::max(std::abs(samples[k].position.x), std::abs(samples[k].position.z)) - 0.5f;
        if (std::abs(outside) < band) continue;
        (outside < 0 ? dark : lit)++;
        wrong += std::abs(visibility[k] - (outside < 0 ? 0.0f : 1.0f)) > 1e-6f;
      }
      EXPECT_EQ(wrong, 0u) << "mode " << static_cast<int>(mode) << ", frame " << i << ", of " << lit << " lit and "
                           << dark << " dark";
      EXPECT_GT(dark, 20u);
    }
  }
}

TEST_F(CascadeLookups, AreTheSameInEveryMode) {
  const std::vector<Sample> samples = floor_samples(8, 4000);
  std::array<std::vector<std::vector<float>>, 3> answers;
  TestScene scene = mixed_scene(60, 0, 3);
  scene.lights = {{.type = LightType::directional, .direction = {0.4f, -1, 0.3f}, .host_index = 5}};
  for (size_t m = 0; m < 3; ++m) {  // guard bands have other texels
    LookupRig lookups(gpu(), scene, samples);
    for (int i = 0; i < 8; ++i) {
      const Affine to = affine(glm::mat3(0.4f), {0.1f * static_cast<float>(i), 1.5f, 0});
      if (i < 4) take(lookups.rig().system().set_transforms({&lookups.rig().instance_ids[2], 1}, {&to, 1}));
      answers[m].push_back(lookups.frame({0.3f * static_cast<float>(i), 3, 8}, {0, 0, 0}, settings_of(kModes[m])));
    }
  }
  EXPECT_EQ(answers[0], answers[1]);
  EXPECT_EQ(answers[0], answers[2]);
}

TEST_F(CascadeLookups, FlatReceiversDoNotShadowThemselvesAtAnySlope) {
  TestScene scene;
  scene.meshes = {plane_mesh(1)};
  std::vector<Sample> samples;
  std::mt19937 engine(4);
  std::uniform_real_distribution<float> place(-2, 2);
  const std::array<float, 6> slopes{0, 20, 45, 60, 75, 80};
  for (size_t i = 0; i < slopes.size(); ++i) {
    const float angle = glm::radians(slopes[i]);
    const glm::vec3 normal(std::sin(angle), std::cos(angle), 0), along(std::cos(angle), -std::sin(angle), 0),
        middle(static_cast<float>(i) * 6 - 15, 0, -4);
    scene.instances.push_back(
        {.mesh = 0, .world_from_mesh = affine(glm::mat3(along, normal, glm::vec3(0, 0, 1)) * 2.2f, middle)});
    for (int k = 0; k < 2000; ++k)
      samples.push_back({middle + along * place(engine) + glm::vec3(0, 0, place(engine)), normal, 5});
  }
  scene.lights = {{.type = LightType::directional, .direction = {0, -1, 0}, .host_index = 5}};
  for (const CascadeMode mode : {CascadeMode::redraw, CascadeMode::scrolled}) {
    LookupRig lookups(gpu(), scene, samples);
    for (int i = 0; i < 3; ++i) {
      const std::vector<float> visibility =
          lookups.frame({0.4f * static_cast<float>(i), 4, 12}, {0, 0, -4}, settings_of(mode));
      size_t dark = 0;
      for (const float v : visibility) dark += v < 1 - 1e-6f;
      EXPECT_EQ(dark, 0u);
    }
  }
}

TEST_F(CascadeLookups, LeaveLocalLightsToTheStoreAndSunsBeyondTheTableToo) {
  TestScene scene = square_scene();
  for (uint32_t i = 0; i < 9; ++i)
    scene.lights.push_back(
        {.type = LightType::directional, .direction = {0.1f * static_cast<float>(i), -1, 0}, .host_index = 20 + i});
  scene.lights.push_back({.position = {0, 4, 0}, .range_m = 10, .host_index = 7});
  std::vector<Sample> samples = floor_samples(1.5f, 300);
  const size_t each = samples.size();
  for (const uint32_t light : {7u, 28u})
    for (size_t i = 0; i < each; ++i) samples.push_back({samples[i].position, samples[i].normal, light});
  LookupRig lookups(gpu(), scene, samples);
  FrameSettings settings = settings_of(CascadeMode::scrolled);
  settings.cascade_count = 8;  // eight suns of ten
  settings.cascade_resolution = 256;
  std::vector<float> visibility;
  for (int i = 0; i < 2; ++i) visibility = lookups.frame({0, 3, 5}, {0, 0, 0}, settings);
  EXPECT_EQ(lookups.rig().system().statistics().cascades.size(), 64u);
  uint32_t in_store = 0;
  for (const shared::LightRecord& light : lookups.rig().lights()) in_store += light.view_count > 0;
  EXPECT_EQ(in_store, 3u);
  for (size_t light = 0; light < 3; ++light) {
    size_t lit = 0, dark = 0;
    for (size_t i = 0; i < each; ++i) (visibility[light * each + i] > 0.5f ? lit : dark)++;
    EXPECT_GT(lit, each / 8) << light;
    if (light < 2) {  // the store's map of a sun over 80 m of floor is too coarse for the square
      EXPECT_GT(dark, each / 20) << light;
    }
  }
}

TEST_F(CascadeLookups, FadeIntoLightAtTheEnd) {
  std::vector<Sample> samples;
  for (int i = 0; i < 400; ++i) samples.push_back({{0, 0, -0.1f * static_cast<float>(i)}, {0, 1, 0}, 5});
  TestScene scene;
  scene.meshes = {plane_mesh(1)};
  scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(90), {0, 0, 0})},
                     {.mesh = 0, .world_from_mesh = affine(glm::mat3(80), {0, 3, 0})}};
  scene.lights = {{.type = LightType::directional, .direction = {0, -1, 0}, .host_index = 5}};
  LookupRig lookups(gpu(), scene, samples);
  const std::vector<float> visibility = lookups.frame({0, 1, 0}, {0, 1, -1}, settings_of(CascadeMode::redraw));
  const float end_m = lookups.rig().system().statistics().cascades[2].end_m;
  EXPECT_EQ(end_m, 30);
  size_t partly = 0;
  for (size_t i = 1; i < samples.size(); ++i) {
    const float t = -samples[i].position.z;
    EXPECT_GE(visibility[i], visibility[i - 1]);
    if (t < 25) {
      EXPECT_EQ(visibility[i], 0) << t;
    } else if (t > end_m) {
      EXPECT_EQ(visibility[i], 1) << t;
    } else {
      partly += visibility[i] > 0 && visibility[i] < 1;
    }
  }
  EXPECT_GT(partly, 5u);
}

TEST_F(CascadeLookups, StayRightWhenSwitchedOffAndOnAndResized) {
  const std::vector<Sample> samples = floor_samples(2, 1500);
  LookupRig lookups(gpu(), square_scene(), samples), fresh(gpu(), square_scene(), samples);
  std::mt19937 engine(8);
  for (int i = 0; i < 24; ++i) {
    FrameSettings settings = settings_of(CascadeMode::scrolled);
    if (i % 5 == 3) settings.cascades = CascadeMode::none;
    if (i > 12) settings.cascade_resolution = 256;
    if (i > 16) settings.cascade_count = 2;
    const auto at = static_cast<float>(i);
    const glm::vec3 eye(0.2f * at - 2, 3, 5);
    const Affine to = affine(glm::mat3(0.5f), {0.3f * std::sin(at), kHeight, 0});
    if (engine() % 3 == 0)
      for (LookupRig* rig : {&lookups, &fresh})
        take(rig->rig().system().set_transforms({&rig->rig().instance_ids[1], 1}, {&to, 1}));
    const std::vector<float> have = lookups.frame(eye, {0, 0, 0}, settings);
    if (settings.cascades != CascadeMode::none) settings.cascades = CascadeMode::redraw;
    EXPECT_EQ(have, fresh.frame(eye, {0, 0, 0}, settings)) << i;
    EXPECT_EQ(lookups.rig().record().cascades != 0, settings.cascades != CascadeMode::none);
  }
}

}  // namespace
}  // namespace umbrage::test
