// What layered passes are for (R6): the views of each use. No Vulkan calls, so that tests can look at matrices alone.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "umbrage/layered_pass.hpp"

namespace app {

enum class LayeredUse : uint8_t {
  cube,
  cube_array,
  cascades,
  cascade_sets,
  warped,
  reflection,
  reflection_cube,
  stereo,
  cad
};
struct LayeredUseInfo {
  LayeredUse use;
  const char* name;  ///< As the command takes it.
  const char* summary;
  bool has_color;
  uint32_t columns;  ///< Of its picture.
};
std::span<const LayeredUseInfo> layered_uses();

/// A perspective camera and the box around everything.
struct UseScene {
  glm::mat4 view_from_world{1};
  float fov_y = 1, aspect = 1, near = 0.1f, far = 100;
  glm::vec3 lowest{0}, highest{1};
  float mirror_height = 0;  ///< World y of reflection's mirror.
};

/// One a layer, in the picture's order.
std::vector<glm::mat4> use_matrices(LayeredUse, const UseScene&);

constexpr glm::vec3 kSunDirection{-0.45f, -0.8f, -0.4f};  ///< Where it shines, not unit length.

/// Looking along a cube map's faces, oriented as Vulkan's.
std::array<glm::mat4, 6> cube_matrices(const glm::vec3& from, float near, float far);
/// One cascade: an orthographic view along `direction` of the camera's slice between two depths, casters included.
glm::mat4 cascade_matrix(const UseScene&, const glm::vec3& direction, float near, float far);
/// Depths where cascades end: between even and logarithmic steps.
std::vector<float> cascade_ends(float near, float far, uint32_t cascades);
/// The same light on all of the camera's view, warped so that what is near the camera gets more texels (after Wimmer et al. 2004).
glm::mat4 warped_matrix(const UseScene&, const glm::vec3& direction);
/// What a camera sees in a mirror on the plane y = height: mirrored, with an oblique near plane that cuts off what is below.
glm::mat4 mirrored_matrix(const UseScene&, float height);
/// A parallel view of the whole box along a direction.
glm::mat4 sun_matrix(const UseScene&, const glm::vec3& direction);
/// Where the mirror ball of reflection_cube hangs, and its radius.
glm::vec4 mirror_ball(const UseScene&);

}  // namespace app
