#include "system_rig.hpp"

#include <cstring>

namespace umbrage::test {

namespace {
constexpr uint32_t kReadAtlas[] =
#include "shaders/read_atlas.comp.inc"
    ;
constexpr uint32_t kMaskSide = 16;

struct ReadAtlasPush {
  VkDeviceAddress target;
  uint32_t width, height;
};
}  // namespace

namespace {
StaticSettings with(StaticSettings settings, Store store) {
  settings.store = store;
  return settings;
}
}  // namespace

SystemRig::SystemRig(Gpu& gpu, const StaticSettings& settings, Store store)
    : gpu_(gpu),
      system_(take(ShadowSystem::create(gpu.desc(), with(settings, store)))),
      mask_(gpu, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, kMaskSide, kMaskSide) {
  std::vector<uint32_t> checkers(kMaskSide * kMaskSide);
  for (uint32_t i = 0; i < checkers.size(); ++i)
    checkers[i] = (i / 4 + i / kMaskSide / 4) % 2 ? 0xffffffffu : 0x00ffffffu;
  gpu.fill(mask_, checkers.data(), checkers.size() * sizeof(uint32_t), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  mask_id_ = take(system_.add_mask(mask_.view()));
}

MeshId SystemRig::add(const TestMesh& mesh) {
  std::vector<Submesh> submeshes = mesh.submeshes;
  if (submeshes.empty()) submeshes.push_back({.index_count = static_cast<uint32_t>(mesh.indices.size())});
  for (Submesh& submesh : submeshes)
    if (!mesh.uvs.empty()) submesh.mask = mask_id_;
  const MeshDesc desc{.positions = mesh.positions,
                      .indices = mesh.indices,
                      .uvs = mesh.uvs,
                      .submeshes = submeshes,
                      .level_errors_m = mesh.level_errors_m};
  mesh_ids.push_back(take(system_.add_mesh(desc)));
  return mesh_ids.back();
}

InstanceId SystemRig::add(const TestInstance& instance) {
  instance_ids.push_back(take(system_.add_instance({.mesh = mesh_ids[instance.mesh],
                                                    .world_from_mesh = instance.world_from_mesh,
                                                    .mobility = instance.mobility,
                                                    .light_mask = instance.light_mask,
                                                    .casts = instance.casts})));
  return instance_ids.back();
}

void SystemRig::add(const TestScene& scene) {
  for (const TestMesh& mesh : scene.meshes) add(mesh);
  for (const TestInstance& instance : scene.instances) add(instance);
  for (const LightDesc& light : scene.lights) light_ids.push_back(take(system_.add_light(light)));
}

SystemRig::Picture SystemRig::fill_picture(CameraDesc& camera, const Receivers& receivers) {
  Picture made{
      std::make_unique<Image>(gpu_, VK_FORMAT_D32_SFLOAT, VK_IMAGE_ASPECT_DEPTH_BIT, camera.width, camera.height),
      std::make_unique<Image>(gpu_, VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT, camera.width,
                              camera.height)};
  gpu_.fill(*made.depth, receivers.depth.data(), receivers.depth.size() * sizeof(float), camera.depth_layout);
  gpu_.fill(*made.normals, receivers.normals.data(), receivers.normals.size() * sizeof(glm::vec4),
            camera.normal_layout);
  camera.depth = made.depth->view();
  if (camera.normal_encoding != NormalEncoding::none) camera.normal = made.normals->view();
  return made;
}

void SystemRig::show(const CameraDesc& camera, const Receivers& receivers) {
  camera_ = camera;
  receivers_ = receivers;
  picture_ = fill_picture(camera_, receivers);
}

void SystemRig::show_also(const CameraDesc& camera, const Receivers& receivers) {
  cameras_.push_back(camera);
  other_pictures_.push_back(fill_picture(cameras_.back(), receivers));
}

void SystemRig::show_nothing() {
  CameraDesc camera = perspective_camera({0, 3, 10}, {0, 0, 0}, 32, 32);
  camera.other_receivers = true;
  show(camera, picture(camera, [](const glm::vec3&, const glm::vec3&) { return std::nullopt; }));
}

FrameDesc SystemRig::describe(const FrameSettings& settings) {
  cameras_[0] = camera_;
  ++serial_;
  return {.serial = serial_, .completed_serial = serial_ - 1, .settings = settings, .cameras = cameras_};
}

void SystemRig::frame(const FrameSettings& settings, const std::function<void(VkCommandBuffer)>& after,
                      VkPipelineStageFlags2 consumers) {
  FrameDesc desc = describe(settings);
  if (consumers) desc.consumer_stages = consumers;
  take(system_.begin_frame(desc));
  const auto record_rest = [&](VkCommandBuffer commands) {
    system_.record_shadows(commands);
    if (after) after(commands);
  };
  if (system_.binds_pages()) {
    gpu_.run([&](VkCommandBuffer commands) {
      system_.record_scene(commands);
      system_.record_requests(commands);
    });
    take(system_.bind_pages({.queue = gpu_.queue()}));
    gpu_.run(record_rest);
  } else {
    gpu_.run([&](VkCommandBuffer commands) {
      system_.record_scene(commands);
      record_rest(commands);
    });
  }
  system_.collect(desc.serial);
}

Atlas SystemRig::atlas() {
  const gpu::Image& image = stages().store.atlas();
  Atlas out{image.width(), image.height(), {}};
  const size_t texels = size_t(out.width) * out.height;
  const gpu::Buffer target = gpu_.buffer(texels * sizeof(float), gpu::MemoryKind::device, "atlas texels");
  const VkDescriptorSetLayout layout = system_.descriptor_set_layout();
  const Program program(gpu_, kReadAtlas, {&layout, 1});
  gpu_.run([&](VkCommandBuffer commands) {
    program.dispatch(commands, system_.shader_interface(camera_.id).set,
                     ReadAtlasPush{target.address(), out.width, out.height}, (out.width + 15) / 16,
                     (out.height + 15) / 16);
  });
  out.depth = gpu_.download<float>(target, texels);
  return out;
}

std::vector<shared::ShadowView> SystemRig::views() {
  return gpu_.download<shared::ShadowView>(stages().views.buffer(), state().views);
}
std::vector<shared::LightRecord> SystemRig::lights() {
  return gpu_.download<shared::LightRecord>(stages().scene.light_buffer(), stages().scene.light_slots());
}
std::vector<uint32_t> SystemRig::used_lights() {
  return gpu_.download<uint32_t>(stages().clusters.used_lights(), stages().scene.light_slots());
}

}  // namespace umbrage::test
