#include "cascade_rig.hpp"

#include "clusters/camera.hpp"

namespace umbrage::test {

CascadeRig::CascadeRig(Gpu& gpu, const TestScene& test_scene, std::vector<cascades::CascadeSettings> settings,
                       const glm::vec3& sun)
    : gpu_(gpu),
      scene_(gpu.device(), gpu.memory(), {}),
      pipelines_(take(scene::ScenePipelines::create(gpu.factory()))),
      casters_(add_casters(gpu, scene_, test_scene)) {
  set_sun(sun);
  for (const cascades::CascadeSettings& mode : settings) {
    Mode& made = modes_.emplace_back();
    made.settings = mode;
    take(made.stage.prepare(gpu.factory()));
    take(made.fresh.prepare(gpu.factory()));
  }
  frame_ = gpu.buffer(sizeof(shared::TreeShape), gpu::MemoryKind::device, "frame");
  counters_ = gpu.buffer(sizeof(shared::FrameCounters), gpu::MemoryKind::device, "counters");
}

void CascadeRig::frame(const CameraDesc& desc, double seconds) {
  ++serial_;
  time_s_ += seconds;
  const shared::CameraRecord camera = take(clusters::camera_record(desc));
  gpu::Uploader edits, tables;
  take(scene_.upload(edits, retired_, serial_));
  scene_.new_masks().clear();
  const shared::TreeShape shape = scene::tree_shape(scene_.caster_slots());
  take(tables.begin(gpu_.device(), gpu_.memory(), 1 << 18, "staging"));
  tables.copy(frame_, 0, &shape, sizeof shape);
  std::vector<gpu::Buffer> outgrown;
  for (Mode& mode : modes_)
    for (cascades::Cascades* stage : {&mode.stage, &mode.fresh}) {
      take(stage->begin(gpu_.device(), gpu_.memory(), scene_,
                        {.camera = camera,
                         .lights = {&sun_, 1},
                         .settings = mode.settings,
                         .time_s = time_s_,
                         .fresh = stage == &mode.fresh},
                        outgrown));
      stage->upload(tables);
    }
  gpu_.run([&](VkCommandBuffer commands) {
    gpu::Recorder recorder = gpu_.recorder(commands, log);
    scene_.record(recorder, pipelines_, edits, retired_, serial_);
    tables.record(recorder);
    for (Mode& mode : modes_)
      for (cascades::Cascades* stage : {&mode.stage, &mode.fresh})
        stage->record(recorder, {scene_, frame_, frame_.address(), counters_, serial_}, retired_);
  });
  retired_.collect(serial_);
}

std::vector<uint32_t> CascadeRig::read(cascades::Cascades& stage, size_t cascade, bool finished) {
  const auto state = gpu_.download<shared::CascadeState>(stage.states(), cascade + 1)[cascade];
  const shared::CascadeRecord& record = stage.planned().records[cascade];
  const uint32_t which = finished && state.shows_work ? 2 : state.front;
  const VkDeviceSize first = VkDeviceSize(which) * stage.planned().texels + record.first_texel;
  return gpu_.download<uint32_t>(stage.maps(), record.side * record.side, first * sizeof(uint32_t));
}

std::vector<uint32_t> CascadeRig::finished(size_t mode, size_t cascade) {
  return read(modes_[mode].stage, cascade, true);
}
std::vector<uint32_t> CascadeRig::fresh(size_t mode, size_t cascade) { return read(modes_[mode].fresh, cascade, true); }
std::vector<uint32_t> CascadeRig::static_map(size_t mode, size_t cascade) {
  return read(modes_[mode].stage, cascade, false);
}

std::vector<shared::CascadeState> CascadeRig::states(size_t mode) {
  return gpu_.download<shared::CascadeState>(modes_[mode].stage.states(), modes_[mode].settings.count);
}

size_t CascadeRig::wrong_texels(size_t mode) {
  size_t wrong = 0;
  for (size_t cascade = 0; cascade < modes_[mode].settings.count; ++cascade) {
    EXPECT_EQ(record(mode, cascade).origin, modes_[mode].fresh.planned().records[cascade].origin);
    const auto have = finished(mode, cascade), want = fresh(mode, cascade);
    for (size_t i = 0; i < want.size(); ++i) wrong += have[i] != want[i];
  }
  return wrong;
}

}  // namespace umbrage::test
