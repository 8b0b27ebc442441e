// The sample host: a deferred renderer that embeds umbrage through its public headers only. It owns device, images and
// shading; the library owns shadows. One Renderer draws one scene headless, frame by frame.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/mirror_ball.hpp"
#include "import/scene.hpp"
#include "umbrage/umbrage.hpp"

namespace app {

/// A light as shaded: world space, every default filled in. Index = host_index = row of visibility.npy.
struct ActiveLight {
  std::string name;
  LightKind kind = LightKind::point;
  glm::vec3 position{0}, direction{0, 0, -1};
  glm::vec3 color{1};
  float intensity = 1;
  float range = 10;  ///< Finite for point and spot.
  float inner_cone = 0, outer_cone = 0.7853982f;
  uint32_t faces = 0x3f;  ///< Of a point light, what it shines through: umbrage::LightDesc::faces.
};

/// A camera of one frame. Reversed infinite depth unless far is finite or it is orthographic.
struct ViewCamera {
  Camera lens;
  glm::mat4 world_from_camera{1};
};

/// What no frame could do without: the oracle of the benchmarks.
struct NeededWork {
  uint64_t texels = 0;     ///< Different ones that were looked up.
  uint64_t triangles = 0;  ///< (triangle, view) pairs of what was drawn that cover one of those.
};

enum class Show : uint8_t {
  image,
  clusters,
  explicit_bounds,
  lights_per_pixel,
  normals,
  depth,
  resolution,
  texels_per_pixel,
  pages,
  triangles_per_map,
  projection_maps,
  cube_projection,
  cascades
};
enum class ShowLight : uint8_t { ignored, used };  ///< What becomes of FrameInput::show_light.
enum class ShowNeeds : uint8_t { nothing, page_pool, cascades };
struct ShowInfo {
  Show show;
  const char* name;  ///< As --show takes it.
  const char* summary;
  ShowLight light = ShowLight::ignored;
  ShowNeeds needs = ShowNeeds::nothing;
};
std::span<const ShowInfo> shows();

struct RendererDesc {
  uint32_t width = 1280, height = 720;
  std::string device;  ///< As HeadlessDesc::device.
  bool validate = false;
  umbrage::Settings settings;
  std::string batch_cache_dir;       ///< Prepared batches by content; empty = none.
  uint32_t max_lights = 0;           ///< Lights that any frame will have.
  std::optional<MirrorBall> mirror;  ///< Of the scene; it shows what is around it. Needs store=page_pool.
};

struct FrameInput {
  const Pose* pose = nullptr;  ///< Of the renderer's scene.
  std::span<const ActiveLight> lights;
  ViewCamera camera;
  umbrage::FrameSettings settings;
  double time_s = 0;  ///< Of the animation, or whatever clock the frames follow.
  Show show = Show::image;
  std::optional<uint32_t> show_light;  ///< Index in lights that the debug picture is about; else it chooses.
};

struct FrameReport {
  double frame_ms = 0;                                 ///< GPU, first to last timestamp, of the whole frame.
  double wall_ms = 0;                                  ///< Submit to done.
  double cpu_record_ms = 0;                            ///< The library's recording.
  std::vector<std::pair<std::string, double>> passes;  ///< GPU ms: the host's and the library's, in order.
  uint64_t lighting_computations = 0;                  ///< Lights summed over pixels.
  umbrage::Statistics statistics;                      ///< Its spans are not valid here.
  std::vector<umbrage::CascadeStatistics> cascades;
  std::vector<umbrage::LightStatus> degraded;
};

class Renderer {
 public:
  /// Uploads the scene. Errors say what and where.
  static umbrage::Result<Renderer> create(const RendererDesc&, const Scene&);
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Draws and waits. Afterwards everything below is about this frame.
  umbrage::Result<FrameReport> render(const FrameInput&);

  /// RGBA8, sRGB-encoded, tone mapped, row 0 at the top (or the debug picture).
  umbrage::Result<std::vector<uint8_t>> read_image();
  /// height × width × 3 floats. position: world, NaN where nothing is. normal: geometric, unit, world, zero where nothing
  /// is. color: linear, before tone mapping.
  umbrage::Result<std::vector<float>> read_position();
  umbrage::Result<std::vector<float>> read_normal();
  umbrage::Result<std::vector<float>> read_color();
  /// For lights first … first+count-1, each height × width bytes. visibility: 0…254 = visibility × 254, 255 = not
  /// evaluated; whether a pair is evaluated follows from the light alone, so a light that a cluster lost reads as 0.
  /// band_px (may be empty): twice the larger extent in pixels of the projected shadow texel used there, rounded up, at
  /// most 255; 0 where not evaluated.
  umbrage::Result<void> read_visibility(uint32_t first, uint32_t count, std::span<uint8_t> visibility,
                                        std::span<uint8_t> band_px);

  /// From now on read_visibility notes which of the pool's texels it looks up (store=page_pool).
  umbrage::Result<void> mark_lookups();
  /// Precondition: mark_lookups, and read_visibility of all lights since the last frame.
  umbrage::Result<NeededWork> read_needed_work();

  std::string device_name() const;
  std::string driver() const;
  /// Messages of the validation layers so far (with validate).
  uint64_t validation_messages() const;

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State>);
  std::unique_ptr<State> state_;
};

}  // namespace app
