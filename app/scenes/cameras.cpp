// The town's views.
#include "scenes/cameras.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace app {
namespace {

struct View {
  const char* name;
  glm::vec2 eye;     ///< x, z.
  float eye_height;  ///< Over the ground.
  glm::vec2 target;
  float target_height;
  float fov_y_deg;
};

constexpr View views[] = {
    {"overview", {10, 62}, 16.3f, {-6, 14}, 3.0f, 52},
    {"street", {-1.0f, 66}, 2.9f, {2.2f, 36}, 4.2f, 54},
    {"square", {5, 17.6f}, 2.6f, {-4.5f, -12}, 5.4f, 55},
};

}  // namespace

void add_cameras(Scene& scene, const Terrain& terrain) {
  for (const View& view : views) {
    const glm::vec3 eye{view.eye.x, terrain.ground(view.eye) + view.eye_height, view.eye.y};
    const glm::vec3 target{view.target.x, terrain.ground(view.target) + view.target_height, view.target.y};
    Node node{.name = view.name, .translation = eye, .camera = static_cast<int>(scene.cameras.size())};
    node.rotation = glm::quat_cast(glm::inverse(glm::mat3(glm::lookAt(eye, target, glm::vec3(0, 1, 0)))));
    scene.cameras.push_back({.name = view.name, .fov_y = glm::radians(view.fov_y_deg)});
    scene.nodes.push_back(std::move(node));
  }
}

}  // namespace app
