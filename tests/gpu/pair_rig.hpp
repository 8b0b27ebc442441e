// Frames with virtual shadow maps, read back: the maps, marks and pages as the device made them, and the visibility of every
// (pixel, light) through umbrage.glsl. With them, scenes that go to the limits.
#pragma once
#include "cluster_reader.hpp"

namespace umbrage::test {

/// What a frame of the page pool decided.
struct DeviceMaps : DeviceClusters {
  explicit DeviceMaps(SystemRig&);
  std::vector<shared::LightRecord> light_records;
  std::vector<shared::ShadowView> views;
  std::vector<shared::MapRecord> maps;
  std::vector<shared::LightMaps> light_maps;
  std::vector<float> pair_requests;  // 0: faces away
  std::vector<uint32_t> pair_clusters, pair_maps;
  std::vector<uint32_t> page_bits, page_first;
  std::vector<uint32_t> projection;   // ProjectionSide words a view
  std::vector<float> receiver_depth;  // receiver_grid² a view
};

struct Pairs {
  uint32_t lights = 0;
  std::vector<float> visibility;   // [pixel][host_index]; negative: not asked
  std::vector<uint32_t> clusters;  // of each pixel
  Statistics statistics;           // its passes are gone
  size_t asked() const;
};
/// (pixel, light) whose visibility differs in any bit.
size_t differences(const Pairs&, const Pairs&);

/// A scene with its lights' host_index 0, 1, … and the picture that a camera has of some receivers.
struct SeenScene {
  std::string name;
  TestScene scene;
  CameraDesc camera;
  Receivers seen;
};

class PairRig : public SystemRig {
 public:
  PairRig(Gpu&, StaticSettings, const SeenScene&);
  /// Removes everything and adds another scene.
  void replace(const SeenScene&);
  /// A frame, and what a host would ask of it.
  Pairs evaluate(const FrameSettings& = {});
  /// The same for what a camera sees that show_also has added.
  Pairs evaluate(const FrameSettings&, CameraId, const Receivers&);
  /// Frames until the tables are as large as they need to be; the last one's answers.
  Pairs settle(const FrameSettings& = {});

 private:
  Pairs evaluate(const FrameSettings&, CameraId, const Receivers&, const gpu::Buffer& samples);
  gpu::Buffer samples_;
  Program program_;
};

/// mixed_scene with balls on the ground before the camera.
SeenScene balls_scene(uint32_t instances, uint32_t lights, uint32_t seed, uint32_t width = 96, uint32_t height = 64);
/// Lights in walls, on surfaces and at the camera; ranges beyond the scene; a camera within a caster; degenerate triangles; no
/// lights, no casters, one light; an orthographic camera.
std::vector<SeenScene> hard_scenes();

}  // namespace umbrage::test
