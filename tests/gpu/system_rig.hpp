// A host reduced to images that the test fills: it adds scenes, runs frames, and reads what a ShadowSystem made of them.
#pragma once
#include "gpu.hpp"
#include "shadow_system_state.hpp"
#include "test_scene.hpp"

namespace umbrage::test {

/// The depth atlas, row by row.
struct Atlas {
  uint32_t width = 0, height = 0;
  std::vector<float> depth;
  float at(uint32_t x, uint32_t y) const { return depth[size_t(y) * width + x]; }
};

class SystemRig {
 public:
  SystemRig(Gpu&, const StaticSettings&, Store = Store::fixed_cubes);

  void add(const TestScene&);
  MeshId add(const TestMesh&);
  InstanceId add(const TestInstance&);
  /// What frames see from now on.
  void show(const CameraDesc&, const Receivers&);
  /// Beside it, with an id of its own.
  void show_also(const CameraDesc&, const Receivers&);
  /// The same with nothing but background; every light gets its map.
  void show_nothing();
  CameraDesc& camera() { return camera_; }
  const Receivers& receivers() const { return receivers_; }

  /// One frame from begin_frame to the device being idle; `after` records behind it. Its statistics are collected.
  void frame(const FrameSettings& = {}, const std::function<void(VkCommandBuffer)>& after = {},
             VkPipelineStageFlags2 consumers = 0);
  /// The next frame's description; counts serials.
  FrameDesc describe(const FrameSettings&);

  ShadowSystem& system() { return system_; }
  auto& state() { return SystemAccess::state(system_); }
  Frame& stages() { return *state().frame; }
  Gpu& gpu() { return gpu_; }
  Atlas atlas();
  shared::FrameCounters counters() { return gpu_.download<shared::FrameCounters>(stages().counters, 1)[0]; }
  shared::FrameRecord record() { return gpu_.download<shared::FrameRecord>(stages().block, 1)[0]; }
  std::vector<shared::ShadowView> views();
  std::vector<shared::LightRecord> lights();
  std::vector<uint32_t> used_lights();
  uint32_t map_resolution() { return stages().store.layout().resolution; }

  // Ids in the order of the scenes added.
  std::vector<MeshId> mesh_ids;
  std::vector<InstanceId> instance_ids;
  std::vector<LightId> light_ids;

 private:
  Gpu& gpu_;
  ShadowSystem system_;
  Image mask_;
  /// What a camera sees.
  struct Picture {
    std::unique_ptr<Image> depth, normals;
  };
  Picture fill_picture(CameraDesc&, const Receivers&);
  Picture picture_;
  std::vector<Picture> other_pictures_;
  MaskId mask_id_;
  CameraDesc camera_;
  std::vector<CameraDesc> cameras_ = std::vector<CameraDesc>(1);
  Receivers receivers_;
  uint64_t serial_ = 0;
};

/// Slot of an id, as records and lists name it.
inline uint32_t slot_of(LightId id) { return id.value & 0xfffffu; }
inline uint32_t slot_of(InstanceId id) { return id.value & 0xfffffu; }

}  // namespace umbrage::test
