// A scene that is edited from frame to frame, and cascades over it in several modes side by side, each read back.
#pragma once
#include "cascades/cascades.hpp"
#include "gpu.hpp"
#include "scene_casters.hpp"

namespace umbrage::test {

class CascadeRig {
 public:
  /// The last of `settings` is also drawn fresh in every frame: what the others must come to.
  CascadeRig(Gpu&, const TestScene&, std::vector<cascades::CascadeSettings> settings, const glm::vec3& sun);

  MeshId mesh(size_t i) const { return casters_.meshes[i]; }
  scene::GpuScene& scene() { return scene_; }
  /// In the scene's order; tests add their own.
  std::vector<InstanceId>& instances() { return casters_.instances; }

  /// One frame of every mode; seconds pass before it.
  void frame(const CameraDesc&, double seconds = 1.0 / 30);
  void set_sun(const glm::vec3& direction) { sun_.direction_ws = glm::normalize(direction); }

  /// The finished map of a cascade: what is looked up.
  std::vector<uint32_t> finished(size_t mode, size_t cascade);
  /// The same of a redraw of everything at the volumes of that mode.
  std::vector<uint32_t> fresh(size_t mode, size_t cascade);
  /// C.
  std::vector<uint32_t> static_map(size_t mode, size_t cascade);
  std::vector<shared::CascadeState> states(size_t mode);
  const shared::CascadeRecord& record(size_t mode, size_t cascade) {
    return modes_[mode].stage.planned().records[cascade];
  }
  /// Texels of all cascades that differ from a redraw.
  size_t wrong_texels(size_t mode);
  gpu::HazardLog* log = nullptr;

 private:
  struct Mode {
    cascades::CascadeSettings settings;
    cascades::Cascades stage, fresh;
  };
  std::vector<uint32_t> read(cascades::Cascades&, size_t cascade, bool finished);
  Gpu& gpu_;
  scene::GpuScene scene_;
  scene::ScenePipelines pipelines_;
  SceneCasters casters_;
  std::vector<Mode> modes_;
  cascades::CascadeLight sun_;
  gpu::RetireQueue retired_;
  gpu::Buffer frame_, counters_;
  uint64_t serial_ = 0;
  double time_s_ = 0;
};

}  // namespace umbrage::test
