// Shadows by rays: what every shadow map is held against. The tracer lives in a module of its own, the only thing
// that is linked to Embree; programs get one through reference_loader.hpp and talk to it through this interface.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "import/scene.hpp"
#include "reference/light.hpp"

namespace reference {

/// Positions at the pose's time of a primitive whose vertices move (skin, morph), as app::deformed_positions gives
/// them.
struct DeformedPrimitive {
  uint32_t instance = 0;   ///< Into Pose::instances.
  uint32_t primitive = 0;  ///< Into its mesh's primitives.
  std::vector<glm::vec3> positions;
};

/// Scene, pose and spans outlive the call; the scene outlives the tracer (its textures and coordinates are read at
/// every hit).
struct TracerInput {
  const app::Scene* scene = nullptr;
  const app::Pose* pose = nullptr;
  std::span<const DeformedPrimitive> deformed;
};

/// What a camera sees, height × width × 3 floats each, world space, row 0 at the top.
struct SurfaceImage {
  uint32_t width = 0, height = 0;
  std::span<const float> positions;  ///< NaN where nothing is.
  std::span<const float> normals;    ///< Geometric, unit length, towards the viewer.
};

constexpr uint8_t blocked = 0, visible = 1, not_evaluated = 255;

struct Ray {
  glm::vec3 origin{0};
  glm::vec3 direction{0, 0, -1};  ///< Any length > 0; distances are in units of it.
  float near = 0;
  float far = std::numeric_limits<float>::infinity();
};

struct Hit {
  float distance = std::numeric_limits<float>::infinity();  ///< Infinite: nothing was hit, and the rest is unset.
  glm::vec3 position{0};
  glm::vec3 normal{0};     ///< Geometric, unit length, towards the ray's origin.
  uint32_t instance = 0;   ///< Into Pose::instances.
  uint32_t primitive = 0;  ///< Into its mesh's primitives.
  uint32_t triangle = 0;
};

enum class Faces : uint8_t {
  both,      ///< As casters: every triangle has two sides.
  as_drawn,  ///< As a camera sees them: back faces of single-sided materials are not there.
};

/// Opaque triangles block on both sides. Masked ones block where alpha ≥ cutoff, alpha = base colour × its texture at
/// the finest level, filtered as its sampler says × vertex colour. Blended ones never block and are never hit. All
/// functions use every processor and may be called from several threads at once.
class RayTracer {
 public:
  virtual ~RayTracer() = default;

  /// Diagonal of the box of all blocking triangles, metres; 0 in an empty scene.
  virtual float diagonal() const = 0;

  /// One shadow ray for each pixel whose `evaluated` byte is not 255: result blocked or visible, otherwise
  /// not_evaluated. A ray starts at the position moved along the normal, by 1e-5 of the
  /// largest coordinate in the picture or of the light, or of diagonal(), whichever is less, and ends at the light's
  /// near plane, since what is nearer casts no shadow: for lights drawn as cubes where the largest of the three
  /// world-axis distances to the light is `near`, for spots drawn as one view where the depth along the spot's
  /// direction is `near`. A start nearer than that is visible. Directional lights: the ray has no end. Preconditions:
  /// all sizes fit image.width × image.height.
  virtual void visibility(const Light& light, const SurfaceImage& image, std::span<const uint8_t> evaluated,
                          std::span<uint8_t> result) const = 0;

  /// The nearest hit of each ray. Precondition: hits.size() == rays.size().
  virtual void closest_hits(std::span<const Ray> rays, Faces faces, std::span<Hit> hits) const = 0;
};

/// Grows whenever this interface or what it refers to changes, so that program and module of different builds do not
/// mix.
constexpr uint32_t tracer_interface_version = 1;

/// The module's only symbol, `umbrage_reference_create`. nullptr on failure; `error` then holds one line.
using CreateRayTracer = RayTracer* (*)(uint32_t interface_version, const TracerInput& input, char* error,
                                       size_t error_size);
constexpr const char* create_ray_tracer_symbol = "umbrage_reference_create";

}  // namespace reference
