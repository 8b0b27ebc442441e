// Several cameras in a frame: what each sees is marked as if it were alone, and looked up through its own record.
#include <array>

#include "pair_rig.hpp"

namespace umbrage::test {
namespace {

class Cameras : public GpuTest {};

/// Another look at what balls_scene shows.
CameraDesc other_camera(uint32_t id) {
  CameraDesc camera = perspective_camera({-9, 4, -8.0f + static_cast<float>(id)}, {1, 1, 0}, 40 + 8 * id, 56);
  camera.id = CameraId{id};
  return camera;
}

/// The same scene, seen by one camera alone.
Pairs seen_alone(Gpu& gpu, const SeenScene& scene, const CameraDesc& camera, const Receivers& seen,
                 const FrameSettings& settings) {
  SeenScene own = scene;
  own.camera = camera, own.seen = seen;
  return PairRig(gpu, {}, own).settle(settings);
}

TEST_F(Cameras, SeeWhatEachSeesAlone) {
  const SeenScene scene = balls_scene(60, 80, 71);
  std::vector<CameraDesc> others;
  for (uint32_t id = 2; id <= shared::MaxCameras; ++id) others.push_back(other_camera(id));
  others[1].normal_encoding = NormalEncoding::none;
  const std::array<FrameSettings, 3> all{FrameSettings{},
                                         {.receiver_boxes = ReceiverBoxes::clusters},
                                         {.cluster_bounds = ClusterBounds::implicit_cell, .layout = MapLayout::levels}};
  for (const FrameSettings& settings : all) {
    PairRig rig(gpu(), {}, scene);
    std::vector<Receivers> seen;
    if (&settings != all.data()) others.resize(2);
    for (const CameraDesc& camera : others) {
      seen.push_back(picture(camera, balls_on_ground));
      rig.show_also(camera, seen.back());
    }
    const Pairs first = rig.settle(settings);
    EXPECT_EQ(differences(first, seen_alone(gpu(), scene, scene.camera, scene.seen, settings)), 0u);
    EXPECT_EQ(first.statistics.unmarked_taps, 0u);
    for (size_t i = 0; i < others.size(); ++i) {
      const Pairs together = rig.evaluate(settings, others[i].id, seen[i]);
      const Pairs alone = seen_alone(gpu(), scene, others[i], seen[i], settings);
      EXPECT_GT(alone.asked(), 1000u);
      EXPECT_EQ(together.asked(), alone.asked());
      EXPECT_EQ(differences(together, alone), 0u) << "camera " << others[i].id.value;
      EXPECT_EQ(together.statistics.unmarked_taps, 0u)
          << "camera " << others[i].id.value << " is answered by what was marked for it";
    }
  }
}

TEST_F(Cameras, OfAFrameAreCheckedAndItsStateStays) {
  const SeenScene scene = balls_scene(10, 10, 72);
  PairRig rig(gpu(), {}, scene);
  const Pairs before = rig.settle();
  FrameDesc frame = rig.describe({});
  const CameraDesc own = frame.cameras[0];
  const auto refused = [&](const std::vector<CameraDesc>& cameras) {
    frame.cameras = cameras;
    const Result<void> begun = rig.system().begin_frame(frame);
    return begun.ok() ? std::string() : begun.error().message;
  };
  EXPECT_NE(refused({}).find("1…8"), std::string::npos);
  EXPECT_NE(refused(std::vector<CameraDesc>(9, own)).find("not 9"), std::string::npos);
  EXPECT_NE(refused({own, own}).find("two have the id 1"), std::string::npos);
  CameraDesc blind = own;
  blind.id = CameraId{2}, blind.depth = VK_NULL_HANDLE;
  EXPECT_NE(refused({own, blind}).find("CameraDesc::depth"), std::string::npos);
  EXPECT_EQ(differences(before, rig.evaluate()), 0u);
}

}  // namespace
}  // namespace umbrage::test
