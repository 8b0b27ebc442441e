// What render and compare do alike: the scene, its lights, its camera and the renderer of one run, and its frames.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "commands/camera_source.hpp"
#include "commands/options.hpp"
#include "commands/progress.hpp"
#include "host/renderer.hpp"
#include "import/scene.hpp"
#include "umbrage/result.hpp"

namespace app {

/// `builtin:NAME` or a file.
umbrage::Result<Scene> load_scene(const std::string& name);

/// Where the desktop's conventions keep what can be made again; empty when the environment names no place.
std::string batch_cache_folder();

/// Times of a run: medians over its frames after a warm-up of a quarter of them (1…10); of one frame: that frame's.
struct RunTimes {
  double frame_ms = 0, wall_ms = 0, cpu_record_ms = 0;
  uint32_t frames = 0, warmup_frames = 0;
};

class Session {
 public:
  /// Reads every input and uploads the scene.
  static umbrage::Result<Session> open(const SharedOptions& options, Progress& progress);

  /// Draws the options' frames in order; after_frame (may be empty) is called after each and stops the run by an error.
  /// With --validate, messages of the validation layers are an error.
  umbrage::Result<void> draw_frames(Progress& progress,
                                    const std::function<umbrage::Result<void>(uint32_t frame)>& after_frame);

  // Of the last frame drawn.
  const Scene& scene() const { return *scene_; }
  const Pose& pose() const { return pose_; }
  const std::vector<ActiveLight>& lights() const { return lights_; }
  const FrameReport& report() const { return report_; }
  RunTimes times() const;

  const SharedOptions& options() const { return options_; }
  const umbrage::Settings& settings() const { return settings_; }
  Renderer& renderer() { return renderer_; }

 private:
  Session(SharedOptions options, umbrage::Settings settings, std::unique_ptr<Scene> scene, CameraSource camera,
          std::vector<PosedLight> added_lights, const Box& bounds, Renderer renderer);
  umbrage::Result<void> draw(uint32_t frame);
  double time_of(uint32_t frame) const { return options_.time_s + frame / options_.fps; }

  SharedOptions options_;
  umbrage::Settings settings_;
  std::unique_ptr<Scene> scene_;  // Stays in place: the renderer and poses refer to it.
  CameraSource camera_;
  std::vector<PosedLight> added_lights_;
  Box bounds_;  // At the first frame's time, so that derived ranges do not change over the run.
  Renderer renderer_;
  Pose pose_;
  std::vector<ActiveLight> lights_;
  FrameReport report_;
  std::vector<double> frame_ms_, wall_ms_, cpu_record_ms_;
};

}  // namespace app
