// The frame of the sample host, pass by pass; umbrage's three calls stand between the host's own.
#include "host/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <optional>

#include "host/deform.hpp"
#include "host/draw_list.hpp"
#include "host/gpu_timers.hpp"
#include "host/post.hpp"
#include "host/read_back.hpp"
#include "host/reflection_cube.hpp"
#include "host/shade.hpp"
#include "host/shadow_scene.hpp"
#include "host/show.hpp"

namespace app {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

/// Members are destroyed from the last to the first: the device goes last.
struct Renderer::State {
  std::unique_ptr<GpuContext> gpu;
  TextureTable textures;
  SceneBuffers buffers;
  std::vector<SceneItem> items;
  Targets targets;
  Deformer deformer;
  DrawList draws;
  FrameData data;
  std::unique_ptr<ShadowScene> shadows;
  std::unique_ptr<ReflectionCube> reflection;  ///< Null: there is no mirror ball.
  Handle<VkPipelineLayout> layout;
  GpuTimers timers;
  GBufferPass gbuffer;
  ShadePass shade;
  PostPass post;
  ShowPass show;
  ReadBack read_back;
  std::optional<umbrage::NeededTriangles> oracle;
  uint32_t budget_mib = 0;
  uint64_t serial = 0;     ///< Of the last frame that was begun.
  uint64_t completed = 0;  ///< Of the last frame that the device has finished.
  double first_part_ms =
      0;  ///< Where pages are bound within the frame: from submitting what leads there until they are.
  uint32_t light_count = 0;

  Result<void> create_scene(const RendererDesc&, const Scene&, const Pose&);
  Result<void> create_reflection(const RendererDesc&, const Scene&, const Pose&);
  Result<void> create_passes(uint32_t max_lights);
  Result<void> begin_frame(const FrameInput&, const CameraMatrices&);
  Result<void> record(VkCommandBuffer, const FrameInput&, const CameraMatrices&);
  Result<VkCommandBuffer> bind_pages(VkCommandBuffer);
  void record_reflection(VkCommandBuffer);
  void bind_sets(VkCommandBuffer, VkDescriptorSet umbrage_set) const;
  Result<FrameReport> report() const;
  Result<PassContext> begin_reading();
  PassContext pass_context(VkCommandBuffer commands) {
    PassContext pass{*gpu, commands, layout.get(), targets, {}};
    pass.push.frame = data.address();
    return pass;
  }
};

namespace {

/// Moves a result's value into place, or hands on its error.
template <class T>
Result<void> take(Result<T> result, T& place) {
  if (!result) return result.error();
  place = std::move(result).value();
  return {};
}

/// CameraId of the first face of the mirror's cube map; the picture's own is 1.
constexpr uint32_t kFirstFace = 2;

/// Passes that run several times in a frame count together.
void add_pass(std::vector<std::pair<std::string, double>>& passes, const umbrage::PassTime& pass) {
  const auto found = std::find_if(passes.begin(), passes.end(), [&](const auto& p) { return p.first == pass.name; });
  if (found != passes.end()) {
    found->second += pass.gpu_ms;
  } else {
    passes.emplace_back(pass.name, pass.gpu_ms);
  }
}

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(const RendererDesc& desc, const Scene& scene) {
  auto state = std::make_unique<State>();
  auto gpu = GpuContext::create(desc.device, desc.validate);
  if (!gpu) return gpu.error();
  state->gpu = std::move(gpu).value();
  if (auto made = take(Targets::create(*state->gpu, desc.width, desc.height), state->targets); !made)
    return made.error();
  state->budget_mib = desc.settings.fixed.budget_mib;
  if (auto made = take(ShadowScene::create(*state->gpu, desc.settings.fixed), state->shadows); !made)
    return made.error();
  state->gpu->shadow_store = state->shadows->system().shader_store();
  if (auto made = state->create_scene(desc, scene, pose(scene, 0.0)); !made) return made.error();
  if (auto made = state->create_passes(desc.max_lights); !made) return made.error();
  if (auto made = state->create_reflection(desc, scene, pose(scene, 0.0)); !made) return made.error();
  return Renderer(std::move(state));
}

Result<void> Renderer::State::create_scene(const RendererDesc& desc, const Scene& scene, const Pose& first_pose) {
  if (auto made = take(TextureTable::create(*gpu, scene), textures); !made) return made;
  const VkDescriptorSetLayout sets[] = {textures.set().layout(), targets.set().layout(),
                                        shadows->system().descriptor_set_layout()};
  if (auto made = take(create_pipeline_layout(*gpu, sets), layout); !made) return made;
  if (auto made = take(SceneBuffers::create(*gpu, scene, textures), buffers); !made) return made;
  items = list_items(scene, first_pose, buffers);
  if (auto made = take(Deformer::create(*gpu, layout.get(), first_pose, buffers, items), deformer); !made) return made;
  if (auto made = take(DrawList::create(*gpu, scene, buffers, first_pose, items), draws); !made) return made;
  const SceneExtent extent = measure_extent(first_pose, buffers, items);
  if (auto made = take(FrameData::create(*gpu, desc.max_lights, extent), data); !made) return made;
  return shadows->add_scene({scene, first_pose, buffers, textures, items}, desc.batch_cache_dir,
                            desc.settings.fixed.batch_triangles);
}

Result<void> Renderer::State::create_reflection(const RendererDesc& desc, const Scene& scene, const Pose& first_pose) {
  if (!desc.mirror) return {};
  if (desc.settings.fixed.store != umbrage::Store::page_pool)
    return Error{ErrorCode::unsupported, "the mirror ball is lit by maps in the page pool: choose store=page_pool"};
  const SceneExtent& extent = data.extent();
  const float diagonal_m = glm::length(extent.highest - extent.lowest);
  auto made = take(ReflectionCube::create(*gpu, scene, first_pose, textures, *desc.mirror, diagonal_m), reflection);
  if (!made) return made;
  targets.set_reflection(*gpu, reflection->image());
  data.frame().mirror_ball = glm::vec4(desc.mirror->center, desc.mirror->radius);
  return {};
}

Result<void> Renderer::State::create_passes(uint32_t max_lights) {
  if (auto made = take(GpuTimers::create(*gpu), timers); !made) return made;
  if (auto made = take(GBufferPass::create(*gpu, layout.get(), targets, draws), gbuffer); !made) return made;
  if (auto made = take(ShadePass::create(*gpu, layout.get(), targets), shade); !made) return made;
  if (auto made = take(PostPass::create(*gpu, layout.get()), post); !made) return made;
  if (auto made = take(ShowPass::create(*gpu, layout.get(), targets, max_lights), show); !made) return made;
  return take(ReadBack::create(*gpu, layout.get()), read_back);
}

Result<void> Renderer::State::begin_frame(const FrameInput& input, const CameraMatrices& camera) {
  if (auto set = data.set_lights(input.lights); !set) return set;
  draws.update(*input.pose, items);
  draws.select(camera);
  const std::span<const uint32_t> deformed = deformer.update(*input.pose, items);
  if (auto updated = shadows->update(*input.pose, items, deformed); !updated) return updated;
  if (auto set = shadows->set_lights(input.lights); !set) return set;

  // The picture's camera, and the faces of the mirror's cube map: what they see is marked alike.
  std::array<umbrage::CameraDesc, 1 + ReflectionCube::kFaces> cameras;
  cameras[0] = umbrage_camera(camera, targets, draws.blended_places());
  size_t camera_count = 1;
  if (reflection) {
    const auto faces = reflection->cameras(kFirstFace);
    std::copy(faces.begin(), faces.end(), cameras.begin() + 1);
    camera_count += faces.size();
    if (auto begun = reflection->begin_frame(*input.pose, serial + 1); !begun) return begun;
  }
  umbrage::FrameDesc frame;
  frame.serial = serial + 1;
  frame.completed_serial = completed;
  frame.settings = input.settings;
  frame.time_s = input.time_s;
  frame.cameras = {cameras.data(), camera_count};
  frame.consumer_stages = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  if (auto begun = shadows->system().begin_frame(frame); !begun) return begun;
  serial = frame.serial;
  light_count = static_cast<uint32_t>(input.lights.size());
  return {};
}

void Renderer::State::bind_sets(VkCommandBuffer commands, VkDescriptorSet umbrage_set) const {
  const VkDescriptorSet sets[] = {textures.set().get(), targets.set().get(), umbrage_set};
  const uint32_t count = umbrage_set == VK_NULL_HANDLE ? 2 : 3;
  for (const VkPipelineBindPoint point : {VK_PIPELINE_BIND_POINT_COMPUTE, VK_PIPELINE_BIND_POINT_GRAPHICS}) {
    gpu->vk.vkCmdBindDescriptorSets(commands, point, layout.get(), 0, count, sets, 0, nullptr);
  }
}

/// Submits what has been recorded with the pages that shadows need, has them bound, and begins what follows.
Result<VkCommandBuffer> Renderer::State::bind_pages(VkCommandBuffer commands) {
  shadows->system().record_requests(commands);
  const auto start = std::chrono::steady_clock::now();
  if (auto done = gpu->submit_and_wait(); !done) return done.error();
  if (auto bound = shadows->system().bind_pages({.queue = gpu->headless().queue()}); !bound) return bound.error();
  first_part_ms = ms_since(start);
  return gpu->begin();
}

Result<void> Renderer::State::record(VkCommandBuffer commands, const FrameInput& input, const CameraMatrices& camera) {
  umbrage::ShadowSystem& system = shadows->system();
  gpu::GpuFrame& frame = data.frame();
  frame.instances = draws.instances();
  frame.primitives = buffers.primitive_table();
  frame.materials = buffers.material_table();
  frame.umbrage = system.shader_interface(umbrage::CameraId{1}).frame;
  data.set_camera(camera, input.camera, targets);
  data.flush();

  PassContext pass = pass_context(commands);
  timers.begin(*gpu, commands);
  data.record_clear(*gpu, commands);
  deformer.record(*gpu, commands, layout.get());
  timers.mark(*gpu, commands, "deform");
  system.record_scene(commands);
  timers.mark(*gpu, commands, nullptr);
  bind_sets(commands, VK_NULL_HANDLE);
  gbuffer.record(pass, draws, buffers.indices());
  timers.mark(*gpu, commands, "gbuffer");
  if (reflection) {
    reflection->record_depth(*gpu, commands);
    timers.mark(*gpu, commands, "mirror depth");
  }
  if (system.binds_pages()) {
    auto rest = bind_pages(commands);
    if (!rest) return rest.error();
    commands = pass.commands = *rest;
  }
  system.record_shadows(commands);
  timers.mark(*gpu, commands, nullptr);

  record_reflection(commands);
  const umbrage::ShaderInterface shader = system.shader_interface(umbrage::CameraId{1});
  bind_sets(commands, shader.set);
  shade.record(pass);
  timers.mark(*gpu, commands, "shade");
  shade.record_blended(pass, draws, buffers.indices(), camera);
  timers.mark(*gpu, commands, "blend");
  post.record_exposure(pass);
  timers.mark(*gpu, commands, "exposure");
  post.record_tone_map(pass);
  timers.mark(*gpu, commands, "tone_map");
  if (input.show != Show::image) {
    show.record(pass, input.show, input.show_light, data.counters());
    timers.mark(*gpu, commands, "show");
  }
  data.record_read_back(*gpu, commands);
  return {};
}

void Renderer::State::record_reflection(VkCommandBuffer commands) {
  if (!reflection) return;
  std::array<VkDeviceAddress, ReflectionCube::kFaces> faces;
  for (uint32_t i = 0; i < faces.size(); ++i)
    faces[i] = shadows->system().shader_interface(umbrage::CameraId{kFirstFace + i}).frame;
  reflection->record_color(*gpu, commands, data.address(), faces);
  timers.mark(*gpu, commands, "mirror");
}

Result<FrameReport> Renderer::render(const FrameInput& input) {
  State& s = *state_;
  if (input.pose == nullptr)
    return Error{ErrorCode::invalid_argument, "FrameInput::pose is null: pass the scene's pose"};
  auto camera = camera_matrices(input.camera, s.targets.width(), s.targets.height(), s.data.extent());
  if (!camera) return camera.error();
  if (auto begun = s.begin_frame(input, *camera); !begun) return begun.error();
  auto commands = s.gpu->begin();
  if (!commands) return commands.error();
  s.first_part_ms = 0;
  if (auto recorded = s.record(*commands, input, *camera); !recorded) return recorded.error();
  const auto start = std::chrono::steady_clock::now();
  if (auto done = s.gpu->submit_and_wait(); !done) return done.error();
  s.completed = s.serial;
  s.shadows->system().collect(s.completed);
  auto report = s.report();
  if (report) report->wall_ms = s.first_part_ms + ms_since(start);
  return report;
}

Result<FrameReport> Renderer::State::report() const {
  auto times = timers.read(*gpu);
  if (!times) return times.error();
  const umbrage::ShadowSystem& system = shadows->system();
  FrameReport made;
  made.frame_ms = times->frame_ms;
  made.statistics = system.statistics();
  made.cpu_record_ms = made.statistics.cpu_record_ms;
  for (const auto& [name, ms] : times->passes) {
    made.passes.emplace_back(name, ms);
    if (std::string_view(name) != "gbuffer") continue;
    for (const umbrage::PassTime& pass : made.statistics.passes) add_pass(made.passes, pass);
  }
  made.statistics.passes = {};
  made.cascades.assign(made.statistics.cascades.begin(), made.statistics.cascades.end());
  made.statistics.cascades = {};
  const gpu::GpuCounters& counters = data.read_counters();
  made.lighting_computations = uint64_t{counters.lighting_computations_high} << 32 | counters.lighting_computations_low;
  made.degraded.assign(system.degraded_lights().begin(), system.degraded_lights().end());
  return made;
}

Result<PassContext> Renderer::State::begin_reading() {
  if (completed == 0) return Error{ErrorCode::invalid_argument, "nothing to read: render a frame first"};
  auto commands = gpu->begin();
  if (!commands) return commands.error();
  bind_sets(*commands, shadows->system().shader_interface(umbrage::CameraId{1}).set);
  return pass_context(*commands);
}

Result<std::vector<uint8_t>> Renderer::read_image() {
  auto pass = state_->begin_reading();
  return pass ? state_->read_back.picture(*state_->gpu, *pass) : pass.error();
}

Result<std::vector<float>> Renderer::read_position() {
  auto pass = state_->begin_reading();
  return pass ? state_->read_back.surface(*state_->gpu, *pass, SurfaceArray::position) : pass.error();
}

Result<std::vector<float>> Renderer::read_normal() {
  auto pass = state_->begin_reading();
  return pass ? state_->read_back.surface(*state_->gpu, *pass, SurfaceArray::normal) : pass.error();
}

Result<std::vector<float>> Renderer::read_color() {
  auto pass = state_->begin_reading();
  return pass ? state_->read_back.color(*state_->gpu, *pass) : pass.error();
}

Result<void> Renderer::read_visibility(uint32_t first, uint32_t count, std::span<uint8_t> visibility,
                                       std::span<uint8_t> band_px) {
  const size_t pixels = state_->targets.pixels();
  if (uint64_t{first} + count > state_->light_count || visibility.size() != count * pixels ||
      (!band_px.empty() && band_px.size() != count * pixels)) {
    return Error{ErrorCode::invalid_argument,
                 "read_visibility: lights " + std::to_string(first) + " to " + std::to_string(uint64_t{first} + count) +
                     " of " + std::to_string(state_->light_count) + " into " + std::to_string(visibility.size()) +
                     " bytes: the lights must exist and each needs " + std::to_string(pixels)};
  }
  const uint32_t most = ReadBack::max_visibility_lights(state_->targets.pixels());
  for (uint32_t done = 0; done < count; done += most) {
    const uint32_t lights = std::min(most, count - done);
    const std::span<uint8_t> bands = band_px.empty() ? band_px : band_px.subspan(done * pixels, lights * pixels);
    auto pass = state_->begin_reading();
    if (!pass) return pass.error();
    auto read = state_->read_back.visibility(*state_->gpu, *pass, first + done, lights,
                                             visibility.subspan(done * pixels, lights * pixels), bands);
    if (!read) return read.error();
  }
  return {};
}

Result<void> Renderer::mark_lookups() {
  auto oracle = umbrage::NeededTriangles::create(state_->shadows->system());
  if (!oracle) return oracle.error();
  state_->oracle.emplace(std::move(*oracle));
  return state_->read_back.mark_lookups(*state_->gpu, VkDeviceSize{state_->budget_mib} << 20);
}

Result<NeededWork> Renderer::read_needed_work() {
  auto pass = state_->begin_reading();
  if (!pass) return pass.error();
  return state_->read_back.needed(*state_->gpu, *pass, *state_->oracle);
}

std::string Renderer::device_name() const { return std::string(state_->gpu->headless().name()); }
std::string Renderer::driver() const { return std::string(state_->gpu->headless().driver()); }
uint64_t Renderer::validation_messages() const { return state_->gpu->validation_messages(); }

}  // namespace app
